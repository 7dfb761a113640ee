#include <array>
#include <cmath>
#include <cstdio>

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

std::string text_of(const Interval& interval) {
  return text_of(interval.lower) + " to " + text_of(interval.upper);
}

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
  add_signatures(module);
}
