// The basis functions of basis.h, written inside of a namespace: of doubles by basis.h, and for each instruction set by
// vector code. No #pragma once. T is double, or a vector with a parameter a lane.

/// Values of the basis functions at a parameter, and if asked for their derivatives along u and v.
template <class T>
struct BasisFunctionsOf {
  std::array<T, max_basis_count> value, along_u, along_v;
};
using BasisFunctions = BasisFunctionsOf<double>;

/// Uniform B-splines over [0, 1] and their derivatives: the factors of a tensor basis.
template <std::size_t degree, class T = double>
struct Splines {
  std::array<T, degree + 1> value, slope;
};
template <std::size_t degree, class T>
[[nodiscard]] Splines<degree, T> splines(T x) {
  const T t = 1 - x;
  if constexpr (degree == 1) {
    return {{t, x}, {-1, 1}};
  } else if constexpr (degree == 2) {
    return {{0.5 * (t * t), 0.5 + t * x, 0.5 * (x * x)}, {-t, t - x, x}};
  } else {
    const T xx = x * x, tt = t * t;
    return {{tt * t * (1.0 / 6), 2.0 / 3 - 0.5 * (xx * (2 - x)), 2.0 / 3 - 0.5 * (tt * (2 - t)),
             xx * x * (1.0 / 6)},
            {-0.5 * tt, x * (1.5 * x - 2), t * (2 - 1.5 * t), 0.5 * xx}};
  }
}

namespace detail {

// One function of barycentric coordinates a, b, c and its partial derivatives.
template <class T>
struct BoxSplineValue {
  T value, by_a, by_b, by_c;
};

// Of the box spline: of the point across the edge ab, with s = a + b and m = a b.
template <bool derivatives, class T>
BoxSplineValue<T> across_edge(T a, T b, T c) {
  constexpr double twelfth = 1.0 / 12;
  const T s = a + b, m = a * b, ss = s * s;
  BoxSplineValue<T> f{(ss * (ss + 2 * (c * s)) + 2 * (m * (ss + m))) * twelfth, 0, 0, 0};
  if constexpr (derivatives) {
    const T both = 4 * s + 6 * c;
    f.by_a = (ss * (both + 2 * b) + 4 * (m * (s + b))) * twelfth;
    f.by_b = (ss * (both + 2 * a) + 4 * (m * (s + a))) * twelfth;
    f.by_c = ss * s * (1.0 / 6);
  }
  return f;
}

// Of the corner a, with t = b + c and m = b c.
template <bool derivatives, class T>
BoxSplineValue<T> at_corner(T a, T b, T c) {
  constexpr double twelfth = 1.0 / 12;
  const T t = b + c, m = b * c, tt = t * t, ttt = tt * t;
  const T inner = (6 * a + 6 * t) * a + (tt + m);
  BoxSplineValue<T> f{
      (((((6 * a + 24 * t) * a + 24 * tt) * a + 8 * ttt) * a + tt * tt) + 2 * (m * inner)) * twelfth, 0, 0,
      0};
  if constexpr (derivatives) {
    f.by_a = ((((24 * a + 72 * t) * a + 48 * tt) * a + 8 * ttt) + 2 * (m * (12 * a + 6 * t))) * twelfth;
    const T both = (((24 * a + 48 * t) * a + 24 * tt) * a + 4 * ttt), along = 6 * a + 2 * t;
    f.by_b = (both + 2 * (c * inner + m * (along + c))) * twelfth;
    f.by_c = (both + 2 * (b * inner + m * (along + b))) * twelfth;
  }
  return f;
}

// Of a point beyond the corner a, beside the continuation of the edge from b.
template <bool derivatives, class T>
BoxSplineValue<T> beyond_corner(T a, T b) {
  constexpr double twelfth = 1.0 / 12;
  const T aa = a * a;
  BoxSplineValue<T> f{aa * a * (a + 2 * b) * twelfth, 0, 0, 0};
  if constexpr (derivatives) {
    f.by_a = aa * (4 * a + 6 * b) * twelfth;
    f.by_b = aa * a * (1.0 / 6);
  }
  return f;
}

// Source:    derivations/loop_bezier.md, "Basis functions".
template <bool derivatives, class T>
void box_spline_basis(T w, T u, T v, BasisFunctionsOf<T>& out) {
  const auto set = [&](std::size_t place, T value, T by_w, T by_u, T by_v) {
    out.value[place] = value;
    if constexpr (derivatives) {
      out.along_u[place] = by_u - by_w;
      out.along_v[place] = by_v - by_w;
    }
  };
  BoxSplineValue<T> f = at_corner<derivatives>(w, u, v);
  set(0, f.value, f.by_a, f.by_b, f.by_c);
  f = at_corner<derivatives>(u, v, w);
  set(1, f.value, f.by_c, f.by_a, f.by_b);
  f = at_corner<derivatives>(v, w, u);
  set(2, f.value, f.by_b, f.by_c, f.by_a);
  f = across_edge<derivatives>(w, u, v);
  set(3, f.value, f.by_a, f.by_b, f.by_c);
  f = across_edge<derivatives>(u, v, w);
  set(4, f.value, f.by_c, f.by_a, f.by_b);
  f = across_edge<derivatives>(v, w, u);
  set(5, f.value, f.by_b, f.by_c, f.by_a);
  f = beyond_corner<derivatives>(w, v);
  set(6, f.value, f.by_a, 0, f.by_b);
  f = beyond_corner<derivatives>(w, u);
  set(7, f.value, f.by_a, f.by_b, 0);
  f = beyond_corner<derivatives>(u, w);
  set(8, f.value, f.by_b, f.by_a, 0);
  f = beyond_corner<derivatives>(u, v);
  set(9, f.value, 0, f.by_a, f.by_b);
  f = beyond_corner<derivatives>(v, u);
  set(10, f.value, 0, f.by_b, f.by_a);
  f = beyond_corner<derivatives>(v, w);
  set(11, f.value, f.by_b, 0, f.by_a);
}

// The quad's triangle k of edge k and the middle holds the parameter: a, b belong to the corners k and k + 1,
// c to the middle.
// Source:    derivations/midedge_bezier.md, "Basis functions".
template <bool derivatives>
void zwart_powell_basis(double u, double v, BasisFunctions& out) {
  const double left = 1 - u - v, right = u - v;
  const std::size_t k = right >= 0 ? (left >= 0 ? 0 : 1) : (left >= 0 ? 3 : 2);
  const std::array<double, 4> sides{left, right, -left, -right}, heights{v, 1 - u, 1 - v, u};
  const double a = sides[k], b = sides[(k + 1) % 4], c = 2 * heights[k];
  const auto set = [&](std::size_t place, double value, double by_a, double by_b, double by_c) {
    out.value[place] = value;
    if constexpr (derivatives) {
      // Edge 0 runs along u, and c grows along v; by quarter turns the others.
      const double along = by_b - by_a, up = 2 * by_c - (by_a + by_b);
      out.along_u[place] = k == 0 ? along : k == 1 ? -up : k == 2 ? -along : up;
      out.along_v[place] = k == 0 ? up : k == 1 ? along : k == 2 ? -up : -along;
    }
  };
  const double aa = 0.25 * (a * a), ab = a * b, bb = 0.25 * (b * b), ac = a * c, bc = b * c, cc = c * c;
  const auto spoke = [&](std::size_t i) { return 1 + (k + i) % 4; };
  const auto far = [&](std::size_t i) { return 5 + (k + i) % 4; };
  set(0, aa + ab + bb + (ac + bc) + 0.5 * cc, 0.5 * a + b + c, a + 0.5 * b + c, a + b + c);
  set(spoke(0), aa + 0.5 * ac + 0.125 * cc, 0.5 * (a + c), 0, 0.5 * a + 0.25 * c);
  set(spoke(1), aa + ab + bb + 0.5 * (ac + bc) + 0.125 * cc, 0.5 * (a + c) + b, a + 0.5 * (b + c),
      0.5 * (a + b) + 0.25 * c);
  set(spoke(2), bb + 0.5 * bc + 0.125 * cc, 0, 0.5 * (b + c), 0.5 * b + 0.25 * c);
  set(spoke(3), 0.125 * cc, 0, 0, 0.25 * c);
  set(far(0), aa, 0.5 * a, 0, 0);
  set(far(1), bb, 0, 0.5 * b, 0);
  set(far(2), 0, 0, 0, 0);
  set(far(3), 0, 0, 0, 0);
}

}  // namespace detail

/// Requires:  !is_tensor(basis); of a triangle w = 1 - u - v; T = double for zwart_powell.
template <RegularBasis basis, bool derivatives, class T>
void basis_functions(T w, T u, T v, BasisFunctionsOf<T>& out) {
  if constexpr (basis == RegularBasis::linear) {
    out.value[0] = w;
    out.value[1] = u;
    out.value[2] = v;
    if constexpr (derivatives) {
      out.along_u = {-1, 1, 0};
      out.along_v = {-1, 0, 1};
    }
  } else if constexpr (basis == RegularBasis::box_spline) {
    detail::box_spline_basis<derivatives>(w, u, v, out);
  } else {
    detail::zwart_powell_basis<derivatives>(u, v, out);
  }
}
