#include <snug/spline/face_spline.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

constexpr std::size_t most_arguments = TensorPiece::max_degree;

// The last span that begins at or before a parameter, by the place of its first knot.
std::size_t span_at(const std::vector<double>& knots, std::size_t degree, double t) {
  const auto end = knots.end() - static_cast<std::ptrdiff_t>(degree) - 1;
  const auto after = std::upper_bound(knots.begin() + static_cast<std::ptrdiff_t>(degree), end, t);
  return static_cast<std::size_t>(after - knots.begin()) - 1;
}

// The polynomial of a span, by points relative to `origin`.
TensorPiece span_of(const SplineSurface& spline, std::size_t u, std::size_t v, const Point3& origin) {
  const std::size_t d = spline.degree, columns = spline.columns();
  TensorPiece piece;
  piece.degree = d;
  for (std::size_t k = 0; k < 2 * d; ++k) {
    piece.u[k] = spline.u_knots[u - d + 1 + k];
    piece.v[k] = spline.v_knots[v - d + 1 + k];
  }
  for (std::size_t j = 0; j <= d; ++j) {
    for (std::size_t i = 0; i <= d; ++i)
      piece.at(i, j) = spline.points[u - d + i + columns * (v - d + j)] - origin;
  }
  take_largest(piece);
  piece.error = unit_roundoff * piece.largest + underflow_error;
  return piece;
}

// A curve as a surface that does not change along v.
SplineSurface swept(const SplineCurve& curve) {
  SplineSurface surface{curve.degree, curve.knots, {}, {}};
  surface.v_knots.assign(curve.degree + 1, 0.0);
  surface.v_knots.resize(2 * (curve.degree + 1), 1.0);
  for (unsigned j = 0; j <= curve.degree; ++j)
    surface.points.insert(surface.points.end(), curve.points.begin(), curve.points.end());
  return surface;
}

// Where one of two lists has a knot, on the parameters of the first.
std::vector<double> common_breaks(const std::vector<double>& knots, const std::vector<double>& others) {
  std::vector<double> breaks = knots;
  for (const double t : others) {
    if (t > knots.front() && t < knots.back()) breaks.push_back(t);
  }
  std::sort(breaks.begin(), breaks.end());
  return breaks_of(breaks);
}

double share_of(double t, double low, double high) { return (t - low) / (high - low); }

ParameterBox within(const ParameterBox& outer, const ParameterBox& box) {
  return {share_of(box.u0, outer.u0, outer.u1), share_of(box.u1, outer.u0, outer.u1),
          share_of(box.v0, outer.v0, outer.v1), share_of(box.v1, outer.v0, outer.v1)};
}

// Parts by the cells that their sides cut the face into.
class Cells {
 public:
  explicit Cells(std::span<const FacePart> parts) : parts_(parts) {
    for (const FacePart& part : parts) {
      for (const double t : {part.box.u0, part.box.u1}) u_.push_back(t);
      for (const double t : {part.box.v0, part.box.v1}) v_.push_back(t);
    }
    for (std::vector<double>* lines : {&u_, &v_}) {
      std::sort(lines->begin(), lines->end());
      lines->erase(std::unique(lines->begin(), lines->end()), lines->end());
    }
    cells_.resize((u_.size() - 1) * (v_.size() - 1));
    for (std::uint32_t p = 0; p < parts.size(); ++p) {
      const ParameterBox& box = parts[p].box;
      for (std::size_t j = index(v_, box.v0); v_[j] < box.v1; ++j) {
        for (std::size_t i = index(u_, box.u0); u_[i] < box.u1; ++i) cells_[i + (u_.size() - 1) * j] = p;
      }
    }
  }

  [[nodiscard]] const std::vector<double>& lines(bool across_u) const { return across_u ? u_ : v_; }
  [[nodiscard]] const FacePart& at(std::size_t i, std::size_t j) const {
    return parts_[cells_[i + (u_.size() - 1) * j]];
  }
  static std::size_t index(const std::vector<double>& lines, double t) {
    return static_cast<std::size_t>(std::lower_bound(lines.begin(), lines.end(), t) - lines.begin());
  }

  // How often a line is a knot.
  [[nodiscard]] std::size_t multiplicity(bool across_u, std::size_t line, std::size_t natural) const {
    const std::size_t degree = parts_.front().piece.degree;
    if (degree > natural) return degree - natural + 1;
    const std::size_t others = lines(!across_u).size() - 1;
    for (std::size_t k = 0; k < others; ++k) {
      const FacePart &a = across_u ? at(line - 1, k) : at(k, line - 1),
                     &b = across_u ? at(line, k) : at(k, line);
      if (&a != &b && (a.tip || b.tip)) return degree - 1;
    }
    return 1;
  }

 private:
  std::span<const FacePart> parts_;
  std::vector<double> u_, v_;
  std::vector<std::uint32_t> cells_;
};

std::vector<double> knots_of(const Cells& cells, bool across_u, std::size_t degree, std::size_t natural) {
  const std::vector<double>& lines = cells.lines(across_u);
  std::vector<double> knots(degree + 1, lines.front());
  for (std::size_t k = 1; k + 1 < lines.size(); ++k)
    knots.insert(knots.end(), cells.multiplicity(across_u, k, natural), lines[k]);
  knots.insert(knots.end(), degree + 1, lines.back());
  return knots;
}

// The cell whose polynomial has a control point: the longer one beside its middle argument, in its support.
std::size_t cell_for(const std::vector<double>& lines, const std::vector<double>& knots, std::size_t degree,
                     std::size_t point) {
  const double middle = knots[point + (degree + 1) / 2], low = knots[point], high = knots[point + degree + 1];
  const std::size_t line = Cells::index(lines, middle);
  const bool before = line > 0 && lines[line - 1] >= low,
             after = line + 1 < lines.size() && lines[line + 1] <= high;
  const bool longer = before && after && lines[line] - lines[line - 1] > lines[line + 1] - lines[line];
  return longer || !after ? line - 1 : line;
}

}  // namespace

SplineSurface spline_of(std::span<const FacePart> parts, std::size_t natural) {
  SNUG_EXPECT(!parts.empty());
  const Cells cells(parts);
  const std::size_t degree = parts.front().piece.degree;
  SplineSurface spline{static_cast<unsigned>(degree),
                       knots_of(cells, true, degree, natural),
                       knots_of(cells, false, degree, natural),
                       {}};
  const std::size_t columns = spline.columns(), rows = spline.rows();
  spline.points.reserve(columns * rows);
  for (std::size_t j = 0; j < rows; ++j) {
    const std::size_t y = cell_for(cells.lines(false), spline.v_knots, degree, j);
    for (std::size_t i = 0; i < columns; ++i) {
      const std::size_t x = cell_for(cells.lines(true), spline.u_knots, degree, i);
      const FacePart& part = cells.at(x, y);
      std::array<double, most_arguments> u{}, v{};
      for (std::size_t k = 0; k < degree; ++k) {
        u[k] = share_of(spline.u_knots[i + 1 + k], part.box.u0, part.box.u1);
        v[k] = share_of(spline.v_knots[j + 1 + k], part.box.v0, part.box.v1);
      }
      spline.points.push_back(part.origin + blossom(part.piece, {u.data(), degree}, {v.data(), degree}));
    }
  }
  return spline;
}

double distance_bound(std::span<const FacePart> parts, const SplineSurface& spline) {
  double largest = 0;
  for (const FacePart& part : parts) {
    const std::size_t d = spline.degree;
    double here = 0;
    for (std::size_t y = span_at(spline.v_knots, d, part.box.v0); spline.v_knots[y] < part.box.v1; ++y) {
      if (spline.v_knots[y] == spline.v_knots[y + 1]) continue;
      for (std::size_t x = span_at(spline.u_knots, d, part.box.u0); spline.u_knots[x] < part.box.u1; ++x) {
        if (spline.u_knots[x] == spline.u_knots[x + 1]) continue;
        const ParameterBox box{
            std::max(part.box.u0, spline.u_knots[x]), std::min(part.box.u1, spline.u_knots[x + 1]),
            std::max(part.box.v0, spline.v_knots[y]), std::min(part.box.v1, spline.v_knots[y + 1])};
        here = std::max(here, distance_bound(bezier_on(part.piece, within(part.box, box)),
                                             bezier_on(span_of(spline, x, y, part.origin), box)));
      }
    }
    largest = std::max(largest, enlarged(part.distance + here));
  }
  return largest;
}

SplineCurve side_of(const SplineSurface& surface, std::size_t k) {
  const bool along_u = k % 2 == 0, backwards = k >= 2;
  const std::size_t columns = surface.columns(), rows = surface.rows();
  SplineCurve curve{surface.degree, along_u ? surface.u_knots : surface.v_knots, {}};
  const std::size_t count = along_u ? columns : rows;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t x = along_u ? i : k == 1 ? columns - 1 : 0, y = along_u ? (k == 0 ? 0 : rows - 1) : i;
    curve.points.push_back(surface.points[x + columns * y]);
  }
  return backwards ? reversed(curve) : curve;
}

SplineCurve reversed(const SplineCurve& curve) {
  SplineCurve result{curve.degree, {}, {curve.points.rbegin(), curve.points.rend()}};
  const double end = curve.knots.back();
  for (auto knot = curve.knots.rbegin(); knot != curve.knots.rend(); ++knot)
    result.knots.push_back(end - *knot);
  return result;
}

SplineCurve part_of(const SplineCurve& curve, double begin, double end) {
  if (begin == curve.knots.front() && end == curve.knots.back()) return curve;
  const std::size_t d = curve.degree;
  std::vector<double> knots(d + 1, begin);
  for (const double knot : curve.knots) {
    if (knot > begin && knot < end) knots.push_back(knot);
  }
  knots.insert(knots.end(), d + 1, end);
  const SplineSurface sheet = swept(curve);
  SplineCurve result{curve.degree, {}, {}};
  for (std::size_t i = 0; i + d + 1 < knots.size(); ++i) {
    // A span in the support, between the ends.
    const double middle = 0.5 * (knots[i + d / 2] + knots[i + d / 2 + 1]);
    const double inside =
        knots[i + d / 2] < knots[i + d / 2 + 1] ? middle : 0.5 * (knots[i] + knots[i + d + 1]);
    const std::size_t span = span_at(curve.knots, d, inside);
    const TensorPiece piece = span_of(sheet, span, d, {});
    const std::array<double, most_arguments> zero{};
    result.points.push_back(Point3{} + blossom(piece, {knots.data() + i + 1, d}, {zero.data(), d}));
  }
  for (const double knot : knots) result.knots.push_back(knot - begin);
  return result;
}

double distance_bound(const SplineCurve& a, const SplineCurve& b) {
  const SplineSurface p = swept(a), q = swept(b);
  const std::vector<double> breaks = common_breaks(a.knots, b.knots);
  double largest = 0;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const ParameterBox box{breaks[k], breaks[k + 1], 0, 1};
    const Point3 origin = a.points.front();
    TensorPiece from_a =
        bezier_on(span_of(p, span_at(p.u_knots, p.degree, breaks[k]), p.degree, origin), box);
    TensorPiece from_b =
        bezier_on(span_of(q, span_at(q.u_knots, q.degree, breaks[k]), q.degree, origin), box);
    if (from_a.degree < from_b.degree) from_a = raised(from_a);
    if (from_b.degree < from_a.degree) from_b = raised(from_b);
    largest = std::max(largest, distance_bound(from_a, from_b));
  }
  return largest;
}

SplineCurve diagonal_of(const SplineSurface& surface) {
  if (surface.degree == 1) return {1, surface.u_knots, {surface.points.front(), surface.points.back()}};
  SplineCurve curve{surface.degree, surface.u_knots, {surface.points.front()}};
  const std::vector<double> breaks = breaks_of(surface.u_knots);
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const std::size_t span = span_at(surface.u_knots, 3, breaks[k]);
    const Point3 origin = surface.points[span - 3 + surface.columns() * (span - 3)];
    const TensorPiece b =
        bezier_on(span_of(surface, span, span, origin), {breaks[k], breaks[k + 1], breaks[k], breaks[k + 1]});
    curve.points.push_back(origin + (b.at(1, 0) + (b.at(0, 1) - b.at(0, 0))));
    curve.points.push_back(origin + (b.at(2, 3) + (b.at(3, 2) - b.at(3, 3))));
  }
  curve.points.push_back(surface.points.back());
  return curve;
}

// Bezier points of degree 2 d on both sides: of the product, and of the curve times (s + t)^d.
double distance_from_diagonal(const SplineSurface& surface, const SplineCurve& curve) {
  const std::size_t d = surface.degree;
  SNUG_EXPECT(curve.degree == d);
  const SplineSurface sheet = swept(curve);
  const auto choose = [](std::size_t n, std::size_t k) {
    double result = 1;
    for (std::size_t i = 0; i < k; ++i)
      result = result * static_cast<double>(n - i) / static_cast<double>(i + 1);
    return result;
  };
  double largest = 0;
  // The curve may have knots that the surface has not: it can be a border of the face across the diagonal.
  const std::vector<double> breaks = common_breaks(surface.u_knots, curve.knots);
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const double begin = breaks[k], end = breaks[k + 1];
    const std::size_t span = span_at(surface.u_knots, d, begin), own = span_at(curve.knots, d, begin);
    const Point3 origin = curve.points[own - d];
    const TensorPiece a = bezier_on(span_of(surface, span, span, origin), {begin, end, begin, end}),
                      b = bezier_on(span_of(sheet, own, d, origin), {begin, end, 0, 1});
    double here = 0;
    for (std::size_t n = 0; n <= 2 * d; ++n) {
      Vector3 off;
      for (std::size_t i = n > d ? n - d : 0; i <= std::min(n, d); ++i) {
        const double share = choose(d, i) * choose(d, n - i) / choose(2 * d, n);
        off = off + share * (a.at(i, n - i) - b.at(i, 0));
      }
      here = std::max(here, length_sq(off));
    }
    const double rounding =
        a.error + b.error + gamma_bound(16) * (a.largest + b.largest) + 64 * underflow_error;
    largest = std::max(largest, distance_up(here, rounding));
  }
  return largest;
}

std::vector<double> breaks_of(const std::vector<double>& knots) {
  std::vector<double> breaks = knots;
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  return breaks;
}

SplineFrame frame_at(const SplineSurface& surface, double u, double v) {
  const std::size_t d = surface.degree, x = span_at(surface.u_knots, d, u),
                    y = span_at(surface.v_knots, d, v);
  const Point3 origin = surface.points[x - d + surface.columns() * (y - d)];
  const TensorPiece piece = span_of(surface, x, y, origin);
  const CornerJet jet = jet_at(piece, u, v);
  SplineFrame frame{origin + jet.point, {}};
  const Vector3 across = cross(jet.along_u, jet.along_v);
  const double size = length(across);
  if (size > 0 && std::isfinite(size)) frame.normal = (1 / size) * across;
  return frame;
}

}  // namespace snug
