#include "arrays.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include <snug/run.h>

namespace snug::python {
namespace {

bool is_plain(py::handle numbers) {
  if (!py::isinstance<py::array>(numbers)) return false;
  const auto array = py::reinterpret_borrow<py::array>(numbers);
  // Of numpy's own class: a masked array is of another one.
  if (Py_TYPE(numbers.ptr()) != py::detail::npy_api::get().PyArray_Type_) return false;
  constexpr int wanted =
      py::detail::npy_api::NPY_ARRAY_C_CONTIGUOUS_ | py::detail::npy_api::NPY_ARRAY_ALIGNED_;
  if ((array.flags() & wanted) != wanted) return false;
  const auto* const type = py::detail::array_descriptor_proxy(py::detail::array_proxy(array.ptr())->descr);
  return type->type_num == py::detail::npy_api::NPY_DOUBLE_ && type->byteorder != '>';
}

std::optional<Point3> plain_point(PyObject* given) {
  const bool is_list = PyList_CheckExact(given) != 0;
  if (!is_list && PyTuple_CheckExact(given) == 0) return {};
  if ((is_list ? PyList_GET_SIZE(given) : PyTuple_GET_SIZE(given)) != 3) return {};
  Point3 point;
  for (Py_ssize_t k = 0; k < 3; ++k) {
    const std::optional<double> number =
        plain_number(is_list ? PyList_GET_ITEM(given, k) : PyTuple_GET_ITEM(given, k));
    if (!number) return {};
    point[static_cast<std::size_t>(k)] = *number;
  }
  return point;
}

[[noreturn]] void refuse(const std::string& message) { throw InputError(InputProblem::value, message); }

}  // namespace

py::object convert(const char* function) { return py::module_::import("snug._convert").attr(function); }

Doubles::Doubles(py::handle numbers, const char* what)
    : array_(is_plain(numbers) ? py::reinterpret_borrow<py::array>(numbers)
                               : py::array(convert("doubles")(numbers, what))) {}

std::string Doubles::shape_text() const {
  std::string text = "(";
  for (std::size_t axis = 0; axis < dimensions(); ++axis) {
    text += (axis > 0 ? ", " : "") + std::to_string(extent(axis));
  }
  return text + (dimensions() == 1 ? ",)" : ")");
}

std::optional<double> plain_number(PyObject* given) {
  if (Py_TYPE(given) == &PyFloat_Type) return PyFloat_AS_DOUBLE(given);
  if (Py_TYPE(given) != &PyLong_Type) return {};
  int overflow = 0;
  const long long number = PyLong_AsLongLongAndOverflow(given, &overflow);
  if (overflow != 0) return {};
  return static_cast<double>(number);
}

Points::Points(py::handle numbers, const char* what) : plain_(plain_point(numbers.ptr())) {
  if (plain_) return;
  numbers_.emplace(numbers, what);
  const std::size_t dimensions = numbers_->dimensions();
  if ((dimensions == 1 || dimensions == 2) && numbers_->last(0) == 3) return;
  refuse(std::string(what) + " has the shape " + numbers_->shape_text() + "; give (3,) or (n, 3)");
}

std::span<const Point3> Points::all() const {
  static_assert(sizeof(Point3) == 3 * sizeof(double));
  if (plain_) return {&*plain_, 1};
  return {reinterpret_cast<const Point3*>(numbers_->data()), single() ? 1 : numbers_->extent(0)};  // NOLINT
}

std::optional<double> number_of(const py::object& given, const char* what) {
  if (given.is_none()) return {};
  const double number = PyFloat_AsDouble(given.ptr());
  if (number == -1 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw py::type_error(std::string(what) + ": give a number, not " + py::repr(given).cast<std::string>());
  }
  return number;
}

std::optional<double> length_of(const py::object& given, double size, const char* what) {
  if (!py::isinstance<py::str>(given)) return number_of(given, what);
  Py_ssize_t bytes = 0;
  const char* const text = PyUnicode_AsUTF8AndSize(given.ptr(), &bytes);  // which the object keeps
  if (text == nullptr) throw py::error_already_set();
  std::string_view digits(text, static_cast<std::size_t>(bytes));
  while (digits.starts_with(' ')) digits.remove_prefix(1);
  while (digits.ends_with(' ')) digits.remove_suffix(1);
  const bool percent = digits.ends_with('%');
  if (percent) digits.remove_suffix(1);
  while (digits.ends_with(' ')) digits.remove_suffix(1);
  double number = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (fault != std::errc() || end != digits.data() + digits.size() || !std::isfinite(number)) {
    refuse(std::string(what) + ": '" + std::string(text) +
           "' is not a length; give mesh units (0.01) or percent of the size (\"1%\")");
  }
  const double length = percent ? number / 100 * size : number;
  if (!std::isfinite(length) || (number > 0 && !(length > 0))) {
    refuse(std::string(what) +
           ": a length in percent does not fit a double for a mesh of this size; give it in mesh units");
  }
  return length;
}

WitnessKind witness_kind(const py::object& given) {
  if (given.is_none()) return WitnessKind::exact;
  const auto is = [&](const char* name) {
    return py::isinstance<py::str>(given) && PyUnicode_CompareWithASCIIString(given.ptr(), name) == 0;
  };
  if (is("none")) return WitnessKind::none;
  if (is("approximate")) return WitnessKind::approximate;
  if (is("exact")) return WitnessKind::exact;
  refuse("witness: " + py::repr(given).cast<std::string>() + " is none of 'none', 'approximate', 'exact'");
}

std::uint64_t count_of(const py::object& given, std::uint64_t usual, const char* what) {
  if (given.is_none()) return usual;
  const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
  const std::uint64_t count = whole ? PyLong_AsUnsignedLongLong(whole.ptr()) : 0;
  if (PyErr_Occurred() == nullptr) return count;
  PyErr_Clear();
  refuse(std::string(what) + ": " + py::repr(given).cast<std::string>() +
         " is not a whole number from 0 to 2^64 - 1");
}

int threads_of(const py::object& given) {
  constexpr std::uint64_t most = 4096;
  const std::uint64_t threads = count_of(given, 0, "threads");
  if (threads > most) refuse("threads: give at most 4096; 0 takes all cores");
  return static_cast<int>(threads);
}

Run run_of(const py::object& threads, const py::object& max_splits) {
  Run run{.threads = threads_of(threads)};
  if (!max_splits.is_none()) run.max_splits = count_of(max_splits, 0, "max_splits");
  return run;
}

}  // namespace snug::python
