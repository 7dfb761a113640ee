#include <snug/bounds/invariant_layout.h>

#include <algorithm>
#include <cmath>

namespace snug {
namespace {

// A corner's quarter of a kind that comes again there.
const KindChild* again_at_a_corner(const Kind& kind) {
  const KindChild* found = nullptr;
  for (const KindChild& child : kind.children()) {
    bool regular = true;
    for (std::size_t i = 0; i < 3; ++i) regular = regular && child.kind->regular_corner(i);
    if (regular) continue;
    if (found || child.kind != &kind) return nullptr;
    found = &child;
  }
  return found;
}

std::array<LayoutPoint, 3> limits_of(const Kind& kind, const std::vector<LayoutPoint>& layout) {
  std::array<LayoutPoint, 3> limits{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Stencils::Row row = kind.corner_limits().row(k);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      for (std::size_t a = 0; a < 2; ++a) limits[k][a] += row.weights[i] * layout[row.sources[i]][a];
    }
  }
  return limits;
}

// The affine map that takes three places to (0, 0), (1, 0), (0, 1). None: they are on a line.
bool normalise(const std::array<LayoutPoint, 3>& corners, std::vector<LayoutPoint>& layout) {
  const auto [o, p, q] = corners;
  const double a = p[0] - o[0], b = q[0] - o[0], c = p[1] - o[1], d = q[1] - o[1], det = a * d - b * c;
  if (!(std::fabs(det) > 1e-9 * (std::fabs(a * d) + std::fabs(b * c)))) return false;
  for (LayoutPoint& at : layout) {
    const double x = at[0] - o[0], y = at[1] - o[1];
    at = {(d * x - b * y) / det, (a * y - c * x) / det};
  }
  return true;
}

// A square matrix, row by row.
struct Matrix {
  explicit Matrix(std::size_t n) : size(n), entries(n * n, 0.0) {}
  double* operator[](std::size_t row) { return entries.data() + row * size; }
  std::size_t size;
  std::vector<double> entries;
};

// A x = b by elimination; x is written over b.
void solve(Matrix a, std::vector<double>& b) {
  const std::size_t n = a.size;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t r = k + 1; r < n; ++r) {
      if (std::fabs(a[r][k]) > std::fabs(a[pivot][k])) pivot = r;
    }
    std::swap_ranges(a[k], a[k] + n, a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t r = k + 1; r < n; ++r) {
      if (a[r][k] == 0) continue;
      const double factor = a[r][k] / a[k][k];
      for (std::size_t c = k; c < n; ++c) a[r][c] -= factor * a[k][c];
      b[r] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t c = k + 1; c < n; ++c) b[k] -= a[k][c] * b[c];
    b[k] /= a[k][k];
  }
}

// The eigenvalue of a left eigenvector.
double eigenvalue_of(const Stencils::Row& left, const Stencils& step) {
  std::vector<double> x(step.row_count(), 0.0), image(step.row_count(), 0.0);
  for (std::size_t i = 0; i < left.sources.size(); ++i) {
    x[left.sources[i]] += left.weights[i];
    const Stencils::Row row = step.row(left.sources[i]);
    for (std::size_t c = 0; c < row.sources.size(); ++c) {
      image[row.sources[c]] += left.weights[i] * row.weights[c];
    }
  }
  std::size_t largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::fabs(x[i]) > std::fabs(x[largest])) largest = i;
  }
  return image[largest] / x[largest];
}

// Right eigenvectors of a matrix S to an eigenvalue, or what the square of S - eigenvalue takes to zero
// where S has too few of them: what x has of those, by inverse iteration with that square.
void project_on_eigenvectors(const Stencils& step, double eigenvalue, std::vector<double>& x) {
  const std::size_t n = step.row_count();
  Matrix square(n);
  for (std::size_t r = 0; r < n; ++r) {
    const auto add = [&](std::size_t through, double weight) {
      const Stencils::Row row = step.row(through);
      for (std::size_t i = 0; i < row.sources.size(); ++i)
        square[r][row.sources[i]] += weight * row.weights[i];
      square[r][through] -= weight * eigenvalue;
    };
    const Stencils::Row row = step.row(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i) add(row.sources[i], row.weights[i]);
    add(r, -eigenvalue);
    square[r][r] += 1e-10;
  }
  for (int iteration = 0; iteration < 2; ++iteration) {
    solve(square, x);
    double size = 0;
    for (const double value : x) size = std::max(size, std::fabs(value));
    for (double& value : x) value /= size;
  }
}

}  // namespace

std::vector<LayoutPoint> invariant_layout(const Kind& kind) {
  const KindChild* const again = again_at_a_corner(kind);
  if (!again) return {};
  std::size_t corner = 0;
  while (kind.regular_corner(corner)) ++corner;
  // A fair layout has little of other eigenvectors to the same eigenvalues. Of its coordinates the one that
  // the tangent sees most of.
  const std::vector<LayoutPoint> start = make_layout(kind);
  std::vector<LayoutPoint> layout(start.size());
  const Stencils step = again->stencils();
  for (std::size_t a = 0; a < 2; ++a) {
    const Stencils::Row tangent = kind.corner_tangents().row(2 * corner + a);
    LayoutPoint seen{0, 0};
    for (std::size_t i = 0; i < tangent.sources.size(); ++i) {
      for (std::size_t k = 0; k < 2; ++k) seen[k] += tangent.weights[i] * start[tangent.sources[i]][k];
    }
    std::vector<double> x;
    for (const LayoutPoint& at : start) x.push_back(seen[0] * at[0] + seen[1] * at[1]);
    project_on_eigenvectors(step, eigenvalue_of(tangent, step), x);
    for (std::size_t i = 0; i < x.size(); ++i) layout[i][a] = x[i];
  }
  if (!normalise(limits_of(kind, layout), layout)) return {};
  // Far from a fan of faces: eigenvectors that rounding made.
  const bool sane = std::all_of(layout.begin(), layout.end(), [](const LayoutPoint& at) {
    return std::fabs(at[0]) < 1e3 && std::fabs(at[1]) < 1e3;
  });
  return sane ? layout : std::vector<LayoutPoint>{};
}

std::vector<LayoutPoint> tip_layout(const Kind& kind) {
  std::vector<LayoutPoint> layout = invariant_layout(kind);
  if (layout.empty()) return make_layout(kind);
  if (!laid_by_rings(kind.key())) return layout;
  if (!normalise({layout[0], layout[1], layout[2]}, layout)) return make_layout(kind);
  layout[0] = {0, 0}, layout[1] = {1, 0}, layout[2] = {0, 1};
  return layout;
}

}  // namespace snug
