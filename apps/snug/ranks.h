#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "ranks_interface.h"

namespace snug::command {

/// The processes that mpirun started together. For the thread that made it.
///
/// Errors:    of all its functions: InputError (unreadable) that names a rank which has been silent for too long.
class Ranks {
 public:
  /// Joins them; null for a process that mpirun did not start, or alone. `patience`: seconds of silence after which
  /// a rank counts as lost; 0 for no limit.
  /// Errors:    InputError (unreadable) if the library for MPI is not there, or cannot join.
  [[nodiscard]] static std::unique_ptr<Ranks> join(double patience);

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }
  /// How many of them share this machine.
  [[nodiscard]] int size_of_node() const { return size_of_node_; }

  /// The bytes that rank 0 passes; to be called by all.
  [[nodiscard]] std::string broadcast(std::string bytes) const;
  void send(int to, std::string_view bytes) const;
  struct Message {
    int from;
    std::string bytes;
  };
  /// The next message that is there; nothing if none is, unless it is to wait.
  [[nodiscard]] std::optional<Message> receive(bool wait) const;
  /// Waits until all have called it. Where one ends without it mpirun ends all.
  void leave() const;

 private:
  Ranks(const SnugRanks* functions, double patience) : functions_(functions), patience_(patience) {}
  void require(bool done) const;

  const SnugRanks* functions_;
  double patience_;
  int rank_ = 0, size_ = 1, size_of_node_ = 1;
};

}  // namespace snug::command
