#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

namespace snug {

/// A value that is made on first use, then immutable until it expires. Thread-safe. Not std::call_once: an exception that
/// leaves it may end the process or lock it up.
template <class T>
class Lazy {
 public:
  /// The value; make() makes it where there is none. If that throws, nothing is kept.
  template <class Make>
  [[nodiscard]] const T& get(Make&& make) const {
    return get(std::forward<Make>(make), [](T&) {});
  }
  /// The same; renew(value) brings up to date a value that has expired. If that throws, it stays expired.
  template <class Make, class Renew>
  [[nodiscard]] const T& get(Make&& make, Renew&& renew) const {
    if (const T* const ready = ready_.load(std::memory_order_acquire)) return *ready;
    const std::lock_guard lock(mutex_);
    if (ready_.load(std::memory_order_relaxed) == nullptr) {
      if (value_) {
        renew(*value_);
      } else {
        value_.emplace(make());
      }
      ready_.store(&*value_, std::memory_order_release);
    }
    return *value_;
  }
  /// The value is to be renewed on its next use. Nobody else may use it meanwhile.
  void expire() { ready_.store(nullptr, std::memory_order_relaxed); }
  /// There is no value any more. Nobody else may use it meanwhile.
  void clear() {
    expire();
    value_.reset();
  }
  /// The value if it has been made.
  [[nodiscard]] const T* made() const { return ready_.load(std::memory_order_acquire); }

 private:
  mutable std::mutex mutex_;
  mutable std::optional<T> value_;
  mutable std::atomic<const T*> ready_{nullptr};
};

}  // namespace snug
