#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <snug/fields.h>

#include "arrays.h"
#include "state.h"

namespace snug::python {

/// The answer to one question or to many, as the library gave it. Python sees it as one class: numbers and small arrays
/// of one answer, arrays with one row an answer of many. All arrays are read-only. Where the answers hold the numbers an
/// array is a view that keeps them alive; the others are made when they are first looked at, and kept.
template <class T>
class Answers {
 public:
  explicit Answers(T one) : held_(std::move(one)) {}
  explicit Answers(std::vector<T> many) : held_(std::move(many)) {}

  [[nodiscard]] bool single() const { return std::holds_alternative<T>(held_); }
  [[nodiscard]] std::span<const T> all() const {
    if (const T* const one = std::get_if<T>(&held_)) return {one, 1};
    return std::get<std::vector<T>>(held_);
  }
  [[nodiscard]] const T& one() const { return std::get<T>(held_); }

  /// The array of this number, which make() makes the first time. It must not hold the answers: the two would never end.
  template <class Make>
  [[nodiscard]] py::object kept(std::size_t number, const Make& make) const {
    if (number >= made_.size() || !made_[number]) {
      py::object array = make();  // which may run other code of Python, and that come here
      if (number >= made_.size()) made_.resize(number + 1);
      if (!made_[number]) made_[number] = std::move(array);
    }
    return made_[number];
  }

 private:
  std::variant<T, std::vector<T>> held_;
  mutable std::vector<py::object> made_;
};

/// Adds properties to the class of Answers<T>.
template <class T>
class AnswerClass {
 public:
  using Self = Answers<T>;

  AnswerClass(py::module_& module, const char* name, const char* doc)
      : class_(module, name, doc), name_(name) {
    class_.attr("__module__") = "snug";
    class_.def("__len__", [](const Self& self) {
      if (self.single()) throw py::type_error("a single answer has no length; see its numbers");
      return self.all().size();
    });
    class_.def("__getitem__", [](const Self& self, py::ssize_t i) {
      if (self.single()) throw py::type_error("a single answer has no items");
      const auto n = static_cast<py::ssize_t>(self.all().size());
      if (i < -n || i >= n) throw py::index_error("answer " + std::to_string(i) + " of " + std::to_string(n));
      return Self(self.all()[static_cast<std::size_t>(i < 0 ? i + n : i)]);
    });
    class_.def("__getitem__", [](const Self& self, const py::slice& rows) {
      if (self.single()) throw py::type_error("a single answer has no items");
      std::size_t begin = 0, end = 0, step = 0, count = 0;
      if (!rows.compute(self.all().size(), &begin, &end, &step, &count)) throw py::error_already_set();
      std::vector<T> taken;
      taken.reserve(count);
      for (std::size_t i = 0; i < count; ++i) taken.push_back(self.all()[begin + i * step]);
      return Self(std::move(taken));
    });
    def_pickle();
    const auto itself = [](const py::object& self, const py::args&) { return self; };  // answers never change
    class_.def("__copy__", itself);
    class_.def("__deepcopy__", itself);
  }

  /// A member that member(const T&) refers to.
  template <class Member>
  AnswerClass& view(const char* name, const Member& member, const char* doc) {
    class_.def_property_readonly(
        name,
        [member](const py::object& object) -> py::object {
          const Self& self = object.cast<const Self&>();
          using V = std::remove_cvref_t<decltype(member(self.one()))>;
          if (!self.single()) return column(self.all(), member, object);
          if constexpr (std::is_arithmetic_v<V>) {
            return py::cast(member(self.one()));
          } else {
            return value_view(member(self.one()), object);
          }
        },
        doc);
    return *this;
  }

  /// fill(const T&, Number*) writes as many numbers as `shape` has, for each answer.
  template <class Number, class Fill>
  AnswerClass& array(const char* name, std::vector<py::ssize_t> shape, const Fill& fill, const char* doc) {
    class_.def_property_readonly(
        name,
        [shape, fill, number = arrays_++](const Self& self) -> py::object {
          if (shape.empty() && self.single()) return py::cast(*filled<Number>(self, shape, fill).data());
          return self.kept(number, [&] { return read_only(filled<Number>(self, shape, fill)); });
        },
        doc);
    return *this;
  }

  /// The object that of(const T&, py::handle self) returns; for many answers, a list of them.
  template <class Of>
  AnswerClass& list(const char* name, const Of& of, const char* doc) {
    class_.def_property_readonly(
        name,
        [of](const py::object& object) -> py::object {
          const Self& self = object.cast<const Self&>();
          if (self.single()) return of(self.one(), object);
          py::list result;
          for (const T& each : self.all()) result.append(of(each, object));
          return result;
        },
        doc);
    return *this;
  }

  /// The fields of T: python/src/fields.h.
  AnswerClass& fields();

  /// <snug.Name text>; <snug.Name of n>, and what summary(span) says of many.
  template <class Text, class Summary>
  AnswerClass& repr(const Text& text, const Summary& summary) {
    class_.def("__repr__", [text, summary, name = std::string(name_)](const Self& self) {
      return "<snug." + name + " " +
             (self.single() ? text(self.one())
                            : "of " + std::to_string(self.all().size()) + summary(self.all())) +
             ">";
    });
    return *this;
  }
  template <class Text>
  AnswerClass& repr(const Text& text) {
    return repr(text, [](std::span<const T>) { return std::string(); });
  }

  [[nodiscard]] py::class_<Self>& python() { return class_; }

 private:
  void def_pickle() {
    class_.def(py::pickle(
        [](const Self& self) {
          const std::span<const T> all = self.all();
          return py::make_tuple(SNUG_VERSION, sizeof(T), self.single(),
                                State::save(std::vector<T>(all.begin(), all.end())));
        },
        [](const py::tuple& state) {
          if (state.size() != 4 || state[0].cast<std::string>() != SNUG_VERSION ||
              state[1].cast<std::size_t>() != sizeof(T)) {
            State::refuse();
          }
          std::vector<T> many;
          State::restore(state[3], many);
          if (!state[2].cast<bool>()) return Self(std::move(many));
          if (many.size() != 1) State::refuse();
          return Self(std::move(many[0]));
        }));
  }

  template <class Number, class Fill>
  static py::array_t<Number> filled(const Self& self, std::vector<py::ssize_t> shape, const Fill& fill) {
    std::size_t step = 1;
    for (const py::ssize_t extent : shape) step *= static_cast<std::size_t>(extent);
    if (!self.single()) shape.insert(shape.begin(), static_cast<py::ssize_t>(self.all().size()));
    py::array_t<Number> result(shape);
    Number* out = result.mutable_data();
    for (const T& each : self.all()) {
      fill(each, out);
      out += step;
    }
    return result;
  }

  py::class_<Self> class_;
  const char* name_;
  std::size_t arrays_ = 0;
};

/// x in as few digits as tell it, at most `digits`.
[[nodiscard]] std::string text_of(double x, int digits = 4);
/// Rounded up: the number is at most what is shown; or down.
[[nodiscard]] std::string text_at_most(double x);
[[nodiscard]] std::string text_at_least(double x);
/// Both ends, with as many digits as tell them apart, rounded outward.
[[nodiscard]] std::string text_of(const Interval& interval);

}  // namespace snug::python
