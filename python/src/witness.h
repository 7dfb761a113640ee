#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include <snug/collide.h>
#include <snug/contacts.h>
#include <snug/distance.h>
#include <snug/time_of_contact.h>

#include "answers.h"

namespace snug::python {

/// The two points of an answer; null if it has none.
inline const WitnessPoints* witness_of(const Collision& answer) {
  return answer.witness ? &*answer.witness : nullptr;
}
inline const WitnessPoints* witness_of(const TimeOfContact& answer) {
  return answer.witness ? &*answer.witness : nullptr;
}
inline const WitnessPoints* witness_of(const Distance& answer) { return &answer.witness; }
inline const WitnessPoints* witness_of(const SelfContactPair& answer) { return &answer.points; }
inline const WitnessPoints* witness_of(const ContactRegion& answer) { return &answer.witness; }

/// Where these lie.
template <class T>
std::array<std::optional<Place>, 2> places_of(const T& answer) {
  const WitnessPoints* const points = witness_of(answer);
  if (points == nullptr) return {};
  return {(*points)[0].at, (*points)[1].at};
}

/// Adds points, with this text, error, faces, corners and parameters.
template <class T>
void add_witness(AnswerClass<T>& answers, const char* points_doc) {
  answers
      .template array<double>(
          "points", {2, 3},
          [](const T& t, double* out) {
            const WitnessPoints* const points = witness_of(t);
            for (std::size_t s = 0; s < 2; ++s) {
              for (std::size_t k = 0; k < 3; ++k) *out++ = points ? (*points)[s].point[k] : nan;
            }
          },
          points_doc)
      .template array<double>(
          "error", {},
          [](const T& t, double* out) {
            const WitnessPoints* const points = witness_of(t);
            *out = points ? std::max((*points)[0].error, (*points)[1].error) : 0;
          },
          "Upper bound, per coordinate, of the distance from a point to the limit point that it stands for, "
          "(n,).")
      .template array<std::int64_t>(
          "faces", {2},
          [](const T& t, std::int64_t* out) {
            for (const auto& at : places_of(t)) *out++ = at ? std::int64_t{at->owner} : -1;
          },
          "Faces of the points (of dual schemes vertices), (n, 2) int64; -1 where a point was located on the "
          "other surface only.")
      .template array<std::int64_t>(
          "corners", {2},
          [](const T& t, std::int64_t* out) {
            for (const auto& at : places_of(t)) *out++ = at ? std::int64_t{at->corner} : -1;
          },
          "Corners of these faces that the parameters belong to, (n, 2) int64; -1 likewise.")
      .template array<double>(
          "parameters", {2, 2},
          [](const T& t, double* out) {
            for (const auto& at : places_of(t)) {
              *out++ = at ? at->u : nan;
              *out++ = at ? at->v : nan;
            }
          },
          "Parameters u, v of the points, (n, 2, 2); NaN likewise.");
}

template <class T>
void add_contained(AnswerClass<T>& answers) {
  answers.template array<std::int64_t>(
      "contained", {},
      [](const T& t, std::int64_t* out) {
        *out = t.contained ? static_cast<std::int64_t>(*t.contained) : -1;
      },
      "With solid=True: 0 if a point of A's surface lies inside B, 1 the other way round, else -1, (n,) "
      "int64.");
}

template <class T>
void add_stats(AnswerClass<T>& answers) {
  answers.list(
      "stats",
      [](const T& t) {
        py::dict stats;
        stats["box_tests"] = t.stats.box_tests;
        stats["triangle_tests"] = t.stats.triangle_tests;
        stats["evaluations"] = t.stats.evaluations;
        stats["splits"] = t.stats.splits;
        return stats;
      },
      "The work that was done, as a dict; of many answers a list.");
}

}  // namespace snug::python
