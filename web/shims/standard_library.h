#pragma once

// Read before every file of the browser's build: what snug uses of C++20's library and that of Emscripten 3.1.6 lacks. A newer
// Emscripten has it, and gets nothing from here.

#include <version>

#include <algorithm>
#include <bit>
#include <charconv>
#include <functional>
#include <iterator>
#include <ranges>

#if _LIBCPP_VERSION < 15000

_LIBCPP_BEGIN_NAMESPACE_STD

template <class To, class From>
[[nodiscard]] constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

/// As the standard says, for the default format.
/// Guarantee: the nearest double, ties to even; the same text as libstdc++'s.
from_chars_result from_chars(const char* first, const char* last, double& value);
to_chars_result to_chars(char* first, char* last, double value);
/// For chars_format::general alone, which is that of printf's %g.
to_chars_result to_chars(char* first, char* last, double value, chars_format format, int precision);

/// A page has one thread.
template <class T>
class atomic_ref {
 public:
  explicit atomic_ref(T& object) : object_(object) {}
  void store(T value, memory_order = memory_order_seq_cst) const { object_ = value; }
  [[nodiscard]] T load(memory_order = memory_order_seq_cst) const { return object_; }

 private:
  T& object_;
};

namespace ranges {

template <class Range, class Out, class Change>
void transform(Range&& range, Out out, Change change) {
  std::transform(range.begin(), range.end(), out, change);
}

template <class Range, class T, class Projection = identity>
auto find(Range&& range, const T& value, Projection of = {}) {
  return std::find_if(range.begin(), range.end(),
                      [&](const auto& each) { return std::invoke(of, each) == value; });
}

template <class A, class B, class ProjectionA = identity, class ProjectionB = identity>
bool equal(A&& a, B&& b, std::equal_to<> = {}, ProjectionA of_a = {}, ProjectionB of_b = {}) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const auto& x, const auto& y) {
    return std::invoke(of_a, x) == std::invoke(of_b, y);
  });
}

template <class Range, class Projection = identity>
void stable_sort(Range&& range, std::less<> = {}, Projection of = {}) {
  std::stable_sort(range.begin(), range.end(),
                   [&](const auto& x, const auto& y) { return std::invoke(of, x) < std::invoke(of, y); });
}

template <class Range, class T, class Projection = identity>
auto lower_bound(Range&& range, const T& value, std::less<> = {}, Projection of = {}) {
  return std::lower_bound(range.begin(), range.end(), value,
                          [&](const auto& each, const T& v) { return std::invoke(of, each) < v; });
}

template <class Range, class T, class Projection = identity>
auto upper_bound(Range&& range, const T& value, std::less<> = {}, Projection of = {}) {
  return std::upper_bound(range.begin(), range.end(), value,
                          [&](const T& v, const auto& each) { return v < std::invoke(of, each); });
}

}  // namespace ranges

_LIBCPP_END_NAMESPACE_STD

#endif
