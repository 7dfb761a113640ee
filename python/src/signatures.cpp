#include "signatures.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>

namespace snug::python {
namespace {

using Record = py::detail::function_record;

/// Pybind11's record of a function; null for a function that it did not make, and for overloads.
const Record* record_of(py::handle object) {
  const py::handle function = py::detail::get_function(object);
  if (!function || PyCFunction_Check(function.ptr()) == 0) return nullptr;
  const py::handle self = PyCFunction_GET_SELF(function.ptr());
  if (!self || !py::isinstance<py::capsule>(self)) return nullptr;
  const Record* const record = py::reinterpret_borrow<py::capsule>(self).get_pointer<Record>();
  return record->next == nullptr && !record->has_args && !record->has_kwargs ? record : nullptr;
}

/// "(vertices, faces=None, *, scheme='auto')", from the argument `first` on.
std::string parameters_of(const Record& record, std::size_t first) {
  std::string text = "(";
  const auto add = [&](const std::string& word) { text += (text.size() > 1 ? ", " : "") + word; };
  if (record.args.empty()) {  // no names were declared
    for (std::size_t i = first; i < record.nargs; ++i)
      add(i == 0 && record.is_method ? "self" : "_" + std::to_string(i));
    return text + ")";
  }
  for (std::size_t i = first; i < record.args.size(); ++i) {
    if (i == record.nargs_pos) add("*");
    const py::detail::argument_record& argument = record.args[i];
    add(std::string(argument.name) + (argument.value ? std::string("=") + argument.descr : ""));
  }
  return text + ")";
}

// What is amiss with the arguments of a call.
std::string fault_of(const Record& record, const py::tuple& given, const py::dict& named) {
  for (const auto& item : named) {
    const auto name = item.first.cast<std::string>();
    const bool known = std::any_of(record.args.begin(), record.args.end(),
                                   [&](const auto& argument) { return name == argument.name; });
    if (!known) return "has no argument '" + name + "'";
  }
  const std::size_t own = record.is_method ? 1 : 0;
  if (given.size() > record.nargs_pos) {
    return "takes " +
           (record.nargs_pos == own ? std::string("none")
                                    : "at most " + std::to_string(record.nargs_pos - own)) +
           " by position, not " + std::to_string(given.size() - own);
  }
  std::string types;
  for (std::size_t i = own; i < record.args.size(); ++i) {
    const py::detail::argument_record& argument = record.args[i];
    const bool is_named = named.contains(argument.name);
    if (i < given.size() && is_named) return "was given '" + std::string(argument.name) + "' twice";
    if (i >= given.size() && !is_named) {
      if (!argument.value) return "needs '" + std::string(argument.name) + "'";
      continue;
    }
    const py::object value = is_named ? py::object(named[argument.name]) : py::object(given[i]);
    types += (types.empty() ? "" : ", ") + std::string(argument.name) + " is of " +
             py::type::of(value).attr("__name__").cast<std::string>();
  }
  return "cannot take these types: " + types;
}

PyCFunctionWithKeywords dispatcher = nullptr;  // of pybind11, the same for all functions

// Its text about arguments that do not fit has a dozen lines; ours is one, with the signature.
PyObject* call(PyObject* self, PyObject* args, PyObject* kwargs) {
  PyObject* const result = dispatcher(self, args, kwargs);
  if (result != nullptr || PyErr_ExceptionMatches(PyExc_TypeError) == 0) return result;
  py::error_already_set error;
  const Record* const record = py::reinterpret_borrow<py::capsule>(self).get_pointer<Record>();
  const std::string text = py::str(error.value());
  if (!text.starts_with(std::string(record->name) + "(): incompatible ")) {
    error.restore();
    return nullptr;
  }
  const std::string name = std::string(record->name) == "__init__"
                               ? record->scope.attr("__name__").cast<std::string>()
                               : record->name;
  const py::dict named = kwargs != nullptr ? py::reinterpret_borrow<py::dict>(kwargs) : py::dict();
  const std::string fault = fault_of(*record, py::reinterpret_borrow<py::tuple>(args), named);
  const std::string message =
      name + "() " + fault + ": " + name + parameters_of(*record, record->is_method ? 1 : 0);
  PyErr_SetString(PyExc_TypeError, message.c_str());
  return nullptr;
}

/// How CPython keeps a signature: before the text, which it tells apart from it.
std::string with_signature(const std::string& name, const std::string& parameters, const char* text) {
  return name + parameters + "\n--\n\n" + (text != nullptr ? text : "");
}

void sign(py::handle object) {
  const Record* const record = record_of(object);
  if (record == nullptr) return;
  const std::string text = with_signature(record->name, parameters_of(*record, 0), record->def->ml_doc);
  std::free(const_cast<char*>(record->def->ml_doc));  // NOLINT: as pybind11 does, who made it by strdup()
  record->def->ml_doc = strdup(text.c_str());
  // Names of arguments that were not declared cannot be told.
  if (record->args.empty() && record->nargs > (record->is_method ? 1U : 0U)) return;
  // By way of a type that compilers take for any function's.
  using Any = void (*)();
  dispatcher =
      reinterpret_cast<PyCFunctionWithKeywords>(reinterpret_cast<Any>(record->def->ml_meth));  // NOLINT
  record->def->ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<Any>(call));           // NOLINT
}

/// A class is called as its constructor is.
void sign_class(py::handle cls) {
  const Record* const record = record_of(cls.attr("__init__"));
  auto* const type = reinterpret_cast<PyTypeObject*>(cls.ptr());  // NOLINT
  if (record == nullptr || type->tp_doc == nullptr) return;
  const std::string text = with_signature(record->scope.attr("__name__").cast<std::string>(),
                                          parameters_of(*record, 1), type->tp_doc);
  auto* const kept = static_cast<char*>(PyObject_Malloc(text.size() + 1));
  if (kept == nullptr) throw std::bad_alloc();
  std::memcpy(kept, text.c_str(), text.size() + 1);
  PyObject_Free(const_cast<char*>(type->tp_doc));  // NOLINT: a class of Python's heap owns it
  type->tp_doc = kept;
}

// Pybind11's own sentence names no way out.
void refuse_to_make(py::handle cls) {
  const auto name = cls.attr("__name__").cast<std::string>();
  cls.attr("__init__") = py::cpp_function(
      [name](const py::object&, const py::args&, const py::kwargs&) {
        throw py::type_error(name + "() makes none: functions of snug return it");
      },
      py::name(name.c_str()), py::is_method(cls));
}

}  // namespace

void add_signatures(const py::module_& module) {
  for (const auto& [name, thing] : py::reinterpret_borrow<py::dict>(module.attr("__dict__"))) {
    sign(thing);
    if (!py::isinstance<py::type>(thing)) continue;
    const py::dict members(thing.attr("__dict__"));
    const bool is_made = PyObject_TypeCheck(members["__init__"].ptr(), &PyWrapperDescr_Type) == 0;
    if (!is_made) refuse_to_make(thing);
    for (const auto& item : members) {
      const auto member = item.first.cast<std::string>();
      const bool is_static = PyObject_TypeCheck(item.second.ptr(), &PyStaticMethod_Type) != 0;
      if (member == "__init__") sign_class(thing);
      if (!member.starts_with("_") || member == "__init__")
        sign(is_static ? py::object(item.second.attr("__func__")) : item.second);
    }
  }
}

}  // namespace snug::python
