#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <snug/search/piece_set.h>

namespace snug {

/// Marked triangles by boxes around them, and around some in a row, which mostly lie together.
class FacetRows {
 public:
  /// `corners(t)`: of triangle t. Boxes are larger than the triangles by `growth` times their longest sides.
  /// Requires:  the marks, and what `corners` reads, outlive it; coordinates of at most about 2.
  template <class CornersOf>
  FacetRows(std::span<const std::uint8_t> marks, double growth, const CornersOf& corners)
      : marks_(marks), growth_(growth), corners_(corners), rows_((marks.size() + row - 1) / row) {
    for (std::size_t t = 0; t < marks.size(); ++t) {
      if (marks[t] != 0) rows_[t / row].add(box(t));
    }
  }
  /// Does a row meet the box?
  [[nodiscard]] bool meet(const Box3& box) const {
    return std::any_of(rows_.begin(), rows_.end(), [&](const Box3& r) { return overlap(r, box); });
  }
  /// Calls visit(t) for each whose box meets it, in their order.
  template <class Visit>
  void visit(const Box3& box, const Visit& visit) const {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      if (!overlap(rows_[r], box)) continue;
      for (std::size_t t = r * row; t < std::min(marks_.size(), (r + 1) * row); ++t) {
        if (marks_[t] != 0 && overlap(this->box(t), box)) visit(t);
      }
    }
  }

 private:
  static constexpr std::size_t row = 64;

  [[nodiscard]] Box3 box(std::size_t t) const {
    Box3 box;
    for (const Point3& p : corners_(t)) box.add(p);
    const double more = growth_ * longest_side(box);
    for (std::size_t k = 0; k < 3; ++k) {
      box.lower[k] -= more;
      box.upper[k] += more;
    }
    return box;
  }

  std::span<const std::uint8_t> marks_;
  double growth_;
  std::function<Triangle(std::size_t)> corners_;
  std::vector<Box3> rows_;
};

}  // namespace snug
