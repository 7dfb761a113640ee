#pragma once

#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <snug/surface.h>

#include "arrays.h"

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
    if constexpr (std::is_trivially_copyable_v<T>) def_pickle();
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

  /// Both ends of an interval that of(const T&) refers to.
  template <class Of>
  AnswerClass& interval(const Of& of, const char* lower_doc, const char* upper_doc) {
    view(
        "lower", [of](const T& t) -> const double& { return of(t).lower; }, lower_doc);
    return view(
        "upper", [of](const T& t) -> const double& { return of(t).upper; }, upper_doc);
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

  /// The object that of(const T&) returns; for many answers, a list of them.
  template <class Of>
  AnswerClass& list(const char* name, const Of& of, const char* doc) {
    class_.def_property_readonly(
        name,
        [of](const Self& self) -> py::object {
          if (self.single()) return of(self.one());
          py::list result;
          for (const T& each : self.all()) result.append(of(each));
          return result;
        },
        doc);
    return *this;
  }

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
  // For processes of the same build: the bytes as they are in memory.
  void def_pickle() {
    class_.def(py::pickle(
        [](const Self& self) {
          const std::span<const T> all = self.all();
          return py::make_tuple(
              SNUG_VERSION, sizeof(T), self.single(),
              py::bytes(reinterpret_cast<const char*>(all.data()), all.size_bytes()));  // NOLINT
        },
        [](const py::tuple& state) {
          if (state.size() != 4 || state[0].cast<std::string>() != SNUG_VERSION ||
              state[1].cast<std::size_t>() != sizeof(T)) {
            throw py::value_error("pickled by another version of snug");
          }
          const auto bytes = state[3].cast<std::string>();
          std::vector<T> many(bytes.size() / sizeof(T));
          if (!many.empty())
            std::memcpy(static_cast<void*>(many.data()), bytes.data(), many.size() * sizeof(T));
          if (!state[2].cast<bool>()) return Self(std::move(many));
          if (many.size() != 1) throw py::value_error("pickled by another version of snug");
          return Self(many[0]);
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
/// Both ends, with as many digits as tell them apart.
[[nodiscard]] std::string text_of(const Interval& interval);

/// Adds face, corner, u, v of the places that at(const T&) refers to.
template <class T, class At>
void add_place(AnswerClass<T>& answers, const At& at) {
  answers
      .view(
          "face", [at](const T& t) -> const std::uint32_t& { return at(t).owner; },
          "Face of the point, (n,) uint32; in a dual scheme its vertex.")
      .view(
          "corner", [at](const T& t) -> const std::uint32_t& { return at(t).corner; },
          "Corner of the face whose quad has the parameters, (n,) uint32; 0 for triangles and quads.")
      .view(
          "u", [at](const T& t) -> const double& { return at(t).u; }, "First parameter, (n,).")
      .view(
          "v", [at](const T& t) -> const double& { return at(t).v; }, "Second parameter, (n,).");
}

/// Adds how the search ended.
template <class T>
void add_outcome(AnswerClass<T>& answers) {
  answers.list(
      "outcome", [](const T& t) { return py::str(name_of(t.outcome)); },
      "'complete', 'budget-spent' or 'at-rounding'; of many answers a list. The answer holds in any case.");
}

}  // namespace snug::python
