#pragma once

#include <gtest/gtest.h>
#include <oracle/hausdorff_twin.h>
#include <oracle/tagged_shapes.h>
#include <snug/mesh.h>

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// Triangles that stand for a surface, well and badly, and which pairs of choices a test has drawn.
namespace snug::testing {

using TriangleSet = std::vector<oracle::Corners>;

/// Fans at each face's first corner.
[[nodiscard]] inline TriangleSet triangles_of(const oracle::TaggedMesh& mesh) {
  TriangleSet set;
  for (const auto& face : mesh.polygons) {
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      set.push_back({mesh.points[face[0]], mesh.points[face[k]], mesh.points[face[k + 1]]});
  }
  return set;
}
[[nodiscard]] inline TriangleSet triangles_of(const ControlMesh& mesh) {
  const auto corner = [&](VertexId v) {
    const Point3& p = mesh.points[v.index()];
    return oracle::Point{p.x, p.y, p.z};
  };
  TriangleSet set;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      set.push_back({corner(face[0]), corner(face[k]), corner(face[k + 1])});
  }
  return set;
}

[[nodiscard]] inline std::vector<Triangle> candidate_of(const TriangleSet& set) {
  std::vector<Triangle> candidate;
  for (const oracle::Corners& t : set) {
    Triangle& corners = candidate.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) corners[k] = {t[k][0], t[k][1], t[k][2]};
  }
  return candidate;
}

template <class Change>
void change_points(TriangleSet& set, const Change& change) {
  for (oracle::Corners& t : set)
    for (oracle::Point& p : t) p = change(p);
}

/// Each cut in two at the middle of an edge.
[[nodiscard]] inline TriangleSet halved(const TriangleSet& set, std::mt19937_64& random) {
  TriangleSet parts;
  for (const oracle::Corners& t : set) {
    const std::size_t k = random() % 3;
    const oracle::Point &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
    const oracle::Point m{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    parts.push_back({a, m, c});
    parts.push_back({m, b, c});
  }
  return parts;
}

/// Longest side of the box around a set.
[[nodiscard]] inline double size_of(const TriangleSet& set) {
  double size = 0;
  for (std::size_t x = 0; x < 3; ++x) {
    double lower = INFINITY, upper = -INFINITY;
    for (const oracle::Corners& t : set)
      for (const oracle::Point& p : t) lower = std::fmin(lower, p[x]), upper = std::fmax(upper, p[x]);
    size = std::fmax(size, upper - lower);
  }
  return size;
}

/// Relation of a candidate to the surface that it approximates.
enum class CandidateKind {
  same,
  moved,
  scaled,
  remeshed,
  holes,
  flipped,
  spoiled,   ///< a corner of a triangle is somewhere else
  slivers,   ///< with triangles without area along edges and across
  overlays,  ///< triangles in the planes of others, beyond their edges
  points,
  needles,
  soup,
  one,  ///< a single triangle
  far,
  other_size,  ///< a grain, or a boulder
};
inline constexpr std::array candidate_names{"same",    "moved",   "scaled",  "remeshed", "holes",
                                            "flipped", "spoiled", "slivers", "overlays", "points",
                                            "needles", "soup",    "one",     "far",      "of another size"};

/// Beside triangles whose corners are whole numbers, or nearly so; about `size` large. Corners of the result
/// are multiples of 1/64 of those.
[[nodiscard]] inline TriangleSet make_candidate(CandidateKind kind, TriangleSet set, double size,
                                                std::mt19937_64& random) {
  using oracle::Point;
  const double unit = size / 64;
  const auto number = [&](int most) {
    return unit *
           static_cast<double>(static_cast<int>(random() % static_cast<std::uint64_t>(2 * most + 1)) - most);
  };
  const auto point = [&](int most) { return Point{number(most), number(most), number(most)}; };
  const auto plus = [](const Point& p, const Point& d) {
    return Point{p[0] + d[0], p[1] + d[1], p[2] + d[2]};
  };
  const auto mixed = [](const oracle::Corners& t, double u, double v) {
    Point p;
    for (std::size_t x = 0; x < 3; ++x) p[x] = t[0][x] + u * (t[1][x] - t[0][x]) + v * (t[2][x] - t[0][x]);
    return p;
  };
  switch (kind) {
    case CandidateKind::same:
      return set;
    case CandidateKind::moved: {
      const Point by = point(8);
      change_points(set, [&](const Point& p) { return plus(p, by); });
      return set;
    }
    case CandidateKind::scaled: {
      const double s = random() % 2 == 0 ? 0.5 : 1.25;
      change_points(set, [&](const Point& p) { return Point{s * p[0], s * p[1], s * p[2]}; });
      return set;
    }
    case CandidateKind::remeshed:
      return halved(halved(set, random), random);
    case CandidateKind::holes: {
      const std::size_t drop = 1 + random() % (1 + set.size() / 3);
      for (std::size_t k = 0; k < drop && set.size() > 1; ++k)
        set.erase(set.begin() + static_cast<std::ptrdiff_t>(random() % set.size()));
      return set;
    }
    case CandidateKind::flipped:
      for (oracle::Corners& t : set)
        if (random() % 2 == 0) std::swap(t[0], t[1]);
      return set;
    case CandidateKind::spoiled: {
      Point& p = set[random() % set.size()][random() % 3];
      p = plus(p, point(16));
      return set;
    }
    case CandidateKind::slivers: {
      const std::size_t count = set.size();
      for (std::size_t k = 0; k < 1 + count / 4; ++k) {
        const oracle::Corners t = set[random() % count], other = set[random() % count];
        set.push_back({t[0], t[1], mixed(t, 0.25, 0)});
        set.push_back({t[0], t[0], other[0]});
        set.push_back({t[1], mixed({t[1], other[2], t[0]}, 0.5, 0), other[2]});
      }
      return set;
    }
    case CandidateKind::overlays: {
      const double at[] = {-0.5, 0, 0.25, 0.5, 1, 1.5};
      TriangleSet over;
      for (const oracle::Corners& t : set) {
        const auto corner = [&] { return mixed(t, at[random() % 6], at[random() % 6]); };
        over.push_back({corner(), corner(), corner()});
      }
      return over;
    }
    case CandidateKind::points: {
      TriangleSet dots;
      for (std::size_t k = 0; k < 1 + random() % 4; ++k) {
        const Point p = random() % 2 == 0 ? set[random() % set.size()][0] : point(64);
        dots.push_back({p, p, p});
      }
      return dots;
    }
    case CandidateKind::needles: {
      TriangleSet thin;
      for (std::size_t k = 0; k < 2 + random() % 6; ++k) {
        const Point a = point(64), b = point(64);
        thin.push_back({a, b, plus(b, {unit * 0x1p-20, 0, unit * 0x1p-24})});
      }
      return thin;
    }
    case CandidateKind::one:
    case CandidateKind::soup: {
      const std::size_t count = kind == CandidateKind::one ? 1 : 2 + random() % 12;
      TriangleSet some;
      while (some.size() < count) some.push_back({point(64), point(64), point(64)});
      return some;
    }
    case CandidateKind::far: {
      const double away = random() % 2 == 0 ? 10 : 1000;
      change_points(set, [&](const Point& p) { return plus(p, {away * size, 3 * size, 0}); });
      return set;
    }
    case CandidateKind::other_size: {
      const double s = std::ldexp(1.0, random() % 2 == 0 ? -30 : 30);
      change_points(set, [&](const Point& p) { return Point{s * p[0], s * p[1], s * p[2]}; });
      return set;
    }
  }
  return set;
}

/// Which values of several choices met.
class PairsDrawn {
 public:
  /// `counts`: how many values each choice has.
  explicit PairsDrawn(std::vector<std::size_t> counts) : counts_(std::move(counts)) {}
  void add(const std::vector<std::size_t>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) drawn_.insert({i, values[i], j, values[j]});
  }
  [[nodiscard]] std::size_t missing() const {
    std::size_t all = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) all += counts_[i] * counts_[j];
    return all - drawn_.size();
  }

 private:
  std::vector<std::size_t> counts_;
  std::set<std::array<std::size_t, 4>> drawn_;
};

}  // namespace snug::testing
