#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include <snug/search/piece_cache.h>
#include <snug/search/surface_data.h>
#include <support/workers.h>

namespace snug {

/// Contents of a Workspace: pieces of each surface that a query met, twice where a surface is compared with
/// itself, and what questions keep besides.
class Workspace::Pieces {
 public:
  /// For a query about one surface.
  [[nodiscard]] PieceCache& of(const Surface& surface);
  /// For a query about two, which may be the same one.
  struct Pair {
    PieceCache &a, &b;
  };
  [[nodiscard]] Pair of(const Surface& a, const Surface& b);

  /// For the other threads of a run.
  [[nodiscard]] std::vector<Workspace>& of_other_threads() { return of_other_threads_; }
  /// Data that a question keeps for later ones besides pieces: of one type for each purpose, made on first use.
  enum class Kept : std::uint8_t { collisions, distances };
  template <class T>
  [[nodiscard]] T& kept(Kept purpose) {
    std::shared_ptr<void>& place = kept_[static_cast<std::size_t>(purpose)];
    if (!place) {
      place = std::make_shared<T>();
      bytes_kept_ += sizeof(T);
    }
    return *static_cast<T*>(place.get());
  }

  [[nodiscard]] std::size_t bytes() const;
  void clear();

 private:
  // Of one surface, or of the frames of a moving one that use the same memory: of the last one met.
  struct Entry {
    std::weak_ptr<const SurfaceData> surface;
    std::uint64_t number = 0;  // of that frame
    std::unique_ptr<PieceCache> pieces;
    std::uint64_t query = 0;  // that used it last
  };
  // Places of the last few entries, looked up first.
  struct Recent {
    std::uint64_t name = 0;
    Entry* entry = nullptr;
  };

  void begin_query();
  PieceCache& find(const Surface& surface, bool second);
  void drop_old();
  // Entries of surfaces that are gone.
  void drop_gone();

  std::unordered_map<std::uint64_t, Entry> entries_;
  std::array<Recent, 8> recent_{};
  std::vector<Workspace> of_other_threads_;
  std::array<std::shared_ptr<void>, 2> kept_;
  std::size_t bytes_kept_ = 0;
  std::uint64_t query_ = 0;
};

/// The workspace of a run.
[[nodiscard]] inline Workspace& workspace_of(const Run& run) {
  return run.workspace != nullptr ? *run.workspace : Workspace::of_this_thread();
}

/// The threads of a run, each with a workspace of its own that is kept for the next run.
[[nodiscard]] inline Workers<Workspace> workers_of(const Run& run) {
  return {workspace_of(run), run.threads, &workspace_of(run).pieces().of_other_threads()};
}

}  // namespace snug
