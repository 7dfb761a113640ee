#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include <snug/mesh.h>
#include <support/error.h>
#include <support/recent_values.h>

namespace snug {

/// One value of type T a kind, made on first use, then immutable. Thread-safe; looking up costs two loads.
///
/// Requires:  `make` gives equal values for equal kinds: two threads may both make one, and the first to
///            finish keeps it.
/// Errors:    InputError (refused) beyond 16 million kinds; whatever `make` throws, and nothing is kept then.
template <class T>
class KindSlots {
 public:
  /// Keeps so many bytes of values, and the value that goes beyond them; others are made where needed.
  explicit KindSlots(std::size_t max_bytes = SIZE_MAX) : max_bytes_(max_bytes) {}
  KindSlots(const KindSlots&) = delete;
  KindSlots& operator=(const KindSlots&) = delete;
  ~KindSlots() {
    for (auto& place : blocks_) {
      const std::unique_ptr<Block> block(place.load());
      if (!block) continue;
      for (auto& value : *block) delete value.load();
    }
  }

  /// The value of kind `id`; `make()` makes it where there is none. It stays as long as this, or beyond the
  /// limit until this thread has made eight others.
  template <class Make>
  [[nodiscard]] const T& get(KindId id, Make&& make) {
    std::atomic<const T*>& place = slot(id.index());
    if (const T* ready = place.load(std::memory_order_acquire)) return *ready;
    if (bytes() >= max_bytes_) {
      thread_local RecentValues<std::pair<std::uint64_t, KindId>, T, 8> recent;
      return recent.get({serial_, id}, make);
    }
    auto fresh = std::make_unique<const T>(make());
    const T* expected = nullptr;
    if (!place.compare_exchange_strong(expected, fresh.get(), std::memory_order_acq_rel)) return *expected;
    count_.fetch_add(1);
    bytes_.fetch_add(fresh->bytes());
    return *fresh.release();
  }

  /// Values made so far, and their memory.
  [[nodiscard]] std::size_t size() const { return count_.load(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_.load(); }

 private:
  static constexpr std::size_t block_size = 4096;
  using Block = std::array<std::atomic<const T*>, block_size>;

  std::atomic<const T*>& slot(std::size_t index) {
    if (index / block_size >= blocks_.size()) {
      throw InputError(InputProblem::refused, "more than 16 million patch topologies: split the mesh");
    }
    std::atomic<Block*>& place = blocks_[index / block_size];
    Block* block = place.load(std::memory_order_acquire);
    if (!block) {
      const std::lock_guard lock(growth_);
      block = place.load(std::memory_order_acquire);
      if (!block) place.store(block = new Block{}, std::memory_order_release);
    }
    return (*block)[index % block_size];
  }

  std::array<std::atomic<Block*>, 4096> blocks_{};
  std::size_t max_bytes_;
  // No two share it, as they may an address one after the other.
  static inline std::atomic<std::uint64_t> last_serial_{0};
  std::uint64_t serial_ = ++last_serial_;
  std::mutex growth_;
  std::atomic<std::size_t> count_{0}, bytes_{0};
};

}  // namespace snug
