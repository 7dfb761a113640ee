#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

namespace snug {

/// Results that threads find in any order, handed on in theirs: each as soon as all before it are there.
template <class Result>
class InOrder {
 public:
  /// `take` is called for 0, 1, 2, ..., on the threads that call put(), one at a time.
  using Take = std::function<void(std::size_t, Result&)>;
  InOrder(std::size_t count, Take take) : results_(count), take_(std::move(take)) {}

  /// Result i.
  /// Errors:    what `take` throws; nothing is handed on after that.
  void put(std::size_t i, Result result) {
    const std::lock_guard lock(mutex_);
    results_[i].emplace(std::move(result));
    while (!failed_ && next_ < results_.size() && results_[next_]) {
      failed_ = true;
      take_(next_, *results_[next_]);
      failed_ = false;
      results_[next_++].reset();
    }
  }

 private:
  std::mutex mutex_;
  std::vector<std::optional<Result>> results_;
  Take take_;
  std::size_t next_ = 0;
  bool failed_ = false;
};

}  // namespace snug
