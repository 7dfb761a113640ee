#include <snug/certificate/disc.h>

#include <algorithm>
#include <cmath>

#include <snug/certificate/separation.h>
#include <snug/certificate/text.h>
#include <support/point.h>

namespace snug {
namespace {

constexpr std::size_t finer_steps = 2;   // of a hull
constexpr std::size_t border_steps = 4;  // of the hull of a border curve
constexpr std::array<std::size_t, 3> corner_steps{16, 40, 100};

// How often a line crosses the triangles from the first corner, whatever points within `error` are meant. Nothing if that
// depends on them.
std::optional<int> crossings(const Point3& from, const Vector3& along, const Point3* end,
                             std::span<const Point3> corners, double error) {
  int crossed = 0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const std::array<Vector3, 3> c{corners[0] - from, corners[k] - from, corners[k + 1] - from};
    int turns = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 &p = c[i], &q = c[(i + 1) % 3];
      const double turn = dot(along, cross(p, q));
      if (!(std::fabs(turn) >= 8 * error * (length(p) * length(q) + length(along) * (length(p) + length(q)))))
        return std::nullopt;
      turns += turn > 0 ? 1 : -1;
    }
    if (std::abs(turns) != 3) continue;
    const Vector3 normal = cross(c[1] - c[0], c[2] - c[0]);
    const double size = std::max(length(c[1] - c[0]), length(c[2] - c[0]));
    const double least = 8 * error * (length(normal) + size * (length(c[0]) + size));
    const double before = dot(normal, c[0]);
    const double after = end ? dot(normal, corners[0] - *end) : -turns;
    if (!(std::fabs(before) >= least) || (end && !(std::fabs(after) >= least))) return std::nullopt;
    if ((before > 0) != (after > 0)) crossed += before > 0 ? 1 : -1;
  }
  return crossed;
}

}  // namespace

void append_direction(std::string& text, const std::array<std::int64_t, 3>& w) {
  for (const std::int64_t x : w) text += ' ' + std::to_string(x);
  text += '\n';
}

bool Disc::is_simple() const {
  const std::size_t count = corner_count();
  return piece_->triangular() ? count == 3 : count == 4;
}

const std::vector<Point3>& Disc::hull() {
  if (hull_.empty()) {
    NetRange* range = piece_.get();
    for (std::size_t i = 0; i < finer_steps; ++i) range = &range->finer();
    hull_ = range->hull(pose_);
  }
  return hull_;
}

const std::vector<std::vector<Point3>>& Disc::borders() {
  for (std::size_t k = borders_.size(); k < corner_count(); ++k) borders_.push_back(border(k));
  return borders_;
}

const Disc::Corners& Disc::corners(std::size_t more) {
  while (corners_.size() <= more) {
    Corners& corners = corners_.emplace_back(Corners{corner_steps[corners_.size()], {}});
    for (std::size_t k = 0; k < corner_count(); ++k) {
      std::unique_ptr<NetRange> piece = piece_->only(0);
      for (const std::size_t step : steps_to(k, corners.steps)) piece = piece->finer().only(step);
      const Box3 box = box_of(piece->hull(pose_));
      corners.size = std::max(corners.size, longest_side(box));
      corners.points.push_back(box.lower + 0.5 * (box.upper - box.lower));
    }
  }
  return corners_[more];
}

std::vector<std::size_t> Disc::steps_to(std::size_t corner, std::size_t count) const {
  std::vector<std::size_t> steps(count, piece_->dual() ? 0 : corner);
  steps[0] = corner;
  return steps;
}

// A piece with three or four corners has four children, as have they.
std::vector<Point3> Disc::border(std::size_t k) const {
  const std::size_t corners = corner_count();
  NetRange* parent = piece_.get();
  std::unique_ptr<NetRange> along;    // what follows the curve
  std::vector<std::size_t> sides{k};  // and with which side
  for (std::size_t i = 0; i < border_steps; ++i) {
    std::vector<std::size_t> children, next_sides;
    for (std::size_t piece = 0; piece < sides.size(); ++piece) {
      const std::size_t side = sides[piece];
      children.insert(children.end(), {4 * piece + side, 4 * piece + (side + 1) % corners});
      next_sides.insert(next_sides.end(), {parent->dual() ? 0 : side, parent->dual() ? 3 : side});
    }
    along = parent->finer().some(children);
    parent = along.get();
    sides = std::move(next_sides);
  }
  return along->hull(pose_);
}

void Disc::append_steps_of_hull(std::string& text) { append_words(text, finer_steps); }

void Disc::append_border(std::string& text, const std::array<std::int64_t, 3>& direction) {
  text += "border";
  append_words(text, border_steps);
  append_direction(text, direction);
}

std::optional<int> Disc::append_corners(std::string& text, const Point3& from, const Vector3& along,
                                        const Point3* end, double error) {
  for (std::size_t more = 0; more < corner_steps.size(); ++more) {
    const Corners& found = corners(more);
    std::vector<Point3> points = found.points;
    // The triangles of a quad begin at either diagonal.
    for (std::size_t first = 0; first < points.size() - 2; ++first) {
      const std::optional<int> crossed = crossings(from, along, end, points, std::max(error, found.size));
      if (crossed) {
        text += "corners";
        append_words(text, found.steps, first);
        text += '\n';
        return crossed;
      }
      std::rotate(points.begin(), points.begin() + 1, points.end());
    }
    if (found.size < error) break;  // no step makes it surer
  }
  return std::nullopt;
}

}  // namespace snug
