// The library's exceptions as Python's.

#include <stdexcept>

#include "poses.h"
#include "surface.h"

namespace snug::python {
namespace {

py::object error_class(const char* name) { return py::module_::import("snug._errors").attr(name); }

void raise(const py::object& type, const py::object& error) { PyErr_SetObject(type.ptr(), error.ptr()); }

void set_error(const InputError& error) {
  const auto raise_named = [&](const char* name) {
    const py::object type = error_class(name);
    raise(type, type(std::string(error.what())));
  };
  switch (error.problem()) {
    case InputProblem::unreadable:
      return raise_named("FileError");
    case InputProblem::refused:
      return raise_named("MeshError");
    case InputProblem::pose:
      return raise_named("PoseError");
    case InputProblem::value:
      return PyErr_SetString(PyExc_ValueError, error.what());
    case InputProblem::unrepresentable:
      return PyErr_SetString(PyExc_OverflowError, error.what());
  }
}

}  // namespace

void add_errors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const PoseFault& error) {
      const py::object type = error_class("PoseError");
      raise(type, type(std::string(error.what()), error.defect()));
    } catch (const InputError& error) {
      set_error(error);
    } catch (const std::length_error&) {
      PyErr_SetString(PyExc_MemoryError, "the answer is too large");
    }
  });
}

py::object file_text(const std::string& bytes) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeFSDefaultAndSize(bytes.data(), static_cast<py::ssize_t>(bytes.size())));
}

void refuse_undecided(const std::string& message) {
  const py::object type = error_class("UndecidedError");
  raise(type, type(message));
  throw py::error_already_set();
}

void warn(const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  const py::object category = error_class("MeshWarning"),
                   issue = py::module_::import("warnings").attr("warn");
  for (const std::string& line : lines) issue(file_text(line), category);
}

}  // namespace snug::python
