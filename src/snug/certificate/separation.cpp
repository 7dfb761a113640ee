#include <snug/certificate/separation.h>

#include <algorithm>
#include <cmath>

#include <snug/certificate/text.h>
#include <snug/geometry/nearest_to_origin.h>
#include <support/point.h>

namespace snug {
namespace {

constexpr std::size_t few_owners = 4;  // ranges of so few are made finer, larger ones are halved
constexpr unsigned deepest_level = 48;
constexpr int max_tries = 24;  // of a search for one direction

// How far along w b lies behind a.
struct Support {
  Vector3 between;  // of the points that face each other
  double gap;       // times the length of w
};

Support support_along(std::span<const Point3> a, std::span<const Point3> b, const Vector3& w) {
  const auto along = [&](const Point3& p) { return dot(w, p - Point3{}); };
  const Point3* p = &a[0];
  const Point3* q = &b[0];
  for (const Point3& x : a) {
    if (along(x) > along(*p)) p = &x;
  }
  for (const Point3& x : b) {
    if (along(x) < along(*q)) q = &x;
  }
  return {*q - *p, along(*q) - along(*p)};
}

double largest_coordinate(std::span<const Point3> points) {
  double largest = 0;
  for (const Point3& p : points) largest = std::max(largest, max_abs(p - Point3{}));
  return largest;
}

}  // namespace

CertifiedSide side_of(NetRange& pieces, const Motion& pose) {
  CertifiedSide side{.pieces = &pieces, .pose = pose, .points = {}, .direction = {}};
  const std::vector<Point3> points = pieces.hull({});
  double reach = 0;
  for (const Point3& p : points) reach = std::max(reach, length(p - Point3{}));
  side.magnitude = reach + max_abs(pose.offset());
  return side;
}

CertifiedSide side_of(std::vector<Point3> points, std::optional<Vector3> direction) {
  const double magnitude = largest_coordinate(points);
  return {.pieces = nullptr,
          .pose = {},
          .points = std::move(points),
          .direction = direction,
          .magnitude = magnitude};
}

Box3 box_of(std::span<const Point3> points) {
  Box3 box;
  for (const Point3& p : points) box.add(p);
  return box;
}

std::vector<Point3> corners_of(const Box3& box) {
  std::vector<Point3> corners;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Point3& p = corners.emplace_back(box.lower);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1U) != 0) p[axis] = box.upper[axis];
    }
  }
  return corners;
}

namespace {

double width_along(std::span<const Point3> points, const Vector3& w) {
  double least = INFINITY, largest = -INFINITY;
  for (const Point3& p : points) {
    const double x = dot(w, p - Point3{});
    least = std::min(least, x);
    largest = std::max(largest, x);
  }
  return largest - least;
}

using Whole = std::array<std::int64_t, 3>;

Vector3 real(const Whole& w) {
  return {static_cast<double>(w[0]), static_cast<double>(w[1]), static_cast<double>(w[2])};
}

// A direction of short integers like w that separates, by more than the rounding of sums of three products of coordinates and
// of what made them, and does not go back along a half-line.
std::optional<Whole> rounded(std::span<const Point3> a, std::span<const Point3> b, double margin,
                             double magnitude, const Vector3& w, const Vector3& along = {}) {
  const double noise = 0x1p-46 * magnitude;
  for (const double scale : {0x1p7, 0x1p15, 0x1p30}) {
    const double by = scale / max_abs(w);
    const Whole whole{std::llround(by * w.x), std::llround(by * w.y), std::llround(by * w.z)};
    const Vector3 v = real(whole);
    if (dot(v, along) < 0) continue;
    if (support_along(a, b, v).gap > (margin * (1 + 0x1p-40) + 4 * noise) * length(v)) return whole;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::array<std::int64_t, 3>> separating_direction(std::span<const Point3> a,
                                                                std::span<const Point3> b, double margin,
                                                                double magnitude, Vector3& hint) {
  if (length_sq(hint) > 0 && support_along(a, b, hint).gap > margin * length(hint)) {
    if (const auto found = rounded(a, b, margin, magnitude, hint)) return found;
  }
  std::vector<Vector3> met{b[0] - a[0]};
  double best = -INFINITY;
  for (int step = 0; step < max_tries; ++step) {
    double size = 0;
    for (const Vector3& d : met) size = std::max(size, max_abs(d));
    if (size == 0) return std::nullopt;
    std::vector<Vector3> scaled;
    for (const Vector3& d : met) scaled.push_back((1 / size) * d);
    const Vector3 w = nearest_to_origin(scaled);
    const double norm = length(w);
    if (!(norm > 0x1p-40)) return std::nullopt;
    const Support next = support_along(a, b, w);
    const double gap = next.gap / norm;
    if (gap > best) {
      best = gap;
      hint = w;
    }
    if (gap > margin) {
      if (const auto found = rounded(a, b, margin, magnitude, w)) return found;
    }
    // The distance of the hulls is at most size |w|: no better direction is left, or none that would do.
    if (size * norm <= margin || size * norm - gap <= 1e-3 * std::fabs(size * norm - margin))
      return std::nullopt;
    met.push_back(next.between);
  }
  return std::nullopt;
}

std::optional<std::array<std::int64_t, 3>> separating_direction(std::span<const Point3> a, const HalfLine& b,
                                                                double magnitude, Vector3& hint) {
  const double norm = length_sq(b.along);
  const auto before = [&](const Point3& p) { return dot(p - b.from[0], b.along) / norm; };
  // Seen along the line, which is a point then; else with the start alone.
  std::vector<Point3> seen(a.begin(), a.end()), starts = b.from;
  for (std::vector<Point3>* points : {&seen, &starts}) {
    for (Point3& p : *points) p = p - before(p) * b.along;
  }
  for (const bool whole_line : {true, false}) {
    if (whole_line ? !separating_direction(seen, starts, 0, magnitude, hint)
                   : !separating_direction(a, b.from, 0, magnitude, hint))
      continue;
    if (whole_line) hint = hint - (dot(hint, b.along) / norm) * b.along;
    for (const double tilt : {0.0, 0x1p-20, 0x1p-12, 0x1p-8, 0x1p-5}) {
      const Vector3 w = hint + (tilt * length(hint) / std::sqrt(norm)) * b.along;
      if (const auto found = rounded(a, b.from, 0, magnitude, w, b.along)) return found;
    }
  }
  return std::nullopt;
}

namespace {

class Search {
 public:
  Search(std::string& text, const std::array<CertifiedSide, 2>& sides, double margin,
         const ProofLimits& limits, const AppendCrossing& crossing)
      : text_(text), sides_(sides), margin_(margin), limits_(limits), crossing_(crossing) {}

  Found run() {
    std::vector<Pair> open{{{sides_[0].pieces, sides_[1].pieces}, sides_[1].direction.value_or(Vector3{})}};
    const double magnitude = std::max(sides_[0].magnitude, sides_[1].magnitude);
    std::size_t leaves = 0;
    bool in_word = false;
    while (!open.empty()) {
      limits_.monitor.checkpoint();
      Pair pair = open.back();
      open.pop_back();
      const auto& a = points_of(0, pair.of[0]);
      const auto& b = points_of(1, pair.of[1]);
      const auto direction = sides_[1].direction
                                 ? separating_direction(a, {b, *sides_[1].direction}, magnitude, pair.hint)
                                 : separating_direction(a, b, margin_, magnitude, pair.hint);
      if (direction) {
        if (++leaves > limits_.leaves) return Found::too_many_leaves;
        if (in_word) text_ += ' ';
        in_word = false;
        append_direction(*direction);
        text_ += '\n';
        continue;
      }
      if (crossing_ && pair.of[0]->size() == 1) {
        const std::size_t before = text_.size();
        if (in_word) text_ += ' ';
        if (crossing_(text_, *pair.of[0])) {
          in_word = false;
          continue;
        }
        text_.resize(before);
      }
      const std::size_t side = side_to_open(pair, a, b);
      NetRange* const range = pair.of[side];
      if (range == nullptr || range->level() >= deepest_level) return Found::at_rounding;
      in_word = true;
      if (is_to_be_finer(side, *range)) {
        text_ += side == 0 ? 'a' : 'b';
        pair.of[side] = &range->finer();
        open.push_back(pair);
      } else {
        text_ += side == 0 ? 'A' : 'B';
        open.push_back(pair);
        open.back().of[side] = &range->half(1);
        pair.of[side] = &range->half(0);
        open.push_back(pair);
      }
    }
    return Found::proof;
  }

 private:
  struct Pair {
    std::array<NetRange*, 2> of;
    Vector3 hint;  // separated a pair around this one best
  };

  const std::vector<Point3>& points_of(std::size_t side, const NetRange* range) {
    if (range == nullptr) return sides_[side].points;
    const auto [known, is_new] = placed_[side].try_emplace(range);
    if (is_new) known->second = range->hull(sides_[side].pose);
    return known->second;
  }

  // A few owners beside each other: their hull is mostly what is around them. Halves of what are not are much smaller.
  bool is_to_be_finer(std::size_t side, NetRange& range) {
    if (range.size() == 1 || range.size() > few_owners || crossing_) return range.size() == 1;
    const double size = longest_side(box_of(points_of(side, &range)));
    const auto of_half = [&](std::size_t k) { return longest_side(box_of(points_of(side, &range.half(k)))); };
    return std::min(of_half(0), of_half(1)) > 0.6 * size;
  }

  // The thicker one along the direction that separates best: that is what is in the way.
  [[nodiscard]] std::size_t side_to_open(const Pair& pair, std::span<const Point3> a,
                                         std::span<const Point3> b) const {
    if (pair.of[0] == nullptr || pair.of[1] == nullptr) return pair.of[0] == nullptr ? 1 : 0;
    const auto size = [&](std::span<const Point3> points) {
      return length_sq(pair.hint) > 0 ? width_along(points, pair.hint) : longest_side(box_of(points));
    };
    return size(a) >= size(b) ? 0 : 1;
  }

  void append_direction(const std::array<std::int64_t, 3>& w) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (i > 0) text_ += ' ';
      text_ += std::to_string(w[i]);
    }
  }

  std::string& text_;
  const std::array<CertifiedSide, 2>& sides_;
  double margin_;
  const ProofLimits& limits_;
  const AppendCrossing& crossing_;
  std::array<std::unordered_map<const NetRange*, std::vector<Point3>>, 2> placed_;
};

}  // namespace

Found append_separation(std::string& text, const std::array<CertifiedSide, 2>& sides, double margin,
                        const ProofLimits& limits, const AppendCrossing& crossing) {
  return Search(text, sides, margin, limits, crossing).run();
}

}  // namespace snug
