#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>

#include <snug/base/error.h>
#include <snug/base/ids.h>

namespace snug {

/// One value of type T a kind, made on first use, then immutable. Thread-safe; looking up costs two loads.
///
/// Requires:  `make` gives equal values for equal kinds: two threads may both make one, and the first to
///            finish keeps it.
/// Errors:    InputError (refused) beyond 16 million kinds; whatever `make` throws, and nothing is kept then.
template <class T>
class KindSlots {
 public:
  KindSlots() = default;
  KindSlots(const KindSlots&) = delete;
  KindSlots& operator=(const KindSlots&) = delete;
  ~KindSlots() {
    for (auto& place : blocks_) {
      const std::unique_ptr<Block> block(place.load());
      if (!block) continue;
      for (auto& value : *block) delete value.load();
    }
  }

  /// The value of kind `id`; `make()` makes it where there is none.
  template <class Make>
  [[nodiscard]] const T& get(KindId id, Make&& make) {
    std::atomic<const T*>& place = slot(id.index());
    if (const T* ready = place.load(std::memory_order_acquire)) return *ready;
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
      throw InputError(InputProblem::refused,
                       "more than 16 million kinds of patches: use a library for each mesh");
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
  std::mutex growth_;
  std::atomic<std::size_t> count_{0}, bytes_{0};
};

}  // namespace snug
