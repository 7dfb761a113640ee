#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "answers.h"
#include "call.h"
#include "signatures.h"
#include "surface.h"

namespace snug::python {

std::string text_of(double x, int digits) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%.*g", digits, x);
  return text.data();
}

namespace {

// Rounded up, where `way` is 1, or down.
std::string rounded(double x, double way, int digits = 4) {
  std::string text = text_of(x, digits);
  const double shown = std::strtod(text.c_str(), nullptr);
  if (digits < 17 && (shown - x) * way < 0)
    text = text_of(shown + way * std::pow(10.0, std::floor(std::log10(std::fabs(x))) + 1 - digits), digits);
  return text;
}

}  // namespace

std::string text_at_most(double x) { return rounded(x, 1); }
std::string text_at_least(double x) { return rounded(x, -1); }

std::string text_of(const Interval& interval) {
  std::string lower, upper;
  for (int digits = 4; digits <= 17; ++digits) {
    lower = rounded(interval.lower, -1, digits);
    upper = rounded(interval.upper, 1, digits);
    if (lower != upper || interval.lower == interval.upper) break;
  }
  return lower + " to " + upper;
}

namespace {

// pybind11 gives an object that __new__ made and __init__ did not a value of memory as it is; a class of Python can get
// at it. Zeros are an answer, a mesh or triangles without content, and a surface that says what is amiss.
void* zeros(std::size_t size) { return std::memset(::operator new(size), 0, size); }

void zero_what_is_not_made(const py::module_& module) {
  for (const auto& item : py::dict(module.attr("__dict__"))) {
    if (!py::isinstance<py::type>(item.second)) continue;
    py::detail::type_info* const info =
        py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(item.second.ptr()));  // NOLINT
    if (info != nullptr) info->operator_new = zeros;
  }
}

}  // namespace

}  // namespace snug::python

PYBIND11_MODULE(_snug, module) {
  using namespace snug::python;  // NOLINT
  py::options options;
  options.disable_function_signatures();
  module.attr("__version__") = SNUG_VERSION;
  Call::prepare();
  add_errors(module);
  add_surface(module);
  add_pair_queries(module);
  add_motions(module);
  add_robots(module);
  add_signatures(module);
  quicken_collide(module);
  zero_what_is_not_made(module);
}
