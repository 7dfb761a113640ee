#pragma once

#include <array>
#include <atomic>
#include <mutex>

#include <snug/basis/bound_rows.h>

namespace snug {

/// Rows of all kinds met so far, made on first use, then immutable. Thread-safe; looking up costs two loads.
class BoundLibrary {
 public:
  BoundLibrary() = default;
  ~BoundLibrary();
  BoundLibrary(const BoundLibrary&) = delete;
  BoundLibrary& operator=(const BoundLibrary&) = delete;

  /// The library of kinds that this one keeps rows for.
  [[nodiscard]] KindLibrary& kinds() { return kinds_; }
  [[nodiscard]] const KindLibrary& kinds() const { return kinds_; }

  /// Requires:  a kind of kinds().
  /// Errors:    SNUG_EXPECT beyond 16 million kinds.
  [[nodiscard]] const BoundRows& rows(const Kind& kind);

  /// Kinds that have rows, and the memory of these.
  [[nodiscard]] std::size_t size() const { return count_.load(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_.load(); }

 private:
  static constexpr std::size_t block_size = 4096;
  using Block = std::array<std::atomic<const BoundRows*>, block_size>;

  KindLibrary kinds_;
  std::array<std::atomic<Block*>, 4096> blocks_{};
  std::mutex growth_;
  std::atomic<std::size_t> count_{0}, bytes_{0};
};

}  // namespace snug
