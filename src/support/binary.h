#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string>
#include <vector>

#include <snug/mesh.h>
#include <support/point.h>

namespace snug {

/// The number at `bytes`, stored in the given order.
///
/// Requires:  sizeof(Number) bytes.
template <class Number>
[[nodiscard]] Number load(const char* bytes, std::endian order) {
  std::array<char, sizeof(Number)> own;
  std::copy_n(bytes, sizeof(Number), own.begin());
  if (order != std::endian::native) std::reverse(own.begin(), own.end());
  return std::bit_cast<Number>(own);
}

/// Appends a number in the given order.
template <class Number>
void append_binary(std::string& bytes, Number number, std::endian order = std::endian::little) {
  auto own = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if (order != std::endian::native) std::reverse(own.begin(), own.end());
  bytes.append(own.data(), own.size());
}

/// Points rounded to the nearest floats, for formats that hold no doubles.
///
/// Notes:     one line that says that coordinates were rounded, if any were.
/// Errors:    InputError (refused) naming the vertex if a coordinate is too large for a float. InputError
///            (value) on one that is not finite.
[[nodiscard]] std::vector<std::array<float, 3>> in_single_precision(std::span<const Point3> points,
                                                                    const std::string& name,
                                                                    const Notes& notes);

}  // namespace snug
