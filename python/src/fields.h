#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <snug/fields.h>

#include "answers.h"

namespace snug::python {

/// Whose answers are Answers, and which have a class of their own; others with fields are dicts.
template <class V>
inline constexpr bool is_answer = std::is_same_v<V, ContactRegion> || std::is_same_v<V, SelfContactPair> ||
                                  std::is_same_v<V, OneSidedDistance> || std::is_same_v<V, ClearanceSpan>;
template <class V>
inline constexpr bool is_class =
    std::is_same_v<V, IntersectionCurve> || std::is_same_v<V, ContactArea> || std::is_same_v<V, Hull>;
/// Numbers that lie one after the other.
template <class V>
inline constexpr bool is_numbers = std::is_arithmetic_v<V> || std::is_same_v<V, Point3> ||
                                   std::is_same_v<V, Vector3> || std::is_same_v<V, Interval>;
template <class V, std::size_t N>
inline constexpr bool is_numbers<std::array<V, N>> = is_numbers<V>;

// A value of an answer; views of numbers keep `owner`, which holds it.

template <class T>
py::dict dict_of(const T& answer, py::handle owner);
template <class V, std::size_t N>
py::object value_of(const std::array<V, N>& values, py::handle owner);
template <class V>
py::object value_of(const std::vector<V>& values, py::handle owner);
template <class V>
py::object value_of(const std::optional<V>& value, py::handle owner);

template <class V>
py::object value_of(const V& value, py::handle owner) {
  if constexpr (std::is_enum_v<V>) {
    return py::str(name_of(value));
  } else if constexpr (is_answer<V>) {
    return py::cast(Answers<V>(value));
  } else if constexpr (is_class<V>) {
    return py::cast(&value, py::return_value_policy::reference_internal, owner);
  } else if constexpr (has_fields<V>) {
    return dict_of(value, owner);
  } else {
    return py::cast(value);
  }
}
inline py::object value_of(const Interval& value, py::handle) { return pair_of(value); }
inline py::object value_of(const Point3& p, py::handle) { return py::make_tuple(p.x, p.y, p.z); }
inline py::object value_of(const PatchPlace& at, py::handle) { return py::make_tuple(at.owner, at.part); }
template <std::size_t N>
py::object value_of(const std::array<Interval, N>& value, py::handle owner) {
  return value_view(value, owner);
}
template <class V, std::size_t N>
py::object value_of(const std::array<V, N>& values, py::handle owner) {
  py::tuple all(N);
  for (std::size_t i = 0; i < N; ++i) all[i] = value_of(values[i], owner);
  return all;
}
template <class V>
py::object value_of(const std::optional<V>& value, py::handle owner) {
  return value ? value_of(*value, owner) : py::none();
}
template <class V>
py::object value_of(const std::vector<V>& values, py::handle owner) {
  if constexpr (is_numbers<V>) {
    return column(values, owner);
  } else if constexpr (is_answer<V>) {
    return py::cast(Answers<V>(values));
  } else if constexpr (std::is_same_v<V, CurveBox> || std::is_same_v<V, OpenBox>) {
    static_assert(sizeof(Box3) == 6 * sizeof(double));
    static constexpr double none = 0;
    return read_only<double>({static_cast<py::ssize_t>(values.size()), 2, 3},
                             {sizeof(V), 3 * sizeof(double), sizeof(double)},
                             values.empty() ? &none : &values[0].box.lower.x, owner);
  } else {
    py::list all;
    for (const V& value : values) all.append(value_of(value, owner));
    return all;
  }
}

template <class T>
py::dict dict_of(const T& answer, py::handle owner) {
  py::dict dict;
  for_each_field<T>([&](const auto& field) {
    const std::string name = field.name;
    dict[py::str(name == "owner" ? "face" : name)] = value_of(std::invoke(field.of, answer), owner);
  });
  return dict;
}

/// A class of which an object is one answer: a property for each field.
template <class T>
void add_fields(py::class_<T>& cls) {
  cls.attr("__module__") = "snug";
  add_state(cls);
  for_each_field<T>([&](const auto& field) {
    cls.def_property_readonly(
        field.name,
        [of = field.of](const py::object& self) {
          return py::object(value_of(std::invoke(of, self.cast<const T&>()), self));
        },
        field.text);
  });
}

// Fields of many answers: columns.

/// ", (n, 3)"
template <class V>
std::string shaped(const std::string& text) {
  std::vector<py::ssize_t> shape, strides;
  Layout<V>::add(shape, strides);
  std::string all = " (n,";
  for (std::size_t i = 0; i < shape.size(); ++i) all += (i == 0 ? " " : ", ") + std::to_string(shape[i]);
  return text + all + ")";
}

/// Is a field of T in memory, as numbers or a place?
template <class T, class Of>
inline constexpr bool has_columns = std::is_reference_v<std::invoke_result_t<Of, const T&>> &&
                                    (is_numbers<FieldValue<T, Of>> ||
                                     std::is_same_v<FieldValue<T, Of>, Place>);

/// Calls add(name, member, doc) for each column of the field: an interval's ends, too, and parts of a place.
template <class T, class Of, class Add>
void add_columns(const Field<Of>& field, const Add& add) {
  using V = FieldValue<T, Of>;
  const auto part = [of = field.of](auto member) {
    return [ of, member ](const T& t) -> const auto& { return std::invoke(of, t).*member; };
  };
  if constexpr (std::is_same_v<V, Place>) {
    add("face", part(&Place::owner), "Face of the point (of dual schemes vertex). (n,) uint32");
    add("corner", part(&Place::corner),
        "Corner of the face whose quad has the parameters; 0 for triangles and quads. (n,) uint32");
    add("u", part(&Place::u), "First parameter. (n,)");
    add("v", part(&Place::v), "Second parameter. (n,)");
  } else {
    add(
        field.name, [of = field.of](const T& t) -> const V& { return std::invoke(of, t); },
        shaped<V>(field.text));
  }
  if constexpr (std::is_same_v<V, Interval>) {
    const std::string name = field.name;
    add("lower", part(&Interval::lower), "Lower end of `" + name + "`. (n,)");
    add("upper", part(&Interval::upper), "Upper end of `" + name + "`. (n,)");
  }
}

inline const WitnessPoints* pointer_to(const WitnessPoints& points) { return &points; }
inline const WitnessPoints* pointer_to(const std::optional<WitnessPoints>& points) {
  return points ? &*points : nullptr;
}

/// Adds the two points of witnesses and where they lie.
template <class T, class Of>
void add_witness(AnswerClass<T>& answers, const Field<Of>& field) {
  const auto points = [of = field.of](const T& t) { return pointer_to(std::invoke(of, t)); };
  const auto place = [points](const T& t, std::size_t s) {
    return points(t) ? (*points(t))[s].at : std::nullopt;
  };
  const auto fill = [points](const T& t, double* out) {
    for (std::size_t s = 0; s < 2; ++s) {
      for (std::size_t k = 0; k < 3; ++k) *out++ = points(t) ? (*points(t))[s].point[k] : nan;
    }
  };
  const std::string doc = std::string(field.text) + " (n, 2, 3), world coordinates; NaN if there are none";
  answers.template array<double>("points", {2, 3}, fill, doc.c_str());
  answers.python().def_property_readonly(
      field.name, [](const py::object& self) { return self.attr("points"); },
      "The same as `points`, as other doors name them.");
  answers.template array<double>(
      "error", {},
      [points](const T& t, double* out) {
        *out = points(t) ? std::max((*points(t))[0].error, (*points(t))[1].error) : 0;
      },
      "Upper bound, per coordinate, of the distance from a point to the limit point that it stands for. "
      "(n,)");
  const auto ids = [&](const char* name, std::uint32_t Place::*id, const char* text) {
    answers.template array<std::int64_t>(
        name, {2},
        [place, id](const T& t, std::int64_t* out) {
          for (std::size_t s = 0; s < 2; ++s) out[s] = place(t, s) ? std::int64_t{(*place(t, s)).*id} : -1;
        },
        text);
  };
  ids("faces", &Place::owner,
      "Faces of the points (of dual schemes vertices), (n, 2) int64; -1 where a point was located on the "
      "other surface only.");
  ids("corners", &Place::corner,
      "Corners of these faces that the parameters belong to, (n, 2) int64; -1 likewise.");
  answers.template array<double>(
      "parameters", {2, 2},
      [place](const T& t, double* out) {
        for (std::size_t s = 0; s < 2; ++s) {
          const std::optional<Place> at = place(t, s);
          *out++ = at ? at->u : nan;
          *out++ = at ? at->v : nan;
        }
      },
      "Parameters u, v of the points, (n, 2, 2); NaN likewise.");
}

template <class T, class Of>
void add_field(AnswerClass<T>& answers, const Field<Of>& field) {
  using V = FieldValue<T, Of>;
  const std::string text = field.text;
  const auto array = [&]<class Number>(Number, std::vector<py::ssize_t> shape, const auto& fill,
                                       const std::string& doc) {
    answers.template array<Number>(
        field.name, std::move(shape),
        [of = field.of, fill](const T& t, Number* out) { fill(std::invoke(of, t), out); }, doc.c_str());
  };
  if constexpr (has_columns<T, Of>) {
    add_columns<T>(field, [&](const char* name, const auto& member, const std::string& doc) {
      answers.view(name, member, doc.c_str());
    });
  } else if constexpr (std::is_same_v<V, WitnessPoints> || std::is_same_v<V, std::optional<WitnessPoints>>) {
    add_witness(answers, field);
  } else if constexpr (std::is_same_v<V, std::optional<Vector3>>) {
    array(
        0.0, {3},
        [](const V& v, double* out) {
          for (std::size_t k = 0; k < 3; ++k) out[k] = v ? (*v)[k] : nan;
        },
        text + " (n, 3); NaN where there is none");
  } else if constexpr (std::is_same_v<V, std::optional<double>>) {
    array(
        0.0, {}, [](const V& v, double* out) { *out = v.value_or(HUGE_VAL); },
        text + " (n,); infinite where there is none");
  } else if constexpr (std::is_same_v<V, std::optional<std::size_t>>) {
    array(
        std::int64_t{}, {},
        [](const V& v, std::int64_t* out) { *out = v ? static_cast<std::int64_t>(*v) : -1; },
        text + " 0: A's, 1: B's, else -1. (n,) int64");
  } else if constexpr (std::is_same_v<V, Box3>) {
    array(
        0.0, {2, 3},
        [](const V& box, double* out) {
          for (const Point3& p : {box.lower, box.upper}) {
            for (std::size_t k = 0; k < 3; ++k) *out++ = p[k];
          }
        },
        text + " (n, 2, 3)");
  } else if constexpr (std::is_same_v<V, std::optional<Place>>) {
    answers.template array<std::int64_t>(
        "face", {},
        [of = field.of](const T& t, std::int64_t* out) {
          const std::optional<Place>& at = std::invoke(of, t);
          *out = at ? std::int64_t{at->owner} : -1;
        },
        "Face of the point if its set is a surface, else -1. (n,) int64");
  } else {
    answers.list(
        field.name,
        [of = field.of](const T& t, py::handle self) { return value_of(std::invoke(of, t), self); },
        (text + " Of many answers a list.").c_str());
  }
}

template <class T>
AnswerClass<T>& AnswerClass<T>::fields() {
  for_each_field<T>([&](const auto& field) { add_field(*this, field); });
  return *this;
}

}  // namespace snug::python
