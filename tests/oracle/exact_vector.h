#pragma once

#include <array>

#include <gmpxx.h>
#include <oracle/twin_mesh.h>

/// Vectors of rational numbers.
namespace oracle::exact_vectors {

using Vector = std::array<mpq_class, 3>;

inline Vector operator-(const Vector& a, const Vector& b) {
  return {mpq_class(a[0] - b[0]), mpq_class(a[1] - b[1]), mpq_class(a[2] - b[2])};
}
inline mpq_class dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {mpq_class(a[1] * b[2] - a[2] * b[1]), mpq_class(a[2] * b[0] - a[0] * b[2]),
          mpq_class(a[0] * b[1] - a[1] * b[0])};
}
inline Vector exact(const Point& p) { return {mpq_class(p[0]), mpq_class(p[1]), mpq_class(p[2])}; }

}  // namespace oracle::exact_vectors
