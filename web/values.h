// Values of JavaScript, and those of the library as such: plain values, arrays and typed arrays go in and out. What the library
// refuses comes back as {problem, message}; snug.js throws it.

#pragma once

#include <emscripten/bind.h>
#include <emscripten/val.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <snug/snug.h>

namespace snug::web {

using emscripten::val;

// Numbers, copied out of the module's memory.
template <class T>
val copied(std::span<const T> numbers) {
  return val(emscripten::typed_memory_view(numbers.size(), numbers.data())).template call<val>("slice");
}
template <class T>
val copied(const std::vector<T>& numbers) {
  return copied(std::span<const T>(numbers));
}

inline val array_of(const Point3& p) {
  val array = val::array();
  for (int k = 0; k < 3; ++k) array.set(k, p[static_cast<std::size_t>(k)]);
  return array;
}
inline val array_of(const Vector3& v) { return array_of(Point3{v.x, v.y, v.z}); }
inline val array_of(const Interval& interval) {
  val array = val::array();
  array.set(0, interval.lower);
  array.set(1, interval.upper);
  return array;
}

inline bool given(const val& options, const char* name) {
  return !options.isUndefined() && !options.isNull() && !options[name].isUndefined() &&
         !options[name].isNull();
}
template <class T>
std::optional<T> option(const val& options, const char* name) {
  if (!given(options, name)) return {};
  return options[name].as<T>();
}
// One call's: `maxSplits`, and `progress`, which is called with the fraction done and ends the call by false.
class PageRun : public Run {
 public:
  explicit PageRun(const val& options, std::optional<std::uint64_t> usual = {}) {
    threads = 1;
    max_splits = usual;
    if (const std::optional<double> splits = option<double>(options, "maxSplits")) {
      if (!(*splits >= 0 && *splits <= 0x1p53)) {
        throw InputError(InputProblem::value, "maxSplits: give a whole number that is not negative");
      }
      max_splits = static_cast<std::uint64_t>(*splits);
    }
    if (!given(options, "progress")) return;
    monitor_.stop = &stop_;
    monitor_.on_progress = [this, call = options["progress"]](double done) {
      if (call(done).isFalse()) stop_ = true;
    };
    monitor = &monitor_;
  }
  PageRun(const PageRun&) = delete;
  PageRun& operator=(const PageRun&) = delete;

 private:
  std::atomic<bool> stop_{false};
  WorkMonitor monitor_;
};
inline PageRun run_of(const val& options, std::optional<std::uint64_t> usual = {}) {
  return PageRun(options, usual);
}

inline const char* name_of_problem(InputProblem problem) {
  switch (problem) {
    case InputProblem::unreadable:
      return "unreadable";
    case InputProblem::refused:
      return "refused";
    case InputProblem::pose:
      return "pose";
    case InputProblem::value:
      return "value";
    case InputProblem::unrepresentable:
      break;
  }
  return "unrepresentable";
}

inline val fault(const char* problem, const std::string& message) {
  val result = val::object();
  result.set("problem", std::string(problem));
  result.set("message", message);
  return result;
}

// The result of work(), or its exception.
template <class Work>
val guarded(const Work& work) {
  constexpr const char* out_of_memory = "out of memory: the mesh or the answer is too large for a page";
  try {
    return work();
  } catch (const InputError& error) {
    return fault(name_of_problem(error.problem()), error.what());
  } catch (const Interrupted&) {
    return fault("interrupted", "interrupted: progress() returned false");
  } catch (const std::bad_alloc&) {
    return fault("memory", out_of_memory);
  } catch (const std::length_error&) {
    return fault("memory", out_of_memory);
  }
}

inline val array_of(const Motion& motion) {
  val array = val::array();
  for (std::size_t i = 0; i < 12; ++i) array.set(i, motion.numbers()[i]);
  return array;
}

// Triples of numbers, one after the other.
template <class Index>
std::vector<std::uint32_t> flat(const std::vector<std::array<Index, 3>>& triangles) {
  std::vector<std::uint32_t> numbers;
  for (const auto& each : triangles) numbers.insert(numbers.end(), each.begin(), each.end());
  return numbers;
}
template <class Triple>
std::vector<double> flat_points(const std::vector<Triple>& points) {
  std::vector<double> numbers;
  for (const Triple& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
  return numbers;
}

// None where nothing was given.
inline std::vector<double> list_of(const val& numbers) {
  if (numbers.isUndefined() || numbers.isNull()) return {};
  return emscripten::convertJSArrayToNumberVector<double>(numbers);
}
inline Vector3 vector_of(const val& numbers, const char* what) {
  const std::vector<double> read = list_of(numbers);
  if (read.size() != 3) throw InputError(InputProblem::value, std::string(what) + ": give three numbers");
  return {read[0], read[1], read[2]};
}
inline Point3 point_of(const val& numbers, const char* what) {
  const Vector3 v = vector_of(numbers, what);
  return {v.x, v.y, v.z};
}

// Text that is told apart by its end alone.
inline val word(const char* name) { return val(std::string(name)); }

// The object of a place.
inline val object_of(const Place& at) {
  val place = val::object();
  place.set("owner", at.owner);
  place.set("corner", at.corner);
  place.set("u", at.u);
  place.set("v", at.v);
  return place;
}

}  // namespace snug::web
