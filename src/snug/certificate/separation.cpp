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

}  // namespace

Box3 box_of(std::span<const Point3> points) {
  Box3 box;
  for (const Point3& p : points) box.add(p);
  return box;
}

double largest_coordinate(std::span<const Point3> points) {
  double largest = 0;
  for (const Point3& p : points) largest = std::max(largest, max_abs(p - Point3{}));
  return largest;
}

Extent extent_along(std::span<const Point3> points, const Vector3& w) {
  Extent extent{INFINITY, -INFINITY};
  for (const Point3& p : points) {
    const double x = dot(w, p - Point3{});
    extent = {std::min(extent.least, x), std::max(extent.largest, x)};
  }
  return extent;
}

std::optional<std::array<std::int64_t, 3>> separating_direction(std::span<const Point3> a,
                                                                std::span<const Point3> b, double margin,
                                                                Vector3& hint) {
  // Sums of three products of coordinates and of what made them.
  const double noise = 0x1p-46 * std::max(largest_coordinate(a), largest_coordinate(b));
  const auto rounded = [&](const Vector3& w) -> std::optional<std::array<std::int64_t, 3>> {
    for (const double scale : {0x1p7, 0x1p15, 0x1p30}) {
      const double by = scale / max_abs(w);
      const std::array<std::int64_t, 3> whole{std::llround(by * w.x), std::llround(by * w.y),
                                              std::llround(by * w.z)};
      const Vector3 v{static_cast<double>(whole[0]), static_cast<double>(whole[1]),
                      static_cast<double>(whole[2])};
      if (support_along(a, b, v).gap > (margin * (1 + 0x1p-40) + 4 * noise) * length(v)) return whole;
    }
    return std::nullopt;
  };
  if (length_sq(hint) > 0 && support_along(a, b, hint).gap > margin * length(hint)) {
    if (const auto found = rounded(hint)) return found;
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
      if (const auto found = rounded(w)) return found;
    }
    // The distance of the hulls is at most size |w|: no better direction is left, or none that would do.
    if (size * norm <= margin || size * norm - gap <= 1e-3 * std::fabs(size * norm - margin))
      return std::nullopt;
    met.push_back(next.between);
  }
  return std::nullopt;
}

namespace {

class Search {
 public:
  Search(std::string& text, const std::array<CertifiedSide, 2>& sides, double margin,
         const ProofLimits& limits)
      : text_(text), sides_(sides), margin_(margin), limits_(limits) {}

  Found run() {
    // Of a half-line only what lies behind a plane across it is asked.
    std::vector<Pair> open{{{sides_[0].pieces, sides_[1].pieces}, sides_[1].direction.value_or(Vector3{})}};
    std::size_t leaves = 0;
    bool in_word = false;
    while (!open.empty()) {
      limits_.monitor.checkpoint();
      Pair pair = open.back();
      open.pop_back();
      const auto& a = points_of(0, pair.of[0]);
      const auto& b = points_of(1, pair.of[1]);
      const auto direction = separating_direction(a, b, margin_, pair.hint);
      if (direction && leaves_ray(*direction)) {
        if (++leaves > limits_.leaves) return Found::too_many_leaves;
        if (in_word) text_ += ' ';
        in_word = false;
        append_direction(*direction);
        text_ += '\n';
        continue;
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
    if (range.size() == 1 || range.size() > few_owners) return range.size() == 1;
    const double size = longest_side(box_of(points_of(side, &range)));
    const auto of_half = [&](std::size_t k) { return longest_side(box_of(points_of(side, &range.half(k)))); };
    return std::min(of_half(0), of_half(1)) > 0.6 * size;
  }

  // The thicker one along the direction that separates best: that is what is in the way.
  [[nodiscard]] std::size_t side_to_open(const Pair& pair, std::span<const Point3> a,
                                         std::span<const Point3> b) const {
    if (pair.of[0] == nullptr || pair.of[1] == nullptr) return pair.of[0] == nullptr ? 1 : 0;
    const auto size = [&](std::span<const Point3> points) {
      double sum = 0;
      if (length_sq(pair.hint) > 0) {
        const Extent extent = extent_along(points, pair.hint);
        sum = extent.largest - extent.least;
      } else {
        sum = longest_side(box_of(points));
      }
      return sum;
    };
    return size(a) >= size(b) ? 0 : 1;
  }

  // Does a half-line stay on its side of the plane?
  [[nodiscard]] bool leaves_ray(const std::array<std::int64_t, 3>& w) const {
    const Vector3 v{static_cast<double>(w[0]), static_cast<double>(w[1]), static_cast<double>(w[2])};
    const auto along = [&](const CertifiedSide& side) {
      return side.direction ? dot(v, *side.direction) : 0;
    };
    return along(sides_[0]) <= 0 && along(sides_[1]) >= 0;
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
  std::array<std::unordered_map<const NetRange*, std::vector<Point3>>, 2> placed_;
};

}  // namespace

Found append_separation(std::string& text, const std::array<CertifiedSide, 2>& sides, double margin,
                        const ProofLimits& limits) {
  return Search(text, sides, margin, limits).run();
}

}  // namespace snug
