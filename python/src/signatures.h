#pragma once

#include <pybind11/pybind11.h>

namespace snug::python {

namespace py = pybind11;

/// Gives the functions of a module, the methods of its classes and their constructors the signatures that help(),
/// notebooks and the inspect module show, of the names and defaults that they were declared with.
void add_signatures(const py::module_& module);

}  // namespace snug::python
