#include <snug/spline/hermite_face.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

// How far an inner Bezier point at an extraordinary corner is moved, in lengths of the shorter side there.
constexpr double most_inner_move = 0.25;
// Least share of the chord that the Bezier point next to an extraordinary end is away from it.
constexpr double least_side = 0.1;
// Finer knots are not made: 2^-20 of an edge.
constexpr double least_span = 0x1p-20;
// Shares of an interval at which a curve is compared.
constexpr std::array<double, 7> samples{0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875};

std::array<double, 4> bernstein(double t) {
  const double s = 1 - t;
  return {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
}

void sort_unique(std::vector<double>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

// Derivatives at extraordinary ends, such that the cubic next to them passes through limit points; then into the tangent plane.
void fit_ends(HermiteCurve& curve, TriangleTree& tree, const std::array<bool, 2>& known) {
  const std::size_t n = curve.nodes.size();
  // From the Bezier point next to an end; `next`: the other end of the cubic.
  const auto put = [&](std::size_t end, HermiteCurve::Node& here, const HermiteCurve::Node& next,
                       Vector3 bezier) {
    Vector3 side = bezier - here.point, chord = next.point - here.point;
    if (const auto normal = tree.normal(end)) {
      side = side - dot(*normal, side) * *normal;
      chord = chord - dot(*normal, chord) * *normal;
    }
    // At a vertex of valence 3 the parameters' derivative vanishes; the curve's is not to.
    const double size = length_sq(chord), along = dot(side, chord);
    if (along < least_side * size) side = side + (least_side - along / size) * chord;
    here.along = (3 / (next.t - here.t)) * side;
  };
  if (n == 2 && !known[0] && !known[1]) {
    HermiteCurve::Node &a = curve.nodes[0], &b = curve.nodes[1];
    const Vector3 p = 27.0 * tree.limit(0.333251953125, 0) - 8.0 * a.point - b.point,
                  q = 27.0 * tree.limit(0.666748046875, 0) - a.point - 8.0 * b.point;
    put(0, a, b, (1.0 / 18) * (2.0 * p - q));
    put(1, b, a, (1.0 / 18) * (2.0 * q - p));
    return;
  }
  for (std::size_t end = 0; end < 2; ++end) {
    if (known[end]) continue;
    HermiteCurve::Node &here = curve.nodes[end == 0 ? 0 : n - 1], &next = curve.nodes[end == 0 ? 1 : n - 2];
    // The other end's derivative as a Bezier point; the length is negative at the second end.
    const Vector3 handle = next.point - ((next.t - here.t) / 3) * next.along;
    put(end, here, next,
        (1.0 / 3) * (8.0 * tree.limit(0.5 * (here.t + next.t), 0) - here.point - next.point) - handle);
  }
}

bool is_near(const HermiteCurve& curve, TriangleTree& tree, double begin, double end, double error) {
  return std::none_of(samples.begin(), samples.end(), [&](double share) {
    const double t = begin + share * (end - begin);
    return length_sq(curve.at(t).point - tree.limit(t, 0)) > error * error;
  });
}

// Leaves out nodes without which the curve is as near: halving towards an end makes spans that are shorter than need be. Those next to an
// extraordinary end stay.
void drop_nodes(HermiteCurve& curve, TriangleTree& tree, double error) {
  const std::size_t first = tree.jet(0, 0) ? 1 : 2, last = tree.jet(1, 0) ? 1 : 2;
  for (std::size_t k = first; k + last < curve.nodes.size();) {
    const HermiteCurve both{curve.origin, {curve.nodes[k - 1], curve.nodes[k + 1]}};
    if (is_near(both, tree, both.nodes[0].t, both.nodes[1].t, error)) {
      curve.nodes.erase(curve.nodes.begin() + static_cast<std::ptrdiff_t>(k));
    } else {
      ++k;
    }
  }
}

}  // namespace

HermiteCurve::Node HermiteCurve::at(double t) const {
  const auto after = std::lower_bound(nodes.begin(), nodes.end(), t,
                                      [](const Node& node, double at) { return node.t < at; });
  if (after->t == t) return *after;
  const Node &a = *(after - 1), &b = *after;
  const double length = b.t - a.t, s = (t - a.t) / length;
  const std::array<Vector3, 4> p{a.point, a.point + (length / 3) * a.along, b.point - (length / 3) * b.along,
                                 b.point};
  const auto w = bernstein(s);
  const double r = 1 - s;
  return {t, w[0] * p[0] + w[1] * p[1] + w[2] * p[2] + w[3] * p[3],
          (3 / length) * (r * r * (p[1] - p[0]) + 2 * r * s * (p[2] - p[1]) + s * s * (p[3] - p[2]))};
}

HermiteCurve HermiteCurve::reversed() const {
  HermiteCurve result{origin, {nodes.rbegin(), nodes.rend()}};
  for (Node& node : result.nodes) node = {1 - node.t, node.point, -1.0 * node.along};
  return result;
}

HermiteCurve curve_with(TriangleTree& tree, const std::vector<double>& knots) {
  HermiteCurve curve{tree.origin(), {}};
  std::array<bool, 2> known{true, true};
  for (const double t : knots) {
    if (const auto jet = tree.jet(t, 0)) {
      curve.nodes.push_back({t, jet->point, jet->along_u});
    } else {
      known[t == 0 ? 0 : 1] = false;
      curve.nodes.push_back({t, tree.limit(t, 0), {}});
    }
  }
  fit_ends(curve, tree, known);
  return curve;
}

HermiteCurve curve_near(TriangleTree& tree, double error) {
  std::vector<double> knots{0, 1};
  for (;;) {
    HermiteCurve curve = curve_with(tree, knots);
    std::vector<double> more = knots;
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
      const double begin = knots[k], length = knots[k + 1] - begin;
      if (length > least_span && !is_near(curve, tree, begin, knots[k + 1], error))
        more.push_back(begin + 0.5 * length);
    }
    if (more.size() == knots.size()) {
      drop_nodes(curve, tree, error);
      return curve;
    }
    sort_unique(more);
    knots = std::move(more);
  }
}

HermiteFace::HermiteFace(std::size_t width, std::size_t height, std::vector<FaceSquare> squares,
                         const std::vector<HermiteCurve>& border)
    : width_(width), height_(height), squares_(std::move(squares)), origin_(squares_.front().lower.origin()) {
  const std::array<std::size_t, 4> counts{width, height, width, triangle() ? 0 : height};
  auto next = border.begin();
  for (std::size_t side = 0; side < 4; ++side) {
    for (std::size_t k = 0; k < counts[side]; ++k)
      border_[side].push_back(side < 2 ? *next++ : (next++)->reversed());
    if (side >= 2) std::reverse(border_[side].begin(), border_[side].end());
    std::vector<double>& knots = side % 2 == 0 ? u_ : v_;
    for (std::size_t k = 0; k < border_[side].size(); ++k) {
      for (const auto& node : border_[side][k].nodes) knots.push_back(static_cast<double>(k) + node.t);
    }
  }
  SNUG_EXPECT(next == border.end());
  if (triangle()) {
    u_.insert(u_.end(), v_.begin(), v_.end());
    v_ = u_;
  }
  sort_unique(u_);
  sort_unique(v_);
}

TriangleTree& HermiteFace::tree_at(double& u, double& v) {
  const auto x = std::min(static_cast<std::size_t>(u), width_ - 1),
             y = std::min(static_cast<std::size_t>(v), height_ - 1);
  u -= static_cast<double>(x);
  v -= static_cast<double>(y);
  FaceSquare& square = squares_[x + width_ * y];
  return v <= u ? square.lower : *square.upper;
}

Vector3 HermiteFace::limit(double u, double v) {
  TriangleTree& tree = tree_at(u, v);
  return tree.limit(u, v) + (tree.origin() - origin_);
}

HermiteCurve::Node HermiteFace::border_at(std::size_t side, double t) const {
  const std::vector<HermiteCurve>& curves = border_[side];
  const auto k = std::min(static_cast<std::size_t>(t), curves.size() - 1);
  HermiteCurve::Node node = curves[k].at(t - static_cast<double>(k));
  node.point = node.point + (curves[k].origin - origin_);
  return node;
}

const HermiteFace::Jet& HermiteFace::jet_at(double u, double v) {
  const auto found = jets_.find({u, v});
  if (found != jets_.end()) return found->second;
  return jets_.emplace(std::pair(u, v), made_jet(u, v)).first->second;
}

HermiteFace::Jet HermiteFace::made_jet(double u, double v) {
  double x = u, y = v;
  TriangleTree& tree = tree_at(x, y);
  Jet jet{};
  if (const auto here = tree.jet(x, y)) {
    jet = {*here, true};
    jet.jet.point = jet.jet.point + (tree.origin() - origin_);
  }
  put_on_border(u, v, jet);
  return jet;
}

void HermiteFace::put_on_border(double u, double v, Jet& jet) const {
  CornerJet& j = jet.jet;
  const auto take = [&](std::size_t side, double t, Vector3& along) {
    const HermiteCurve::Node node = border_at(side, t);
    j.point = node.point;
    along = node.along;
  };
  if (v == 0) take(0, u, j.along_u);
  if (u == static_cast<double>(width_)) take(1, v, j.along_v);
  if (!triangle()) {
    if (v == static_cast<double>(height_)) take(2, u, j.along_u);
    if (u == 0) take(3, v, j.along_v);
  } else if (u == v) {
    Vector3 along;
    take(2, u, along);
    (u == 1 ? j.along_u : j.along_v) = along - (u == 1 ? j.along_v : j.along_u);
  }
}

// Bezier points of a diagonal cell beyond the diagonal, such that this is the border.
void HermiteFace::take_diagonal(double begin, double end, TensorPiece& b) const {
  const HermiteCurve::Node p = border_at(2, begin), q = border_at(2, end);
  const double third = (end - begin) / 3;
  const Vector3 p1 = p.point + third * p.along, q1 = q.point - third * q.along;
  // Of degree 6.
  const Vector3 c2 = 0.2 * (p.point + 3.0 * p1 + q1), c3 = 0.05 * (p.point + 9.0 * p1 + 9.0 * q1 + q.point),
                c4 = 0.2 * (p1 + 3.0 * q1 + q.point);
  b.at(0, 2) = 5.0 * c2 - b.at(2, 0) - 3.0 * b.at(1, 1);
  b.at(1, 3) = 5.0 * c4 - b.at(3, 1) - 3.0 * b.at(2, 2);
  b.at(0, 3) = p.point + (q.point - b.at(3, 0));
  b.at(1, 2) = (1.0 / 9) * (20.0 * c3 - b.at(3, 0) - b.at(0, 3)) - b.at(2, 1);
}

// Beyond the diagonal: next to a cell on it what that has, else as if the face were turned about the middle of the diagonal.
HermiteFace::Jet HermiteFace::jet_outside(std::size_t i, std::size_t j) {
  if (j == i + 1) {
    const TensorPiece b = bezier_of(i, i);
    const double s = 3 / (u_[j] - u_[i]);
    const Vector3 p = b.at(0, 3);
    return {{p, s * (b.at(1, 3) - p), s * (p - b.at(0, 2)),
             (s * s) * (b.at(1, 3) - b.at(1, 2) - (p - b.at(0, 2)))},
            true};
  }
  const CornerJet a = jet_at(u_[i], v_[i]).jet, c = jet_at(u_[j], v_[j]).jet,
                  across = jet_at(u_[j], v_[i]).jet;
  return {{a.point + (c.point - across.point), a.along_u + a.along_v - across.along_v,
           c.along_u + c.along_v - across.along_u, -1.0 * across.twist},
          true};
}

// The inner Bezier point at an extraordinary corner, if there is one: such that the surface is met in the middle, or in the
// middle of a half.
void HermiteFace::fit_inside(std::size_t i, std::size_t j, const std::array<bool, 4>& known, TensorPiece& b) {
  if (std::count(known.begin(), known.end(), false) != 1) return;
  const auto corner = static_cast<std::size_t>(std::find(known.begin(), known.end(), false) - known.begin());
  const bool half = place(i, j) == Place::half;
  const double x = !half ? 0.5 : corner == 0 ? 0.625 : 0.75, y = !half ? 0.5 : corner == 2 ? 0.375 : 0.25;
  const auto p = bernstein(x), q = bernstein(y);
  Vector3* point = nullptr;
  double share = 0;
  if (corner == 0) point = &b.at(1, 1), share = p[1] * q[1] - (half ? 3 * p[0] * q[2] : 0);
  if (corner == 1) point = &b.at(2, 1), share = p[2] * q[1] - (half ? p[1] * q[2] : 0);
  if (corner == 2) point = &b.at(2, 2), share = p[2] * q[2] - (half ? 3 * p[1] * q[3] : 0);
  if (corner == 3) point = &b.at(1, 2), share = p[1] * q[2];
  const double u = u_[i] + x * (u_[i + 1] - u_[i]), v = v_[j] + y * (v_[j + 1] - v_[j]);
  // Not so far that the face might fold there.
  const std::size_t cx = corner == 0 || corner == 3 ? 0 : 3, cy = corner < 2 ? 0 : 3;
  const Vector3 at = b.at(cx, cy), along = b.at(cx == 0 ? 1 : 2, cy) - at,
                across = b.at(cx, cy == 0 ? 1 : 2) - at;
  const Vector3 move = (1 / share) * (limit(u, v) - value(b, x, y));
  const double most = most_inner_move * std::min(length(along), length(across)), far = length(move);
  *point = *point + (far > most ? most / far : 1.0) * move;
}

TensorPiece HermiteFace::bezier_of(std::size_t i, std::size_t j) {
  TensorPiece b = bezier_piece(3);
  const double h = (u_[i + 1] - u_[i]) / 3, k = (v_[j + 1] - v_[j]) / 3;
  std::array<bool, 4> known{};
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 0; x < 2; ++x) {
      const Place where = place(i, j);
      const bool outside = triangle() && j + y > i + x;
      if (outside && where == Place::half) {
        known[3] = true;
        continue;
      }
      const Jet jet = outside ? jet_outside(i + x, j + y) : jet_at(u_[i + x], v_[j + y]);
      const double su = x == 0 ? h : -h, sv = y == 0 ? k : -k;
      const auto point = [&](std::size_t m, std::size_t n) -> Vector3& {
        return b.at(x == 0 ? m : 3 - m, y == 0 ? n : 3 - n);
      };
      const CornerJet& at = jet.jet;
      point(0, 0) = at.point;
      point(1, 0) = at.point + su * at.along_u;
      point(0, 1) = at.point + sv * at.along_v;
      point(1, 1) = point(1, 0) + sv * at.along_v + (su * sv) * at.twist;
      known[y == 0 ? x : 3 - x] = jet.known;
    }
  }
  const bool half = place(i, j) == Place::half;
  if (half) take_diagonal(u_[i], u_[i + 1], b);
  if (place(i, j) != Place::outside) fit_inside(i, j, known, b);
  if (half) take_diagonal(u_[i], u_[i + 1], b);
  take_largest(b);
  return b;
}

HermiteFace::Cell& HermiteFace::cell_at(std::size_t i, std::size_t j, double sufficient) {
  const CellKey key{u_[i], u_[i + 1], v_[j], v_[j + 1]};
  const auto found = cells_.find(key);
  if (found != cells_.end()) return found->second;
  Cell cell{bezier_of(i, j), 0};
  const auto x = static_cast<std::size_t>(key.u0), y = static_cast<std::size_t>(key.v0);
  FaceSquare& square = squares_[x + width_ * y];
  const double left = static_cast<double>(x), low = static_cast<double>(y);
  const ParameterBox box{key.u0 - left, key.u1 - left, key.v0 - low, key.v1 - low};
  for (TriangleTree* tree : {&square.lower, square.upper ? &*square.upper : nullptr}) {
    if (tree == nullptr) continue;
    TensorPiece moved = cell.bezier;
    const Vector3 shift = origin_ - tree->origin();
    for (std::size_t k = 0; k < moved.count(); ++k) moved.points[k] = moved.points[k] + shift;
    take_largest(moved);
    moved.error = enlarged(unit_roundoff * 2 * (max_abs(shift) + moved.largest)) + 4 * underflow_error;
    cell.distance = std::max(cell.distance, tree->distance(box, moved, sufficient));
  }
  return cells_.emplace(key, std::move(cell)).first->second;
}

// In the direction in which the borders of the cell are farther from the surface, or in both.
void HermiteFace::split(std::size_t i, std::size_t j, const TensorPiece& bezier, std::vector<double>& u,
                        std::vector<double>& v) {
  const double u0 = u_[i], u1 = u_[i + 1], v0 = v_[j], v1 = v_[j + 1], mu = 0.5 * (u0 + u1),
               mv = 0.5 * (v0 + v1);
  const auto off = [&](double x, double y) {
    return length(value(bezier, x, y) - limit(u0 + x * (u1 - u0), v0 + y * (v1 - v0)));
  };
  bool along_u = true, along_v = true;
  if (place(i, j) == Place::whole) {
    const double across_u = std::max(off(0.5, 0), off(0.5, 1)), across_v = std::max(off(0, 0.5), off(1, 0.5));
    along_u = across_u >= 0.25 * across_v;
    along_v = across_v >= 0.25 * across_u;
  }
  if (along_u && u1 - u0 > least_span) u.push_back(mu);
  if (along_v && v1 - v0 > least_span) v.push_back(mv);
}

bool HermiteFace::refine(double error, std::size_t most_spans) {
  for (;;) {
    std::vector<double> u = u_, v = v_;
    bool near = true;
    for (std::size_t j = 0; j + 1 < v_.size(); ++j) {
      for (std::size_t i = 0; i + 1 < u_.size(); ++i) {
        if (place(i, j) == Place::outside) continue;
        const Cell& cell = cell_at(i, j, 0.5 * error);
        if (cell.distance <= error) continue;
        near = false;
        split(i, j, cell.bezier, u, v);
      }
    }
    if (near) return true;
    if (triangle()) {
      u.insert(u.end(), v.begin(), v.end());
      v = u;
    }
    sort_unique(u);
    sort_unique(v);
    if ((u.size() == u_.size() && v.size() == v_.size()) || (u.size() - 1) * (v.size() - 1) > most_spans)
      return false;
    u_ = std::move(u);
    v_ = std::move(v);
  }
}

std::vector<FacePart> HermiteFace::parts() {
  std::vector<FacePart> parts;
  for (std::size_t j = 0; j + 1 < v_.size(); ++j) {
    for (std::size_t i = 0; i + 1 < u_.size(); ++i) {
      const ParameterBox box{u_[i], u_[i + 1], v_[j], v_[j + 1]};
      if (place(i, j) == Place::outside) {
        parts.push_back({box, bezier_of(i, j), origin_, true, 0});
      } else {
        const Cell& cell = cell_at(i, j, 0);
        parts.push_back({box, cell.bezier, origin_, true, cell.distance});
      }
    }
  }
  return parts;
}

}  // namespace snug
