#include <snug/certificate/winding.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <snug/certificate/disc.h>
#include <snug/certificate/text.h>
#include <support/point.h>

namespace snug {
namespace {

constexpr std::size_t max_leaves = 5'000;  // along one half-line
constexpr std::size_t random_directions = 10;

// The shortest ways out of a box, and some others, none of which is along an axis.
std::vector<Vector3> ways_out(const Point3& from, const Box3& of) {
  std::vector<std::pair<double, Vector3>> ways;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Vector3 way{0.0625, 0.046875, 0.03125};
      way[axis] = sign;
      ways.emplace_back(sign < 0 ? from[axis] - of.lower[axis] : of.upper[axis] - from[axis], way);
    }
  }
  std::stable_sort(ways.begin(), ways.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Vector3> directions;
  for (const auto& [distance, way] : ways) directions.push_back(way);
  std::minstd_rand random;
  const auto number = [&] { return static_cast<double>(random() % 2048) / 1024 - 1; };
  for (std::size_t i = 0; i < random_directions; ++i) {
    const Vector3 way{number(), number(), number()};
    if (length_sq(way) > 0.0625) directions.push_back(way);
  }
  return directions;
}

// That a piece crosses a half-line so many times, by sign.
std::optional<int> append_crossing(std::string& text, NetRange& piece, const Motion& pose,
                                   const HalfLine& line, double magnitude, double error) {
  Disc disc(piece.only(0), pose);
  if (!disc.is_simple()) return std::nullopt;
  std::string proof = "x";
  Disc::append_steps_of_hull(proof);
  Vector3 hint;
  const auto off_start = separating_direction(disc.hull(), line.from, 0, magnitude, hint);
  if (!off_start) return std::nullopt;
  append_direction(proof, *off_start);
  for (const std::vector<Point3>& border : disc.borders()) {
    Vector3 best;
    const auto w = separating_direction(border, line, magnitude, best);
    if (!w) return std::nullopt;
    Disc::append_border(proof, *w);
  }
  const Point3 middle = line.from.front();
  const auto crossed = disc.append_corners(proof, middle, line.along, nullptr, error);
  if (!crossed || *crossed == 0) return std::nullopt;  // smaller pieces are held off the line at less cost
  text += proof;
  return crossed;
}

}  // namespace

std::optional<WindingProof> winding_proof(const CertifiedSide& surface, const Box3& point, double magnitude,
                                          const WorkMonitor& monitor) {
  const Vector3 sides = point.upper - point.lower;
  HalfLine line{{point.lower + 0.5 * sides}, {}};
  magnitude = std::max(magnitude, surface.magnitude);
  const double error = longest_side(point) + 0x1p-46 * magnitude;
  if (longest_side(point) > 0) {
    const std::vector<Point3> corners = corners_of(point);
    line.from.insert(line.from.end(), corners.begin(), corners.end());
  }
  for (const Vector3& along : ways_out(line.from[0], box_of(surface.pieces->hull(surface.pose)))) {
    line.along = along;
    WindingProof proof{0, {}};
    append_words(proof.text, along.x, along.y, along.z);
    proof.text += '\n';
    CertifiedSide other = side_of(line.from, along);
    other.magnitude = magnitude;
    const auto crossing = [&](std::string& text, NetRange& piece) {
      const auto crossed = append_crossing(text, piece, surface.pose, line, magnitude, error);
      if (crossed) proof.number += *crossed;
      return crossed.has_value();
    };
    if (append_separation(proof.text, {surface, other}, 0, {max_leaves, monitor}, crossing) == Found::proof)
      return proof;
  }
  return std::nullopt;
}

}  // namespace snug
