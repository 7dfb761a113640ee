#pragma once

#include <concepts>
#include <cstring>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

namespace snug::python {

namespace py = pybind11;

/// S, const or not.
template <class T, class S>
concept Either = std::is_same_v<std::remove_const_t<T>, S>;

/// A value as bytes and tuples, for processes of the same build: numbers as they are in memory. A struct that owns
/// memory is given by members_of(), which ties its members and stands beside it.
/// Errors:    restore() raises ValueError for what save() did not make.
class State {
 public:
  template <class T>
  static py::object save(const T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      return bytes_of(&value, 1);
    } else {
      return save_owner(value);
    }
  }
  template <class T>
  static void restore(const py::handle state, T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      const std::string bytes = text_of(state, sizeof(T));
      if (bytes.size() != sizeof(T)) refuse();
      std::memcpy(static_cast<void*>(&value), bytes.data(), bytes.size());
    } else {
      restore_owner(state, value);
    }
  }

  [[noreturn]] static void refuse() { throw py::value_error("pickled by another version of snug"); }

 private:
  template <class T>
  static py::bytes bytes_of(const T* first, std::size_t count) {
    return {reinterpret_cast<const char*>(first), count * sizeof(T)};  // NOLINT
  }
  static std::string text_of(const py::handle state, std::size_t size) {
    if (!PyBytes_Check(state.ptr())) refuse();
    auto bytes = state.cast<std::string>();
    if (bytes.size() % size != 0) refuse();
    return bytes;
  }
  static py::tuple tuple_of(const py::handle state) {
    if (!PyTuple_Check(state.ptr())) refuse();
    return py::reinterpret_borrow<py::tuple>(state);
  }

  static py::object save_owner(const std::string& text) { return py::bytes(text); }
  static void restore_owner(const py::handle state, std::string& text) { text = text_of(state, 1); }

  template <class T>
  static py::object save_owner(const std::vector<T>& values) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      return bytes_of(values.data(), values.size());
    } else {
      py::list states;
      for (const T& value : values) states.append(save(value));
      return py::tuple(states);
    }
  }
  template <class T>
  static void restore_owner(const py::handle state, std::vector<T>& values) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      const std::string bytes = text_of(state, sizeof(T));
      values.resize(bytes.size() / sizeof(T));
      if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    } else {
      const py::tuple states = tuple_of(state);
      values.resize(states.size());
      for (std::size_t i = 0; i < values.size(); ++i) restore(states[i], values[i]);
    }
  }

  template <class T>
  static py::object save_owner(const std::optional<T>& value) {
    return value ? py::make_tuple(save(*value)) : py::tuple();
  }
  template <class T>
  static void restore_owner(const py::handle state, std::optional<T>& value) {
    const py::tuple states = tuple_of(state);
    if (states.size() > 1) refuse();
    value.reset();
    if (states.size() == 1) restore(states[0], value.emplace());
  }

  template <class T>
  static auto save_owner(const T& value) -> decltype(members_of(value), py::object()) {
    return std::apply([](const auto&... members) { return py::make_tuple(save(members)...); },
                      members_of(value));
  }
  template <class T>
  static auto restore_owner(const py::handle state, T& value) -> decltype(members_of(value), void()) {
    const py::tuple states = tuple_of(state);
    std::apply(
        [&](auto&... members) {
          if (states.size() != sizeof...(members)) refuse();
          std::size_t i = 0;
          (restore(states[i++], members), ...);
        },
        members_of(value));
  }
};

/// Pickles and copies of a class whose objects never change.
template <class T>
void add_state(py::class_<T>& cls) {
  cls.def(py::pickle([](const T& self) { return py::make_tuple(SNUG_VERSION, sizeof(T), State::save(self)); },
                     [](const py::tuple& state) {
                       if (state.size() != 3 || state[0].cast<std::string>() != SNUG_VERSION ||
                           state[1].cast<std::size_t>() != sizeof(T)) {
                         State::refuse();
                       }
                       T value{};
                       State::restore(state[2], value);
                       return value;
                     }));
  const auto itself = [](const py::object& self, const py::args&) { return self; };
  cls.def("__copy__", itself);
  cls.def("__deepcopy__", itself);
}

}  // namespace snug::python
