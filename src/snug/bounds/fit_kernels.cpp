#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/fit_kernels.cpp"
#include <snug/geometry/vector_code-inl.h>
// After it.
#include <snug/bounds/lanes-inl.h>
#include <snug/bounds/planar_triangle-inl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include <snug/bounds/fit_kernels.h>
#include <snug/geometry/rounding.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

HWY_INLINE Vec3<hn::Vec<hn::CappedTag<double, 1>>> single(const Vector3& v) {
  const hn::CappedTag<double, 1> d1;
  return {hn::Set(d1, v.x), hn::Set(d1, v.y), hn::Set(d1, v.z)};
}

// Calls work(i) for vectors that cover [0, count); the last may overlap the one before. Needs count >= lanes.
template <class D, class Work>
HWY_INLINE void each_vector(D d, std::size_t count, const Work& work) {
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) work(i);
  if (i < count) work(count - lanes);
}

// Calls work(0), ..., work(count - 1) with constants: loops over arrays of vectors stay in registers only so.
template <std::size_t count, std::size_t i = 0, class Work>
HWY_INLINE void unrolled(const Work& work) {
  if constexpr (i < count) {
    work(std::integral_constant<std::size_t, i>());
    unrolled<count, i + 1>(work);
  }
}

// `blocks` vectors of rows from row r on: each point is loaded once for all of them, and their sums do not
// wait for each other.
template <std::size_t blocks, class D>
HWY_INLINE void apply_block(D d, const double* weights, std::size_t rows, std::span<const Vector3> points,
                            std::size_t r, double* x, double* y, double* z) {
  using V = hn::Vec<D>;
  const std::size_t lanes = hn::Lanes(d);
  V sum[3][blocks];
  unrolled<blocks>([&](auto b) HWY_ATTR { sum[0][b] = sum[1][b] = sum[2][b] = hn::Zero(d); });
  const double* weight = weights + r;
  for (const Vector3& p : points) {
    const V px = hn::Set(d, p.x), py = hn::Set(d, p.y), pz = hn::Set(d, p.z);
    unrolled<blocks>([&](auto b) HWY_ATTR {
      const V w = hn::LoadU(d, weight + b * lanes);
      sum[0][b] = hn::Add(sum[0][b], hn::Mul(w, px));
      sum[1][b] = hn::Add(sum[1][b], hn::Mul(w, py));
      sum[2][b] = hn::Add(sum[2][b], hn::Mul(w, pz));
    });
    weight += rows;
  }
  unrolled<blocks>([&](auto b) HWY_ATTR {
    hn::StoreU(sum[0][b], d, x + r + b * lanes);
    hn::StoreU(sum[1][b], d, y + r + b * lanes);
    hn::StoreU(sum[2][b], d, z + r + b * lanes);
  });
}

template <class D>
HWY_INLINE void apply_rows_with(D d, const double* weights, std::size_t rows, std::span<const Vector3> points,
                                double* x, double* y, double* z) {
  constexpr std::size_t blocks = 3;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t r = 0;
  for (; r + blocks * lanes <= rows; r += blocks * lanes) {
    apply_block<blocks>(d, weights, rows, points, r, x, y, z);
  }
  for (; r + lanes <= rows; r += lanes) apply_block<1>(d, weights, rows, points, r, x, y, z);
  if (r < rows) apply_block<1>(d, weights, rows, points, rows - lanes, x, y, z);
}

template <std::size_t blocks, class D>
HWY_INLINE void combine_block(D d, const RowSum& sum, std::size_t c, double* out) {
  using V = hn::Vec<D>;
  const std::size_t lanes = hn::Lanes(d);
  V total[blocks];
  unrolled<blocks>([&](auto b) HWY_ATTR { total[b] = hn::Zero(d); });
  for (std::size_t i = 0; i < sum.weights.size(); ++i) {
    const V w = hn::Set(d, sum.weights[i]);
    const double* const row = sum.entries + sum.places[sum.sources[i]] * sum.width + c;
    unrolled<blocks>(
        [&](auto b) HWY_ATTR { total[b] = hn::Add(total[b], hn::Mul(w, hn::LoadU(d, row + b * lanes))); });
  }
  unrolled<blocks>([&](auto b) HWY_ATTR { hn::StoreU(total[b], d, out + c + b * lanes); });
}

template <class D>
HWY_INLINE void combine_with(D d, const RowSum& sum, double* out) {
  constexpr std::size_t blocks = 3;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t c = 0;
  for (; c + blocks * lanes <= sum.width; c += blocks * lanes) combine_block<blocks>(d, sum, c, out);
  for (; c + lanes <= sum.width; c += lanes) combine_block<1>(d, sum, c, out);
  if (c < sum.width) combine_block<1>(d, sum, sum.width - lanes, out);
}

void CombineRows(const RowSum& sum, double* out) {
  const hn::ScalableTag<double> wide;
  if (sum.width >= hn::Lanes(wide)) {
    combine_with(wide, sum, out);
  } else {
    combine_with(hn::CappedTag<double, 1>(), sum, out);
  }
}

void ApplyRows(const double* weights, std::size_t rows, std::span<const Vector3> points, double* x, double* y,
               double* z) {
  const hn::ScalableTag<double> wide;
  if (rows >= hn::Lanes(wide)) {
    apply_rows_with(wide, weights, rows, points, x, y, z);
  } else {
    apply_rows_with(hn::CappedTag<double, 1>(), weights, rows, points, x, y, z);
  }
}

template <class D>
HWY_INLINE Range heights_with(D d, const Coordinates& points, const Vector3& from, const Vector3& normal) {
  using V = hn::Vec<D>;
  const Vec3<V> origin{hn::Set(d, from.x), hn::Set(d, from.y), hn::Set(d, from.z)};
  const Vec3<V> n{hn::Set(d, normal.x), hn::Set(d, normal.y), hn::Set(d, normal.z)};
  V lower = hn::Set(d, INFINITY), upper = hn::Set(d, -INFINITY);
  each_vector(d, points.count, [&](std::size_t i) HWY_ATTR {
    const Vec3<V> p{hn::LoadU(d, points.x + i), hn::LoadU(d, points.y + i), hn::LoadU(d, points.z + i)};
    const V height = dot(n, sub(p, origin));
    lower = hn::Min(height, lower);  // in this order a NaN is passed over
    upper = hn::Max(height, upper);
  });
  // Which of two zeros is the least depends on their order, and so on the number of lanes: -0 + 0 is 0.
  return {hn::GetLane(hn::MinOfLanes(d, lower)) + 0.0, hn::GetLane(hn::MaxOfLanes(d, upper)) + 0.0};
}

Range Heights(const Coordinates& points, const Vector3& from, const Vector3& normal) {
  const hn::ScalableTag<double> wide;
  if (points.count >= hn::Lanes(wide)) return heights_with(wide, points, from, normal);
  return heights_with(hn::CappedTag<double, 1>(), points, from, normal);
}

template <class D, class V1>
HWY_INLINE double farthest_sq_with(D d, const Coordinates& points, const PlanarTriangle<V1>& one) {
  using V = hn::Vec<D>;
  const auto all = [&](const V1& v) HWY_ATTR { return hn::Set(d, hn::GetLane(v)); };
  const auto all3 = [&](const Vec3<V1>& v) HWY_ATTR { return Vec3<V>{all(v.x), all(v.y), all(v.z)}; };
  const PlanarTriangle<V> t{
      all3(one.a),  all3(one.t1),     all3(one.t2),       all3(one.n),      all(one.l0),     all(one.l1),
      all(one.l2),  all(one.xc),      all(one.yc),        all(one.d1x),     all(one.d1y),    all(one.d2x),
      all(one.d2y), all(one.longest), all(one.deviation), all(one.amplify), all(one.stretch)};
  V farthest = hn::Zero(d);
  auto finite = hn::Le(farthest, farthest);
  each_vector(d, points.count, [&](std::size_t i) HWY_ATTR {
    const Vec3<V> p{hn::LoadU(d, points.x + i), hn::LoadU(d, points.y + i), hn::LoadU(d, points.z + i)};
    const V dist_sq = distance_sq(d, t, foot(d, t, p));
    finite = hn::And(finite, hn::Lt(dist_sq, hn::Set(d, INFINITY)));
    farthest = hn::Max(farthest, dist_sq);
  });
  return hn::AllTrue(d, finite) ? hn::GetLane(hn::MaxOfLanes(d, farthest)) : INFINITY;
}

bool Farthest(const Coordinates& points, const std::array<std::size_t, 3>& splits, const Vector3& a,
              const Vector3& b, const Vector3& c, std::array<Reach, 4>& out) {
  const hn::CappedTag<double, 1> d1;
  const auto t = planar_triangle(d1, single(a), single(b), single(c));
  if (!hn::AllTrue(d1, well_shaped(d1, t))) return false;
  const hn::ScalableTag<double> wide;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t end = i < 3 ? splits[i] : points.count;
    out[i] = {0, 0};
    if (begin == end) continue;
    const Coordinates part = points.first(end).from(begin);
    const double farthest_sq =
        part.count >= hn::Lanes(wide) ? farthest_sq_with(wide, part, t) : farthest_sq_with(d1, part, t);
    const auto reach = reach_of(d1, t, hn::Set(d1, farthest_sq), hn::Zero(d1));
    out[i] = {hn::GetLane(reach.distance), hn::GetLane(reach.rounding)};
    begin = end;
  }
  return true;
}

// ---- regular patches, one a lane ----

constexpr std::size_t bezier_count = 15;

// Bezier points of one coordinate from the twelve control points; 24 times these are the integer sums of
// patch/polynomial.cpp. A term meets at most six roundings (derivations/rounding.md, "Batches").
template <class D, class V = hn::Vec<D>>
HWY_INLINE void bezier_points(D d, const V* c, V* b) {
  const auto times = [&](double k, V v) HWY_ATTR { return hn::Mul(hn::Set(d, k), v); };
  const V part = hn::Set(d, 1.0 / 24);
  const V s01 = hn::Add(c[0], c[1]), s12 = hn::Add(c[1], c[2]), s20 = hn::Add(c[2], c[0]);
  const auto corner = [&](std::size_t v, V r0, V r1, V r2, V r3, V r4, V r5) HWY_ATTR {
    const V ring = hn::Add(hn::Add(hn::Add(r0, r1), hn::Add(r2, r3)), hn::Add(r4, r5));
    return hn::Mul(part, hn::Add(times(12, c[v]), hn::Add(ring, ring)));
  };
  // Next to corner v on the edge towards w: wings of the edge, then the ring's next ones.
  const auto beside = [&](std::size_t v, std::size_t w, V wings, V next) HWY_ATTR {
    const V sum = hn::Add(hn::Add(times(12, c[v]), times(4, c[w])), hn::Add(times(3, wings), next));
    return hn::Mul(part, sum);
  };
  const auto middle = [&](V ends, V wings)
                          HWY_ATTR { return hn::Mul(part, hn::Add(times(8, ends), times(4, wings))); };
  const auto inner = [&](std::size_t v, V others, V across) HWY_ATTR {
    return hn::Mul(part, hn::Add(times(10, c[v]), hn::Add(times(6, others), across)));
  };
  const V w01 = hn::Add(c[2], c[3]), w12 = hn::Add(c[0], c[4]), w20 = hn::Add(c[1], c[5]);
  b[0] = corner(0, c[1], c[2], c[3], c[5], c[6], c[7]);
  b[4] = corner(1, c[0], c[2], c[3], c[4], c[8], c[9]);
  b[14] = corner(2, c[0], c[1], c[4], c[5], c[10], c[11]);
  b[1] = beside(0, 1, w01, hn::Add(c[5], c[7]));
  b[2] = middle(s01, w01);
  b[3] = beside(1, 0, w01, hn::Add(c[4], c[8]));
  b[5] = beside(0, 2, w20, hn::Add(c[3], c[6]));
  b[9] = middle(s20, w20);
  b[12] = beside(2, 0, w20, hn::Add(c[4], c[11]));
  b[8] = beside(1, 2, w12, hn::Add(c[3], c[9]));
  b[11] = middle(s12, w12);
  b[13] = beside(2, 1, w12, hn::Add(c[5], c[10]));
  b[6] = inner(0, s12, hn::Add(c[3], c[5]));
  b[7] = inner(1, s20, hn::Add(c[3], c[4]));
  b[10] = inner(2, s01, hn::Add(c[4], c[5]));
}

// De Casteljau's scheme at 1/2, without its halvings: step i has the points at[i][0], ..., at[i][n - 1 - i],
// 2^i times as large.
template <class V, std::size_t n>
struct Pyramid {
  V at[n][n];
  // From the points take(0), take(1), ...
  template <class Take>
  HWY_INLINE explicit Pyramid(const Take& take) {
    unrolled<n>([&](auto k) HWY_ATTR { at[0][k] = take(k); });
    unrolled<n - 1>([&](auto i) HWY_ATTR {
      unrolled<n - 1 - i>([&](auto k) HWY_ATTR { at[i + 1][k] = hn::Add(at[i][k], at[i][k + 1]); });
    });
  }
};

template <std::size_t times, class D, class V = hn::Vec<D>>
HWY_INLINE V halved(D d, V v) {
  if constexpr (times == 0) return v;
  return hn::Mul(hn::Set(d, 1.0 / (1 << times)), v);
}

// Places of the Bezier points u^i v^j: j outermost, row j from here on.
constexpr std::array<std::size_t, 5> row_start{0, 5, 9, 12, 14};

// The 45 different Bezier points of the four quarters, as blossoms f(...) of the edges' midpoints and the
// corners: corner children f(mid^i, other mid^j, corner^(4-i-j)), then three inner ones of the middle child.
// First come, for edges 01, 12, 20 in turn, its first corner and the points inside it from there.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void split_once(D d, const V* b, V* out) {
  V left[5][5], right[5][5];  // f(m01^i, v0 or v1^(4-i-j), v2^j) at [i][j], 2^i times
  V once[4][4], twice[3][3];  // f(m01, ...) and f(m01, m01, ...) in full, at [j][k]: k of v1, j of v2
  V upper[5][5];              // f(m20^i, v1^j, v2^(4-i-j)) at [i][j]
  unrolled<5>([&](auto j) HWY_ATTR {
    const Pyramid<V, 5 - j> p([&](auto k) HWY_ATTR { return b[row_start[j] + k]; });
    unrolled<5 - j>([&](auto i) HWY_ATTR {
      left[i][j] = p.at[i][0];
      right[i][j] = p.at[i][4 - j - i];
    });
    if constexpr (j < 4) unrolled<4 - j>([&](auto k) HWY_ATTR { once[j][k] = p.at[1][k]; });
    if constexpr (j < 3) unrolled<3 - j>([&](auto k) HWY_ATTR { twice[j][k] = p.at[2][k]; });
  });
  unrolled<5>([&](auto k) HWY_ATTR {
    const Pyramid<V, 5 - k> p([&](auto j) HWY_ATTR { return b[row_start[j] + k]; });
    unrolled<5 - k>([&](auto i) HWY_ATTR { upper[i][k] = p.at[i][4 - k - i]; });
  });
  constexpr std::size_t of_edge = 8;
  V* inner = out + 3 * of_edge;
  unrolled<3>([&](auto child) HWY_ATTR {
    const auto& along = child == 0 ? left : child == 1 ? right : upper;
    // Places of points on the edges of the patch that i alone and j alone walk along.
    constexpr std::array<int, 3> begin_i{0, 8, 16}, step_i{1, -1, 1}, begin_j{24, 8, 16}, step_j{-1, 1, -1};
    unrolled<5>([&](auto i) HWY_ATTR {
      const Pyramid<V, 5 - i> p([&](auto k) HWY_ATTR { return along[i][k]; });
      unrolled<5 - i>([&](auto j) HWY_ATTR {
        const V point = halved<i + j>(d, p.at[j][0]);
        if constexpr (i == 0 && j == 0) {
          out[child * of_edge] = point;
        } else if constexpr ((child == 1 ? i : j) == 4) {
          // The midpoint of this edge is another child's.
        } else if constexpr (j == 0) {
          out[begin_i[child] + step_i[child] * int{i()}] = point;
        } else if constexpr (i == 0) {
          out[begin_j[child] + step_j[child] * int{j}] = point;
        } else {
          *inner++ = point;
        }
      });
    });
  });
  const auto blossom2 = [](V aa, V ab, V bb) HWY_ATTR { return hn::Add(hn::Add(aa, ab), hn::Add(ab, bb)); };
  const V crossed = hn::Add(hn::Add(twice[0][1], twice[1][0]), hn::Add(twice[1][1], twice[2][0]));
  const V at_two =
      hn::Add(blossom2(once[0][2], once[1][1], once[2][0]), blossom2(once[1][2], once[2][1], once[3][0]));
  const V at_zero =
      hn::Add(blossom2(once[0][1], once[1][1], once[2][1]), blossom2(once[1][0], once[2][0], once[3][0]));
  *inner++ = halved<4>(d, crossed);
  *inner++ = halved<4>(d, at_two);
  *inner++ = halved<4>(d, at_zero);
}

// Points of a patch in the frame of its corners, those of the triangle first: these are P's own.
template <class V, std::size_t count>
struct Framed {
  V x[count], y[count], h[count];
};

// The squared distance in the plane of each of seven points inside an edge of a quartic, split once, from
// distances aside and along of its points from the edge's start, is handed to meet(k, squared).
template <class D, class Meet, class V = hn::Vec<D>>
HWY_INLINE void each_of_edge(D d, V length, const V* aside, const V* along, const Meet& meet) {
  const V zero = hn::Zero(d);
  const Pyramid<V, 5> s([&](auto k) HWY_ATTR { return k == 0 || k == 4 ? zero : aside[k - 1]; });
  const Pyramid<V, 5> a([&](auto k) HWY_ATTR { return k == 0 ? zero : k == 4 ? length : along[k - 1]; });
  unrolled<7>([&](auto i) HWY_ATTR {
    constexpr std::size_t step = i < 4 ? i + 1 : 7 - i, place = i < 4 ? 0 : i - 3;
    const V side = halved<step>(d, s.at[step][place]), far = halved<step>(d, a.at[step][place]);
    meet(i + 1, hypotenuse_sq(hn::Max(zero, side), max3(zero, hn::Sub(far, length), hn::Sub(zero, far))));
  });
}

// A regular Loop patch inside the surface. First come, for edges 01, 12, 20 in turn, the first corner and the
// points inside the edge.
struct LoopShape {
  static constexpr std::size_t controls = 12, bezier = bezier_count, hull_count = 45, of_edge = 8;
  static constexpr std::array<std::size_t, 3> corners{0, 4, 14};
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE void points(D d, const V* c, V* b) {
    bezier_points(d, c, b);
  }
  template <class D, class V = hn::Vec<D>>
  static HWY_NOINLINE void hull(D d, const V* b, V* out) {
    split_once(d, b, out);
  }

  // Every bounding point but those of an edge is a sum of Bezier points with at most half of the weight on that
  // edge. So none is outside if all others lie as deep inside each edge's line as its own stick out: then
  // `farthest` meets those of the edges. The lanes of which that is true; derivations/rounding.md, "Batches".
  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE hn::Mask<D> measure_edges(D d, const PlanarTriangle<V>& t, const Framed<V, bezier>& b,
                                              const V* height, V middle, V& farthest) {
    const V zero = hn::Zero(d);
    constexpr std::size_t inside[12] = {1, 2, 3, 8, 11, 13, 5, 9, 12, 6, 7, 10};  // edge by edge
    V aside[3][12];
    unrolled<12>([&](auto i) HWY_ATTR {
      const Foot<V> f = foot_of(d, t, b.x[inside[i]], b.y[inside[i]], zero);
      aside[0][i] = f.s0, aside[1][i] = f.s1, aside[2][i] = f.s2;
    });
    auto within = hn::Eq(zero, zero);
    unrolled<3>([&](auto edge) HWY_ATTR {
      constexpr std::size_t opposite = corners[(edge + 2) % 3];
      const Foot<V> f = foot_of(d, t, b.x[opposite], b.y[opposite], zero);
      V own = zero, others = edge == 0 ? f.s0 : edge == 1 ? f.s1 : f.s2;
      unrolled<12>([&](auto i) HWY_ATTR {
        V& most = i / 3 == edge ? own : others;
        most = hn::Max(most, aside[edge][i]);
      });
      within = hn::And(within, hn::Le(hn::Add(own, others), zero));
    });
    V along[3][3];
    unrolled<3>([&](auto i) HWY_ATTR {
      const V x1 = hn::Sub(b.x[inside[3 + i]], t.l0), y1 = b.y[inside[3 + i]];
      const V x2 = b.x[inside[6 + i]], y2 = b.y[inside[6 + i]];
      along[0][i] = b.x[inside[i]];
      along[1][i] = hn::Add(hn::Mul(x1, t.d1x), hn::Mul(y1, t.d1y));
      along[2][i] = hn::Add(hn::Mul(x2, t.d2x), hn::Mul(y2, t.d2y));
    });
    unrolled<3>([&](auto edge) HWY_ATTR {
      const V length = edge == 0 ? t.l0 : edge == 1 ? t.l1 : t.l2;
      each_of_edge(d, length, aside[edge] + 3 * edge, along[edge], [&](std::size_t k, V in_plane) HWY_ATTR {
        const V h = hn::Sub(height[edge == 2 ? 24 - k : 8 * edge + k], middle);
        farthest = hn::Max(farthest, hn::Add(hn::Mul(h, h), in_plane));
      });
    });
    return within;
  }
};

// Half a bicubic quad: its 28 Bezier points as a triangle of degree 6, derivations/tensor_bezier.md.
struct BicubicShape {
  static constexpr std::size_t controls = 16, bezier = 16, hull_count = 28, of_edge = 6;
  static constexpr std::array<std::size_t, 3> corners{0, 3, 15};

  // Place of each control point in the lattice of 4 x 4, as patch/neighbourhood.h draws it.
  static constexpr std::array<std::size_t, 16> place{5, 6, 10, 9, 1, 2, 7, 11, 14, 13, 8, 4, 0, 3, 15, 12};

  // The bicubic Bezier points (i, j), at i + 4 j, that each bounding point is a sum of.
  struct Sums {
    std::size_t terms[hull_count] = {}, point[hull_count][8] = {};
    double weight[hull_count][8] = {};
  };
  static constexpr Sums make_sums() {
    constexpr int binomial[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
    constexpr int factorial[7] = {1, 1, 2, 6, 24, 120, 720};
    int sums[7][7][16] = {};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        for (int p = 0; p <= i; ++p) {
          for (int q = 0; q <= 3 - j; ++q) {
            sums[p + q][i - p + j][i + 4 * j] +=
                binomial[3][i] * binomial[3][j] * binomial[i][p] * binomial[3 - j][q];
          }
        }
      }
    }
    Sums result{};
    std::size_t inner = 3 * of_edge;
    for (int v = 0; v <= 6; ++v) {
      for (int u = 0; u + v <= 6; ++u) {
        const int w = 6 - u - v;
        const std::size_t at = v == 0 && u < 6   ? static_cast<std::size_t>(u)
                               : w == 0 && v < 6 ? of_edge + static_cast<std::size_t>(v)
                               : u == 0 && v > 0 ? 2 * of_edge + static_cast<std::size_t>(w)
                                                 : inner++;
        const double multinomial = factorial[6] / (factorial[u] * factorial[v] * factorial[w]);
        for (std::size_t b = 0; b < 16; ++b) {
          if (sums[u][v][b] == 0) continue;
          const std::size_t term = result.terms[at]++;
          result.point[at][term] = b;
          result.weight[at][term] = sums[u][v][b] / multinomial;
        }
      }
    }
    return result;
  }

  template <class V>
  static HWY_INLINE void segment(V four, V two, const V& a, const V& b, const V& c, const V& e, V* out,
                                 std::size_t stride) {
    out[0] = hn::Add(hn::Add(a, c), hn::Mul(four, b));
    out[stride] = hn::Add(hn::Mul(four, b), hn::Mul(two, c));
    out[2 * stride] = hn::Add(hn::Mul(two, b), hn::Mul(four, c));
    out[3 * stride] = hn::Add(hn::Add(b, e), hn::Mul(four, c));
  }

  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE void points(D d, const V* control, V* b) {
    const V four = hn::Set(d, 4.0), two = hn::Set(d, 2.0), part = hn::Set(d, 1.0 / 36);
    V c[16], along[16];
    for (std::size_t k = 0; k < 16; ++k) c[place[k]] = control[k];
    for (std::size_t y = 0; y < 16; y += 4)
      segment(four, two, c[y], c[y + 1], c[y + 2], c[y + 3], along + y, 1);
    for (std::size_t x = 0; x < 4; ++x) {
      segment(four, two, along[x], along[4 + x], along[8 + x], along[12 + x], b + x, 4);
    }
    for (std::size_t k = 0; k < 16; ++k) b[k] = hn::Mul(part, b[k]);
  }

  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE void hull(D d, const V* b, V* out) {
    static constexpr Sums sums = make_sums();
#ifndef SNUG_SANITIZED  // whose checks take minutes to compile then
#pragma GCC unroll 28
#endif
    for (std::size_t p = 0; p < hull_count; ++p) {
      V sum = hn::Zero(d);
#ifndef SNUG_SANITIZED
#pragma GCC unroll 8
#endif
      for (std::size_t t = 0; t < sums.terms[p]; ++t) {
        sum = hn::Add(sum, hn::Mul(hn::Set(d, sums.weight[p][t]), b[sums.point[p][t]]));
      }
      out[p] = sum;
    }
  }

  template <class D, class V = hn::Vec<D>>
  static HWY_INLINE hn::Mask<D> measure_edges(D d, const PlanarTriangle<V>&, const Framed<V, bezier>&,
                                              const V*, V, V&) {
    return hn::Lt(hn::Zero(d), hn::Zero(d));
  }
};

// Every point by itself.
template <class Shape, class D, class V = hn::Vec<D>>
HWY_INLINE V measure_all(D d, const PlanarTriangle<V>& t, const Framed<V, Shape::bezier>& b, const V* height,
                         V middle, V farthest) {
  V x[Shape::hull_count], y[Shape::hull_count];
  Shape::hull(d, b.x, x);
  Shape::hull(d, b.y, y);
  const auto at = [&](std::size_t i)
                      HWY_ATTR { return foot_of(d, t, x[i], y[i], hn::Sub(height[i], middle)); };
  const auto meet = [&](V dist_sq) HWY_ATTR { farthest = hn::Max(farthest, dist_sq); };
  constexpr std::size_t of_edge = Shape::of_edge;
  for (std::size_t i = 1; i < of_edge; ++i) {
    meet(distance_sq_by_edge<0>(d, t, at(i)));
    meet(distance_sq_by_edge<1>(d, t, at(of_edge + i)));
    meet(distance_sq_by_edge<2>(d, t, at(2 * of_edge + i)));
  }
  for (std::size_t i = 3 * of_edge; i < Shape::hull_count; ++i) meet(distance_sq(d, t, at(i)));
  return farthest;
}

// Bezier points in the frame; `probe` is finite only where they are.
template <class Shape, class D, class V = hn::Vec<D>>
HWY_INLINE Framed<V, Shape::bezier> framed_points(D d, const PlanarTriangle<V>& t,
                                                  const V (&bezier)[3][Shape::bezier], V& probe) {
  Framed<V, Shape::bezier> framed;
  probe = hn::Zero(d);
  for (std::size_t i = 0; i < Shape::bezier; ++i) {
    const Vec3<V> r = sub(Vec3<V>{bezier[0][i], bezier[1][i], bezier[2][i]}, t.a);
    framed.x[i] = dot(t.t1, r);
    framed.y[i] = dot(t.t2, r);
    framed.h[i] = dot(t.n, r);
    probe = hn::Add(probe, framed.h[i]);
  }
  const V zero = hn::Zero(d), corner_x[3] = {zero, t.l0, t.xc}, corner_y[3] = {zero, zero, t.yc};
  for (std::size_t k = 0; k < 3; ++k) {
    framed.x[Shape::corners[k]] = corner_x[k];
    framed.y[Shape::corners[k]] = corner_y[k];
    framed.h[Shape::corners[k]] = zero;
  }
  return framed;
}

// The middle of the heights of the bounding points, and their largest squared distance from P moved there.
template <class V>
struct Measured {
  V middle, farthest_sq;
};

template <class Shape, class D, class V = hn::Vec<D>>
HWY_INLINE Measured<V> measure(D d, const PlanarTriangle<V>& t, const Framed<V, Shape::bezier>& framed) {
  const V zero = hn::Zero(d);
  V height[Shape::hull_count];
  Shape::hull(d, framed.h, height);
  // Several chains of extremes: one would wait for itself.
  V lows[4] = {zero, zero, zero, zero}, highs[4] = {zero, zero, zero, zero};
  unrolled<Shape::hull_count>([&](auto i) HWY_ATTR {
    lows[i % 4] = hn::Min(lows[i % 4], height[i]);
    highs[i % 4] = hn::Max(highs[i % 4], height[i]);
  });
  const V lower = hn::Min(hn::Min(lows[0], lows[1]), hn::Min(lows[2], lows[3]));
  const V upper = hn::Max(hn::Max(highs[0], highs[1]), hn::Max(highs[2], highs[3]));
  // No -0, as in heights_with().
  const V middle = hn::Mul(hn::Set(d, 0.5), hn::Add(hn::Add(lower, upper), zero));
  const V highest = hn::Max(hn::Sub(upper, middle), hn::Sub(middle, lower));
  const V by_height = hn::Mul(highest, highest);
  V farthest = by_height;
  const auto measured = Shape::measure_edges(d, t, framed, height, middle, farthest);
  if (!hn::AllTrue(d, measured)) {
    farthest =
        hn::IfThenElse(measured, farthest, measure_all<Shape>(d, t, framed, height, middle, by_height));
  }
  return {middle, farthest};
}

template <class Shape, class D, class V = hn::Vec<D>>
HWY_INLINE void fit_group(D d, const double* HWY_RESTRICT gathered, std::span<OffsetTriangle> out) {
  const std::size_t lanes = hn::Lanes(d);
  V bezier[3][Shape::bezier], origin[3], largest = hn::Zero(d), probe;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    V c[Shape::controls];
    const double* from = gathered + axis * lanes;
    origin[axis] = hn::Load(d, from);
    c[0] = hn::Zero(d);
    for (std::size_t k = 1; k < Shape::controls; ++k) {
      c[k] = hn::Sub(hn::Load(d, from + 3 * k * lanes), origin[axis]);
      largest = hn::Max(largest, hn::Abs(c[k]));
    }
    Shape::points(d, c, bezier[axis]);
  }
  Vec3<V> corner[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t at = Shape::corners[k];
    corner[k] = {bezier[0][at], bezier[1][at], bezier[2][at]};
  }
  const PlanarTriangle<V> t = planar_triangle(d, corner[0], corner[1], corner[2]);
  const Framed<V, Shape::bezier> framed = framed_points<Shape>(d, t, bezier, probe);
  const auto [middle, farthest] = measure<Shape>(d, t, framed);
  const V infinite = hn::Set(d, INFINITY);
  const auto finite = hn::And(hn::Lt(hn::Abs(probe), infinite), hn::Lt(farthest, infinite));

  // The corners count as P's, the frame's defect tilts the shift, and what is counted inside is so up to the
  // rounding of Bezier points: derivations/rounding.md, "Batches".
  const V tilt = hn::Mul(t.stretch, hn::Abs(middle));
  const V inside = hn::Mul(hn::Mul(hn::Set(d, 48 * unit_roundoff), t.amplify), largest);
  const ReachV<V> reach = reach_of(d, t, farthest, hn::Add(t.deviation, hn::Add(tilt, inside)));

  // Errors of control points, bounding points and the placed base, a coordinate.
  const Vec3<V> shift = scaled(middle, t.n);
  V placed = hn::Zero(d);
  for (auto& c : corner) {
    c = add(Vec3<V>{origin[0], origin[1], origin[2]}, add(c, shift));
    placed = hn::Max(placed, max3(hn::Abs(c.x), hn::Abs(c.y), hn::Abs(c.z)));
  }
  constexpr double hull_error = unit_roundoff + gamma_bound(72);
  const V error = hn::Add(hn::Add(hn::Mul(hn::Set(d, hull_error * (1 + 0x1p-42)), largest),
                                  hn::Mul(hn::Set(d, unit_roundoff * (1 + 0x1p-42)), placed)),
                          hn::Set(d, 64 * underflow_error));
  const V given = hn::Mul(hn::Set(d, spatial_error(1)), error);
  const V rounding = hn::Add(reach.rounding, given), radius = hn::Add(reach.distance, given);
  const V widened = hn::Add(hn::Mul(radius, hn::Set(d, 1 + 0x1p-42)), hn::Set(d, underflow_error));
  const auto good = hn::And(hn::And(well_shaped(d, t), finite), hn::Lt(widened, infinite));
  hand_out(d, corner, hn::IfThenElse(good, widened, hn::Set(d, -1.0)), rounding, out);
}

template <class Shape>
SNUG_FLAT void FitAll(std::span<const Point3> points, std::span<const VertexId> control,
                      std::span<OffsetTriangle> out) {
  constexpr std::size_t controls = Shape::controls;
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN double gathered[3 * controls * HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t begin = 0; begin < out.size(); begin += lanes) {
    const std::size_t here = std::min(lanes, out.size() - begin);
    gather_lanes(points, control.data() + controls * begin, controls, 0, controls, here, lanes, gathered);
    fit_group<Shape>(d, gathered, out.subspan(begin, here));
  }
}

void FitRegular(std::span<const Point3> points, std::span<const VertexId> control,
                std::span<OffsetTriangle> out) {
  FitAll<LoopShape>(points, control, out);
}

void FitBicubic(std::span<const Point3> points, std::span<const VertexId> control,
                std::span<OffsetTriangle> out) {
  FitAll<BicubicShape>(points, control, out);
}

const char* InstructionSet() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(ApplyRows);
HWY_EXPORT(CombineRows);
HWY_EXPORT(Heights);
HWY_EXPORT(Farthest);
HWY_EXPORT(FitRegular);
HWY_EXPORT(FitBicubic);
HWY_EXPORT(InstructionSet);

const char* instruction_set() { return HWY_DYNAMIC_DISPATCH(InstructionSet)(); }

void apply_rows(const double* weights, std::size_t rows, std::span<const Vector3> points, double* x,
                double* y, double* z) {
  HWY_DYNAMIC_DISPATCH(ApplyRows)(weights, rows, points, x, y, z);
}

void combine_rows(const RowSum& sum, double* out) { HWY_DYNAMIC_DISPATCH(CombineRows)(sum, out); }

Range heights(const Coordinates& points, const Vector3& from, const Vector3& normal) {
  return HWY_DYNAMIC_DISPATCH(Heights)(points, from, normal);
}

std::optional<std::array<Reach, 4>> farthest(const Coordinates& points,
                                             const std::array<std::size_t, 3>& splits, const Vector3& a,
                                             const Vector3& b, const Vector3& c) {
  std::array<Reach, 4> reach;
  if (!HWY_DYNAMIC_DISPATCH(Farthest)(points, splits, a, b, c, reach)) return std::nullopt;
  return reach;
}

void fit_regular(std::span<const Point3> points, std::span<const VertexId> control,
                 std::span<OffsetTriangle> out) {
  HWY_DYNAMIC_DISPATCH(FitRegular)(points, control, out);
}

void fit_bicubic(std::span<const Point3> points, std::span<const VertexId> control,
                 std::span<OffsetTriangle> out) {
  HWY_DYNAMIC_DISPATCH(FitBicubic)(points, control, out);
}

}  // namespace snug::kernels
#endif
