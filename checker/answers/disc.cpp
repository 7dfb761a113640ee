#include "disc.h"

namespace answers {
namespace {

constexpr Index max_finer = 5;

int sign_of(const Real& x) {
  return x.certainly_positive() ? 1 : (Real(0.0) - x).certainly_positive() ? -1 : 0;
}

int sign_of_determinant(const Point& a, const Point& b, const Point& c) {
  return sign_of(
      dot(a, {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]}));
}

}  // namespace

Hull read_finer(Words& words, PieceSet& piece) {
  PieceSet* set = &piece;
  for (Index left = words.count(max_finer); left > 0; --left) set = &set->finer();
  return copy_of(set->hull());
}

Point between(const Point& a, const Point& b) { return {b[0] - a[0], b[1] - a[1], b[2] - a[2]}; }

Disc::Disc(Words& words, std::unique_ptr<PieceSet> piece, const Pose& pose)
    : piece_(std::move(piece)), pose_(pose) {
  const Net& net = piece_->net();
  const Rules& rules = piece_->rules();
  const Index owner = piece_->owners()[0];
  corners_ = rules.dual() ? net.at_vertex[net.vertex(owner)].size() : net.faces[owner].size();
  if (corners_ != (rules.triangles() ? 3 : 4)) words.refuse("a piece without four corners");
}

// Side k of a piece is that of two of its children, at both its ends.
std::vector<Disc::BorderPiece> Disc::finer(const std::vector<BorderPiece>& curve) {
  std::vector<BorderPiece> halves;
  for (const auto& [piece, side] : curve) {
    PieceSet& children = piece->finer();
    const bool dual = children.rules().dual();
    const Index corners = children.rules().triangles() ? 3 : 4;
    const auto k = static_cast<Index>(side);
    halves.push_back({children.only(k), dual ? 0 : k});
    halves.push_back({children.only((k + 1) % corners), dual ? 3 : k});
  }
  return halves;
}

Hull Disc::read_border(Words& words, std::size_t k) {
  curve_.clear();
  curve_.push_back({piece_->only(0), k});
  words.expect("border");
  for (Index left = words.count(max_finer); left > 0; --left) curve_ = finer(curve_);
  Hull hull;
  for (const auto& [piece, side] : curve_)
    hull.insert(hull.end(), piece->hull().begin(), piece->hull().end());
  return hull;
}

std::vector<Point> Disc::read_corners(Words& words) const {
  words.expect("corners");
  const Index depth = words.count(200), first = words.count(1);
  std::vector<Point> corners;
  for (std::size_t i = 0; i < corners_; ++i) {
    const auto k = static_cast<Index>((first + i) % corners_);
    std::unique_ptr<PieceSet> near = piece_->only(0);
    for (Index step = 0; step < depth; ++step) {
      near = near->finer().only(near->rules().dual() && step > 0 ? 0 : k);
    }
    corners.push_back(enclosing_box(*near, pose_));
  }
  return corners;
}

std::optional<int> crossings(const Point& from, const Point& along, const Point* end,
                             std::span<const Point> corners) {
  int crossed = 0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const std::array<const Point*, 3> c{&corners[0], &corners[k], &corners[k + 1]};
    const auto seen = [&](const Point& p) {
      return std::array{between(p, *c[0]), between(p, *c[1]), between(p, *c[2])};
    };
    const auto from_here = seen(from);
    std::array<int, 3> turns{};
    for (std::size_t i = 0; i < 3; ++i)
      turns[i] = sign_of_determinant(along, from_here[i], from_here[(i + 1) % 3]);
    if (turns[0] == 0 || turns[1] == 0 || turns[2] == 0) return std::nullopt;
    if (turns[0] != turns[1] || turns[1] != turns[2]) continue;  // the line misses this triangle
    // Of a point in front of the triangle the determinant is below 0.
    const auto side_of = [&](const Point& p) {
      const auto at = seen(p);
      return sign_of_determinant(at[0], at[1], at[2]);
    };
    const int before = side_of(from), after = end ? side_of(*end) : -turns[0];
    if (before == 0 || after == 0) return std::nullopt;
    if (before != after) crossed += before;
  }
  return crossed;
}

}  // namespace answers
