// Vector code, compiled once for each instruction set. A file of it defines HWY_TARGET_INCLUDE as its own
// path and includes this first: no #pragma once, since each instruction set reads it again.
#ifdef SNUG_SANITIZED  // one old and one common instruction set, since their checks take minutes to compile
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#else
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#endif
#include <hwy/foreach_target.h>
// After it, as the library wants it.
#include <hwy/highway.h>

#include <cstdint>

#if defined(SNUG_GEOMETRY_VECTOR_CODE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SNUG_GEOMETRY_VECTOR_CODE_INL_H
#undef SNUG_GEOMETRY_VECTOR_CODE_INL_H
#else
#define SNUG_GEOMETRY_VECTOR_CODE_INL_H
#endif

// For functions whose vectors stay in registers only where everything is inlined. Sanitizers' checks take minutes to compile then.
#undef SNUG_FLAT
#ifdef SNUG_SANITIZED
#define SNUG_FLAT
#else
#define SNUG_FLAT HWY_FLATTEN
#endif

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A vector of space a lane. No operators of Highway's: the portable target lacks them.
template <class V>
struct Vec3 {
  V x, y, z;
};

template <class V>
HWY_INLINE V dot(const Vec3<V>& a, const Vec3<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class V>
HWY_INLINE Vec3<V> add(const Vec3<V>& a, const Vec3<V>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class V>
HWY_INLINE Vec3<V> sub(const Vec3<V>& a, const Vec3<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Vec3<V> scaled(V s, const Vec3<V>& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
template <class V>
HWY_INLINE Vec3<V> cross(const Vec3<V>& a, const Vec3<V>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

// A bit for each lane of a mask, of at most eight lanes.
template <class D>
HWY_INLINE std::uint32_t bits(D d, hn::Mask<D> mask) {
  std::uint8_t result = 0;
  hn::StoreMaskBits(d, mask, &result);
  return result & ((1u << hn::Lanes(d)) - 1);
}

}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
