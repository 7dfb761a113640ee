#include <snug/query/plane_cover.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include <snug/geometry/exact_sign.h>
#include <snug/geometry/rounding.h>
#include <snug/search/feet.h>

namespace snug {
namespace {

// How far points of a piece, or of its set, are from the triangle of its corners, at the same parameters.
double off_triangle(const QuadraticTriangle& piece) {
  double bent = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3 middle = piece.corners[k] + 0.5 * (piece.corners[(k + 1) % 3] - piece.corners[k]);
    bent = std::max(bent, length(piece.middles[k] - middle));
  }
  return enlarged(bent + piece.error) + distance_rounding;
}

// A triangle as a projection sees it.
struct SeenTriangle {
  Triangle at;
  Projection plane;
  int turn;  // 0: a line

  SeenTriangle(const Triangle& t, Projection to)
      : at(t), plane(to), turn(orientation(t[0], t[1], t[2], to)) {}
  // Is a point outside of an edge, or on it?
  [[nodiscard]] bool beyond(std::size_t edge, const Point3& p) const {
    return turn * orientation(at[edge], at[(edge + 1) % 3], p, plane) <= 0;
  }
  // Does an edge have all of another triangle outside?
  [[nodiscard]] bool parts(const SeenTriangle& other) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (beyond(k, other.at[0]) && beyond(k, other.at[1]) && beyond(k, other.at[2])) return true;
    }
    return false;
  }
  // Does a segment run through the inside?
  [[nodiscard]] bool is_entered_by(const Point3& p, const Point3& q) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (beyond(k, p) && beyond(k, q)) return false;
    }
    int least = 1, most = -1;
    for (const Point3& corner : at) {
      const int side = orientation(p, q, corner, plane);
      least = std::min(least, side);
      most = std::max(most, side);
    }
    return least < 0 && most > 0;
  }
};

// PlaneHeights over a triangle's plane along a coordinate.
class PlaneHeights {
 public:
  explicit PlaneHeights(const Triangle& t) : from_(t[0]) {
    const Vector3 a = t[1] - t[0], b = t[2] - t[0];
    normal_ = cross(a, b);
    for (std::size_t k = 1; k < 3; ++k) {
      if (std::fabs(normal_[k]) > std::fabs(normal_[axis_])) axis_ = k;
    }
    normal_error_ = 8 * unit_roundoff * max_abs(a) * max_abs(b);
  }
  [[nodiscard]] bool known() const { return std::fabs(normal_[axis_]) > 0x1p10 * normal_error_; }
  [[nodiscard]] Projection plane() const { return {(axis_ + 1) % 3, (axis_ + 2) % 3}; }
  // Of a point, at most.
  [[nodiscard]] double of(const Point3& p) const {
    const Vector3 d = p - from_;
    const double off = 3 * max_abs(d) * (normal_error_ + 4 * unit_roundoff * max_abs(normal_));
    return enlarged((std::fabs(dot(normal_, d)) + off) / (std::fabs(normal_[axis_]) - normal_error_));
  }

 private:
  Point3 from_;
  Vector3 normal_;
  std::size_t axis_ = 0;
  double normal_error_;
};

struct CornerHash {
  std::size_t operator()(const Point3& p) const {
    std::uint64_t h = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      h = (h ^ std::bit_cast<std::uint64_t>(p[a] + 0.0)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return h;
  }
};

bool all_signed(const Triangle& t) {
  return may_be_signed(t[0]) && may_be_signed(t[1]) && may_be_signed(t[2]);
}

}  // namespace

PlaneCover::PlaneCover(const PieceSet& set, double most) : set_(set), most_(most) {
  std::unordered_map<Point3, std::uint32_t, CornerHash> known;
  for (std::uint32_t piece = 0; piece < set.size(); ++piece) {
    off_.push_back(off_triangle(set[piece]));
    for (const Point3& p : set[piece].corners)
      names_.push_back(known.try_emplace(p, static_cast<std::uint32_t>(known.size())).first->second);
    for (std::size_t k = 0; k < 3 && off_.back() <= most; ++k) {
      const auto [low, high] = std::minmax(names_[3 * piece + k], names_[3 * piece + (k + 1) % 3]);
      sides_.push_back({low, high, piece});
    }
  }
  std::sort(sides_.begin(), sides_.end(), [](const Side& x, const Side& y) {
    return x.low != y.low ? x.low < y.low : x.high != y.high ? x.high < y.high : x.piece < y.piece;
  });
}

// Where the inside of the piece were left by the pieces that are seen over it, that would be through an edge of one, with none on its
// other side.
std::optional<double> PlaneCover::distance_of(const QuadraticTriangle& piece) const {
  const double own = off_triangle(piece);
  const PlaneHeights heights(piece.corners);
  if (!(own <= most_) || !heights.known() || !all_signed(piece.corners)) return std::nullopt;
  const Projection plane = heights.plane();
  const SeenTriangle inside(piece.corners, plane);
  if (inside.turn == 0) return std::nullopt;
  const auto height_of = [&](std::uint32_t other) {
    double most = 0;
    for (const Point3& p : set_[other].corners) most = std::max(most, heights.of(p));
    return most + off_[other];
  };
  std::vector<std::uint32_t> over, needed;
  // A piece on the other side of an edge of another one is needed.
  const auto goes_on = [&](std::uint32_t other, std::size_t k, const SeenTriangle& seen) {
    const auto [low, high] = std::minmax(names_[3 * other + k], names_[3 * other + (k + 1) % 3]);
    const auto first =
        std::lower_bound(sides_.begin(), sides_.end(), std::pair(low, high),
                         [](const Side& side, const std::pair<std::uint32_t, std::uint32_t>& ends) {
                           return std::pair(side.low, side.high) < ends;
                         });
    for (auto side = first; side != sides_.end() && side->low == low && side->high == high; ++side) {
      const Triangle corners = set_[side->piece].corners;
      if (side->piece == other || !all_signed(corners)) continue;
      const Point3& p = seen.at[k];
      const Point3& q = seen.at[(k + 1) % 3];
      const bool across = std::any_of(corners.begin(), corners.end(), [&](const Point3& corner) {
        return seen.turn * orientation(p, q, corner, plane) < 0;
      });
      if (!across) continue;
      needed.push_back(side->piece);
      return true;
    }
    return false;
  };
  double most = 0;
  const bool open = set_.visit_near(slim_box(piece), [&](std::uint32_t other) {
    if (!all_signed(set_[other].corners)) return false;
    const SeenTriangle seen(set_[other].corners, plane);
    if (seen.turn == 0 || inside.parts(seen) || seen.parts(inside)) return false;
    const double height = height_of(other);
    if (!(height <= most_)) return false;
    over.push_back(other);
    most = std::max(most, height);
    for (std::size_t k = 0; k < 3; ++k) {
      if (inside.is_entered_by(seen.at[k], seen.at[(k + 1) % 3]) && !goes_on(other, k, seen)) return true;
    }
    return false;
  });
  std::sort(over.begin(), over.end());
  const bool all = std::all_of(needed.begin(), needed.end(), [&](std::uint32_t other) {
    return std::binary_search(over.begin(), over.end(), other);
  });
  if (open || over.empty() || !all) return std::nullopt;
  return enlarged(own + most) + distance_rounding;
}

}  // namespace snug
