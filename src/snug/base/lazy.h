#pragma once

#include <atomic>
#include <mutex>
#include <optional>

namespace snug {

/// A value that is made on first use, then immutable. Thread-safe. Not std::call_once: an exception that
/// leaves it may end the process or lock it up.
template <class T>
class Lazy {
 public:
  /// The value; make() makes it where there is none. If that throws, nothing is kept.
  template <class Make>
  [[nodiscard]] const T& get(Make&& make) const {
    if (const T* const ready = ready_.load(std::memory_order_acquire)) return *ready;
    const std::lock_guard lock(mutex_);
    if (!value_) value_.emplace(make());
    ready_.store(&*value_, std::memory_order_release);
    return *value_;
  }
  /// The value if it has been made.
  [[nodiscard]] const T* made() const { return ready_.load(std::memory_order_acquire); }

 private:
  mutable std::mutex mutex_;
  mutable std::optional<T> value_;
  mutable std::atomic<const T*> ready_{nullptr};
};

}  // namespace snug
