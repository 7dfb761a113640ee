#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <snug/geometry.h>
#include <snug/run.h>

namespace snug::python {

namespace py = pybind11;

/// What stands for a number that there is none of.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Numbers from Python as C-contiguous doubles: the array's own memory if it holds such, else a copy. Whoever holds this
/// keeps them alive; they must not be changed during a call.
class Doubles {
 public:
  /// Errors:    TypeError, ValueError naming `what`: not real numbers, ragged, masked.
  Doubles(py::handle numbers, const char* what);

  [[nodiscard]] std::size_t dimensions() const { return static_cast<std::size_t>(array_.ndim()); }
  [[nodiscard]] std::size_t extent(std::size_t axis) const {
    return static_cast<std::size_t>(array_.shape(static_cast<py::ssize_t>(axis)));
  }
  /// The same, counted from the last axis.
  [[nodiscard]] std::size_t last(std::size_t axis) const { return extent(dimensions() - 1 - axis); }
  [[nodiscard]] const double* data() const { return static_cast<const double*>(array_.data()); }
  [[nodiscard]] std::string shape_text() const;

 private:
  py::array array_;
};

/// A float or a small int of Python's own; empty for everything else.
[[nodiscard]] std::optional<double> plain_number(PyObject* given);

/// A point (3,) or n points (n, 3).
class Points {
 public:
  Points(py::handle numbers, const char* what);
  [[nodiscard]] bool single() const { return plain_ || numbers_->dimensions() == 1; }
  [[nodiscard]] std::span<const Point3> all() const;

 private:
  std::optional<Point3>
      plain_;  // a list or tuple of three plain numbers, which numpy takes ten times as long for
  std::optional<Doubles> numbers_;
};

/// How the numbers of a value lie in memory.
template <class V>
struct Layout {
  using Number = V;
  static void add(std::vector<py::ssize_t>&, std::vector<py::ssize_t>&) {}
};
template <class V>
requires std::is_same_v<V, Point3> || std::is_same_v<V, Vector3>
struct Layout<V> {
  using Number = double;
  static void add(std::vector<py::ssize_t>& shape, std::vector<py::ssize_t>& strides) {
    shape.push_back(3);
    strides.push_back(sizeof(double));
  }
};
template <>
struct Layout<Interval> {
  using Number = double;
  static void add(std::vector<py::ssize_t>& shape, std::vector<py::ssize_t>& strides) {
    static_assert(sizeof(Interval) == 2 * sizeof(double) && offsetof(Interval, upper) == sizeof(double));
    shape.push_back(2);
    strides.push_back(sizeof(double));
  }
};
template <class V, std::size_t N>
struct Layout<std::array<V, N>> {
  using Number = typename Layout<V>::Number;
  static void add(std::vector<py::ssize_t>& shape, std::vector<py::ssize_t>& strides) {
    shape.push_back(N);
    strides.push_back(sizeof(V));
    Layout<V>::add(shape, strides);
  }
};

/// The same array, which nobody writes to from now on.
inline py::array read_only(py::array array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}
/// A read-only array over memory that `owner` keeps.
template <class Number>
py::array read_only(std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, const Number* data,
                    py::handle owner) {
  return read_only(py::array(py::dtype::of<Number>(), std::move(shape), std::move(strides), data, owner));
}

/// One number for each row: a member of `rows`, seen without a copy.
template <class T, class Member>
py::array column(std::span<const T> rows, const Member& member, py::handle owner) {
  using V = std::remove_cvref_t<decltype(member(rows[0]))>;
  using Number = typename Layout<V>::Number;
  static_assert(std::is_reference_v<decltype(member(rows[0]))>, "a view of a temporary");
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows.size())}, strides{sizeof(T)};
  Layout<V>::add(shape, strides);
  static constexpr Number none{};
  const auto* data = rows.empty() ? &none : reinterpret_cast<const Number*>(&member(rows[0]));  // NOLINT
  return read_only<Number>(std::move(shape), std::move(strides), data, owner);
}
template <class T>
py::array column(const std::vector<T>& rows, py::handle owner) {
  return column(
      std::span<const T>(rows), [](const T& row) -> const T& { return row; }, owner);
}

/// One value, seen without a copy: its numbers as an array.
template <class V>
py::array value_view(const V& value, py::handle owner) {
  std::vector<py::ssize_t> shape, strides;
  Layout<V>::add(shape, strides);
  using Number = typename Layout<V>::Number;
  return read_only<Number>(std::move(shape), std::move(strides), reinterpret_cast<const Number*>(&value),
                           owner);  // NOLINT
}

/// Objects of a class, each a copy.
template <class T>
py::list list_of(const std::vector<T>& values) {
  py::list result;
  for (const T& value : values) result.append(value);
  return result;
}

inline py::tuple pair_of(const Interval& interval) { return py::make_tuple(interval.lower, interval.upper); }

// Options.

/// A length: a number of mesh units, or text such as "0.1%" of `size`. None is empty.
/// Errors:    ValueError, TypeError naming `what`.
[[nodiscard]] std::optional<double> length_of(const py::object& given, double size, const char* what);
[[nodiscard]] std::optional<double> number_of(const py::object& given, const char* what);
/// None: exact.
[[nodiscard]] WitnessKind witness_kind(const py::object& given);
/// None: `usual`.
[[nodiscard]] std::uint64_t count_of(const py::object& given, std::uint64_t usual, const char* what);
/// A number of threads; 0: all cores.
[[nodiscard]] int threads_of(const py::object& given);
/// The keywords threads and max_splits; None: the default.
[[nodiscard]] Run run_of(const py::object& threads, const py::object& max_splits = py::none());
/// A function of snug._convert, which takes what is not an array of doubles.
[[nodiscard]] py::object convert(const char* function);

}  // namespace snug::python
