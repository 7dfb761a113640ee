#include <snug/io/weld.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <snug/base/contract.h>
#include <snug/base/error.h>

namespace snug {
namespace {

using Key = std::array<std::int64_t, 3>;

struct PlacedPoint {
  Point3 place;
  std::uint32_t number;
};

std::vector<std::uint32_t> first_of_equal(std::span<const Point3> points) {
  std::vector<PlacedPoint> sorted;
  sorted.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) sorted.push_back({points[i], i});
  std::sort(sorted.begin(), sorted.end(), [](const PlacedPoint& a, const PlacedPoint& b) {
    if (a.place.x != b.place.x) return a.place.x < b.place.x;
    if (a.place.y != b.place.y) return a.place.y < b.place.y;
    if (a.place.z != b.place.z) return a.place.z < b.place.z;
    return a.number < b.number;
  });
  std::vector<std::uint32_t> first(points.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool same = i > 0 && sorted[i].place == sorted[i - 1].place;
    first[sorted[i].number] = same ? first[sorted[i - 1].number] : sorted[i].number;
  }
  return first;
}

/// Points in cells whose diagonal is shorter than the distance, so that those of one cell weld unseen.
class Grid {
 public:
  Grid(std::span<const Point3> points, std::vector<std::uint32_t> first, double distance)
      : points_(points), parent_(std::move(first)), distance_(distance) {
    std::vector<CellPoint> sorted;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (parent_[i] == i) sorted.push_back({key_of(points[i]), i});
    }
    std::sort(sorted.begin(), sorted.end(), [](const CellPoint& a, const CellPoint& b) {
      return a.cell != b.cell ? a.cell < b.cell : a.number < b.number;
    });
    for (const CellPoint& point : sorted) {
      if (cells_.empty() || cells_.back().key != point.cell)
        cells_.push_back({point.cell, members_.size(), 0});
      members_.push_back(point.number);
      cells_.back().end = members_.size();
      unite(members_[cells_.back().begin], point.number);
    }
  }

  std::vector<std::uint32_t> weld() {
    // Half of the offsets (i, j): each pair of cells is met once. Cells that weld are at most two apart, since
    // the distance is 1.96 cells.
    for (std::int64_t i = 0; i <= 2; ++i) {
      for (std::int64_t j = i == 0 ? 0 : -2; j <= 2; ++j) weld_across(i, j);
    }
    for (std::uint32_t p = 0; p < parent_.size(); ++p) parent_[p] = root(p);
    return std::move(parent_);
  }

 private:
  struct CellPoint {
    Key cell;
    std::uint32_t number;
  };
  struct Cell {
    Key key;
    std::size_t begin, end;
  };

  [[nodiscard]] Key key_of(const Point3& point) const {
    Key key{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      key[axis] = static_cast<std::int64_t>(std::floor(point[axis] / (0.51 * distance_)));
    }
    return key;
  }

  /// Cells are sorted, so the cells at a fixed offset from one another are found by walking along once.
  void weld_across(std::int64_t i, std::int64_t j) {
    const bool own_row = i == 0 && j == 0;
    std::size_t first = 0;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const Key& key = cells_[c].key;
      const Key low{key[0] + i, key[1] + j, key[2] + (own_row ? 1 : -2)};
      const Key high{key[0] + i, key[1] + j, key[2] + 2};
      while (first < cells_.size() && cells_[first].key < low) ++first;
      for (std::size_t other = first; other < cells_.size() && cells_[other].key <= high; ++other) {
        weld_cells(cells_[c], cells_[other]);
      }
    }
  }

  void weld_cells(const Cell& a, const Cell& b) {
    if (root(members_[a.begin]) == root(members_[b.begin])) return;
    for (std::size_t p = a.begin; p < a.end; ++p) {
      for (std::size_t q = b.begin; q < b.end; ++q) {
        const Vector3 between = points_[members_[p]] - points_[members_[q]];
        if (std::hypot(between.x, between.y, between.z) <= distance_) {
          unite(members_[p], members_[q]);
          return;
        }
      }
    }
  }

  std::uint32_t root(std::uint32_t p) {
    while (parent_[p] != p) {
      parent_[p] = parent_[parent_[p]];
      p = parent_[p];
    }
    return p;
  }

  void unite(std::uint32_t p, std::uint32_t q) {
    const auto [first, second] = std::minmax({root(p), root(q)});
    parent_[second] = first;
  }

  std::span<const Point3> points_;
  std::vector<std::uint32_t> parent_;
  double distance_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> members_;
};

}  // namespace

std::vector<std::uint32_t> first_of_welded(std::span<const Point3> points, double distance) {
  SNUG_EXPECT(distance >= 0 && std::isfinite(distance));
  SNUG_EXPECT(points.size() < UINT32_MAX);
  double largest = 0;
  for (const Point3& point : points) {
    SNUG_EXPECT(is_finite(point));
    largest = std::max(largest, max_abs(point - Point3{}));
  }
  std::vector<std::uint32_t> first = first_of_equal(points);
  if (distance == 0) return first;
  // So that cells have whole numbers that are exact, and neighbours of them.
  if (!(distance >= std::ldexp(largest, -40)) || 0.51 * distance < std::ldexp(1.0, -1000)) {
    throw InputError(InputProblem::refused,
                     "the distance of welding is too small beside the coordinates: give a larger one");
  }
  return Grid(points, std::move(first), distance).weld();
}

}  // namespace snug
