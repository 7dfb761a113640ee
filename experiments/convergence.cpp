#include <experiments/convergence.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <experiments/eigenvalues.h>
#include <experiments/quantile.h>
#include <snug/bounds/enclosure.h>
#include <snug/bounds/table_triangle.h>
#include <snug/patch/evaluate.h>
#include <support/error.h>
#include <support/names.h>
#include <support/parallel.h>

namespace snug {
namespace {

// Axes of which the third is a normal.
struct Frame {
  Vector3 one, two, normal;
  explicit Frame(const Vector3& n) : normal(n) {
    const Vector3 other = std::fabs(n.x) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
    one = cross(n, other);
    one = (1 / length(one)) * one;
    two = cross(n, one);
  }
  [[nodiscard]] Vector3 turned(const Vector3& v) const { return {dot(one, v), dot(two, v), dot(normal, v)}; }
};

// The patch in other axes about its origin. Its error is not carried over: what comes of it is no bound.
Patch turned(const Patch& patch, const Frame& frame) {
  Patch result = patch;
  result.origin = {};
  result.largest = 0;
  for (Vector3& p : result.points) {
    p = frame.turned(p);
    result.largest = std::max(result.largest, max_abs(p));
  }
  return result;
}

struct PieceThickness {
  std::array<double, 3> value;  // a ThicknessMeasure
  double rounding;
};

PieceThickness by_rows(BoundsCache& library, const Patch& patch, const Vector3& normal,
                       BoundingPoints& points) {
  bounding_points(library, patch, points);
  const std::array<Vector3, 3> corners = limit_corners(patch);
  const OffsetTriangle offset = offset_triangle(library, points, corners);
  const Slab slab = outer_slab(points, normal);
  return {{offset.radius, thickness(interval_simplex(points, corners)), slab.upper - slab.lower},
          offset.rounding};
}

PieceThickness by_table(const BoundTable& table, const Patch& patch, const Vector3& normal) {
  const TableTriangle triangle = table_triangle(table, patch);
  const OffsetTriangle offset = offset_triangle(triangle);
  double lower = INFINITY, upper = -INFINITY;
  for (const Box3& box : table_triangle(table, turned(patch, Frame(normal))).interval.corner) {
    lower = std::min(lower, box.lower.z);
    upper = std::max(upper, box.upper.z);
  }
  return {{offset.radius, thickness(triangle.interval), upper - lower}, offset.rounding};
}

// d_i: a control point's distance from the linear function through the first three, or through the corners' limits.
Vector3 difference_from_linear(const BoundTable& table, const Patch& patch, std::size_t i) {
  std::array<Vector3, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = table.first_bounded() > 0 ? patch.points[k]
                                          : patch.kind->corner_limits().apply<Vector3>(k, patch.points);
  }
  const LayoutPoint& u = table.layout[i];
  return patch.points[i] - (corner[0] + u[0] * (corner[1] - corner[0]) + u[1] * (corner[2] - corner[0]));
}

// Of the tangent plane inside the mesh.
double subdominant_of(Scheme scheme, std::size_t n) {
  return rules_of(scheme).shrink_factor({0, static_cast<std::uint16_t>(n - 1)});
}

LargestEigenvalues catmark_eigenvalues(std::size_t n) {
  // The Fourier block of index 0 has two eigenvalues beside 1, of sum 3/4 - 7/(4n) and product (1 - 3/n)/16;
  // the larger of index 2 is found as that of index 1.
  const auto valence = static_cast<double>(n);
  const double sum = 0.75 - 1.75 / valence, product = (1 - 3 / valence) / 16;
  const double symmetric = (sum + std::sqrt(sum * sum - 4 * product)) / 2;
  const double subdominant = subdominant_of(Scheme::catmark, n);
  if (n == 3) return {subdominant, subdominant, symmetric};
  const double c = std::cos(4 * std::numbers::pi / valence);
  return {subdominant, subdominant, std::max(symmetric, (5 + c + std::sqrt((1 + c) * (9 + c))) / 16)};
}

LargestEigenvalues midedge_eigenvalues(std::size_t n) {
  // 1/4 comes with the next ring of quads.
  const double c = n == 3 ? -1 : std::cos(4 * std::numbers::pi / static_cast<double>(n));
  const double subdominant = subdominant_of(Scheme::midedge, n);
  return {subdominant, subdominant, std::max(0.25, 0.5 + 0.5 * c)};
}

std::span<const BoundSource> sources_of(Scheme scheme, NetCentre centre) {
  const std::span<const BoundSource> all = all_bound_sources;
  return scheme == Scheme::loop && centre == NetCentre::interior ? all : all.first(2);
}

std::vector<NetPlace> places_of(Scheme scheme, NetCentre centre) {
  std::vector<NetPlace> places;
  if (centre == NetCentre::semi_sharp) {
    const std::size_t regular = rules_of(scheme).regular_valence;
    for (const double sharpness : experiment_sharpnesses) places.push_back({centre, regular, sharpness});
  } else if (centre == NetCentre::interior) {
    for (const std::size_t n : experiment_valences) {
      if (scheme == Scheme::loop || n <= 12) places.push_back({centre, n});
    }
  } else {
    const bool open = centre == NetCentre::boundary || centre == NetCentre::corner;
    for (std::size_t n = open ? 1 : 3; n <= 12; ++n) places.push_back({centre, n});
  }
  return places;
}

// Are basis functions near the middle those of a lattice, or of one with a crease that ends?
bool is_regular(Scheme scheme, const NetPlace& place) {
  const std::size_t n = place.faces, whole = rules_of(scheme).regular_valence;
  switch (place.centre) {
    case NetCentre::boundary:
      return n == whole / 2;
    case NetCentre::crease:
      return n / 2 == whole / 2;
    case NetCentre::corner:
      return n == 1;
    default:
      return n == whole;
  }
}

LimitSurface net_surface(Scheme scheme, const NetPlace& place, std::uint64_t seed,
                         const std::shared_ptr<BoundsCache>& library) {
  ControlMesh net = bent_net(scheme, place, seed);
  SchemeOptions rules;
  rules.scheme = scheme;
  rules.boundary = net.tags.boundary.value_or(rules.boundary);
  return {std::move(net), rules, library};
}

PatchId first_patch(const LimitSurface& surface) { return PatchId(surface.patches_of(0).begin); }

}  // namespace

LargestEigenvalues corner_eigenvalues(std::size_t n, Scheme scheme) {
  require_value(n >= 3, "eigenvalues: a valence is at least 3");
  if (scheme == Scheme::catmark) return catmark_eigenvalues(n);
  if (scheme == Scheme::doo_sabin) return {subdominant_of(scheme, n), subdominant_of(scheme, n), 0.25};
  if (scheme == Scheme::midedge) return midedge_eigenvalues(n);
  const double subdominant = subdominant_of(scheme, n);
  if (n == 3) return {subdominant, subdominant, 0.125};  // the Fourier block of index 2 is that of index 1
  // cos 2x = 2 cos(x)^2 - 1
  const double c = 4 * subdominant - 1.5;
  return {subdominant, subdominant, std::max(subdominant * subdominant, 0.375 + 0.25 * (2 * c * c - 1))};
}

LargestEigenvalues corner_eigenvalues(Scheme scheme, const NetPlace& place) {
  if (place.centre == NetCentre::interior) return corner_eigenvalues(place.faces, scheme);
  const LimitSurface surface = net_surface(scheme, place, 1, std::make_shared<BoundsCache>());
  const std::vector<double> sizes = eigenvalue_sizes(corner_matrix(surface.patch(first_patch(surface))));
  return {sizes[1], sizes[2], sizes[3]};
}

constexpr auto thickness_measure_names =
    std::to_array<Named<ThicknessMeasure>>({{"radius", ThicknessMeasure::radius},
                                            {"interval", ThicknessMeasure::interval},
                                            {"normal", ThicknessMeasure::normal}});

const char* name_of(ThicknessMeasure measure) { return name_in(thickness_measure_names, measure); }

std::array<Thicknesses, 3> corner_thicknesses(const LimitSurface& surface, PatchId p, LayoutTables& tables,
                                              BoundSource source, unsigned levels) {
  require_value(levels <= PiecePath::max_level, "thicknesses: there are too many levels; give at most 60");
  Patch patch = surface.patch(p);
  const std::optional<Vector3> normal = limit_frame(patch, TriangleParameter{0, 0}).normal;
  const PowerOfTwo back = surface.scale().inverse();
  std::array<Thicknesses, 3> result;
  BoundingPoints points;
  for (unsigned level = 0;; ++level) {
    const Vector3 across = normal.value_or(Vector3{0, 0, 1});
    const PieceThickness piece = source == BoundSource::rows
                                     ? by_rows(tables.library(), patch, across, points)
                                     : by_table(tables.get(*patch.kind, source), patch, across);
    for (std::size_t m = 0; m < (normal ? 3 : 2); ++m) {
      const bool ended = result[m].size() < level;
      if (!ended && piece.value[m] > 1000 * piece.rounding) result[m].push_back(back.apply(piece.value[m]));
    }
    if (level == levels) return result;
    patch = split(patch, 0);
  }
}

LemmaTwelve lemma_twelve(const LimitSurface& surface, PatchId p, LayoutTables& tables, BoundSource source,
                         unsigned levels) {
  Patch patch = surface.patch(p);
  const PowerOfTwo back = surface.scale().inverse();
  LemmaTwelve result;
  for (unsigned level = 0;; ++level) {
    const BoundTable& table = tables.get(*patch.kind, source);
    double gap = 0;
    for (std::size_t i = 0; i < table.lower.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) gap = std::max(gap, table.upper[i][k] - table.lower[i][k]);
    }
    Vector3 sum{};
    for (std::size_t i = table.first_bounded(); i < patch.points.size(); ++i) {
      const Vector3 d = difference_from_linear(table, patch, i);
      for (std::size_t a = 0; a < 3; ++a) sum[a] += std::fabs(d[a]);
    }
    result.gap = std::max(result.gap, gap);
    result.bound.push_back(back.apply(gap * max_abs(sum)));
    if (level == levels) return result;
    patch = split(patch, 0);
  }
}

double fitted_factor(std::span<const double> values) {
  require_value(values.size() >= 3, "fitted factor: give at least three values");
  const std::size_t first = values.size() / 2;
  const auto count = static_cast<double>(values.size() - first);
  const double middle = (count - 1) / 2;
  double sum = 0, squares = 0;
  for (std::size_t i = first; i < values.size(); ++i) {
    const double x = static_cast<double>(i - first) - middle;
    sum += x * std::log(values[i]);
    squares += x * x;
  }
  return std::exp(sum / squares);
}

double expected_factor(std::size_t n, BoundSource source, ThicknessMeasure measure, Scheme scheme) {
  const LargestEigenvalues eigenvalues = corner_eigenvalues(n, scheme);
  if (scheme != Scheme::loop) {
    // Bounding rows: below valence 4 the limit leaves the triangle of its corners sideways. The fair layout of
    // tables is that of the characteristic map at regular corners alone.
    const bool vanishes =
        measure == ThicknessMeasure::normal || n == 4 || (source == BoundSource::rows && n > 4);
    return vanishes ? eigenvalues.next : eigenvalues.subdominant;
  }
  // Bounding rows: below valence 6 the limit leaves the triangle of its corners sideways.
  const bool affine_part_vanishes = n == 6 || measure == ThicknessMeasure::normal ||
                                    source == BoundSource::characteristic ||
                                    (source == BoundSource::rows && n > 6);
  return affine_part_vanishes ? eigenvalues.next : eigenvalues.subdominant;
}

double expected_factor(Scheme scheme, const NetPlace& place, BoundSource source, ThicknessMeasure measure) {
  if (place.centre == NetCentre::interior) return expected_factor(place.faces, source, measure, scheme);
  const LargestEigenvalues eigenvalues = corner_eigenvalues(scheme, place);
  if (is_regular(scheme, place)) return eigenvalues.next;
  const std::size_t n = place.faces;
  if (measure == ThicknessMeasure::normal) {
    // The normal is that of the directions along, which shrinks by 1/2, and across: not the two slowest ones
    // if two are slower than 1/2.
    const bool slow = place.centre != NetCentre::dart && eigenvalues.second > 0.5 + 1e-6;
    return slow ? eigenvalues.second : eigenvalues.next;
  }
  if (source != BoundSource::rows) {
    // Beside a boundary curve with few faces the layout has the slow direction, which is that of the curve.
    const bool few =
        (place.centre == NetCentre::boundary && n < 3) || (place.centre == NetCentre::crease && n < 6);
    return few ? eigenvalues.second : eigenvalues.subdominant;
  }
  // Here alone the limit stays in the triangle of its corners.
  const bool inside = (scheme == Scheme::loop && place == NetPlace{NetCentre::corner, 2}) ||
                      (scheme == Scheme::catmark && place == NetPlace{NetCentre::dart, 3});
  return inside ? eigenvalues.next : eigenvalues.second;
}

std::vector<RateRow> measure_rates(const RateOptions& options, const WorkMonitor& monitor) {
  require_value(options.nets >= 1 && options.levels >= 4 && options.levels <= PiecePath::max_level,
                "rates: give at least one net, and 4 to 60 levels");
  require_value(rules_of(options.scheme).primal || options.centre == NetCentre::interior,
                "rates: nets of dual schemes have an inner centre; give NetCentre::interior");
  const auto library = std::make_shared<BoundsCache>();
  LayoutTables tables(*library);
  std::vector<RateRow> rows;
  const std::span<const BoundSource> sources = sources_of(options.scheme, options.centre);
  const std::vector<NetPlace> places = places_of(options.scheme, options.centre);
  for (std::size_t i = 0; i < places.size(); ++i) {
    monitor.report(static_cast<double>(i) / static_cast<double>(places.size()));
    // A net, a source, a measure.
    std::vector<std::array<std::array<Thicknesses, 3>, 3>> all(options.nets);
    std::vector<std::array<LemmaTwelve, 3>> lemmas(options.nets);
    parallel_for(options.nets, options.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t net = begin; net < end; ++net) {
        monitor.checkpoint();
        const LimitSurface surface = net_surface(options.scheme, places[i], options.seed + net, library);
        for (std::size_t s = 0; s < sources.size(); ++s) {
          all[net][s] = corner_thicknesses(surface, first_patch(surface), tables, sources[s], options.levels);
          if (sources[s] == BoundSource::rows) continue;
          lemmas[net][s] = lemma_twelve(surface, first_patch(surface), tables, sources[s], options.levels);
        }
      }
    });
    for (std::size_t s = 0; s < sources.size(); ++s) {
      for (std::size_t m = 0; m < all_thickness_measures.size(); ++m) {
        RateRow row{places[i], sources[s], all_thickness_measures[m], {}, 0, 0, {}};
        std::size_t levels = options.levels + 1;
        for (const auto& net : all) levels = std::min(levels, net[s][m].size());
        if (levels == 0) continue;  // no normal
        for (std::size_t level = 0; level < levels; ++level) {
          std::vector<double> values;
          for (const auto& net : all) values.push_back(net[s][m][level]);
          row.thickness.push_back(quantile(std::move(values), 0.5));
          if (row.source == BoundSource::rows || row.measure != ThicknessMeasure::interval) continue;
          std::vector<double> bounds;
          for (const auto& net : lemmas) bounds.push_back(net[s].bound[level]);
          row.lemma.bound.push_back(quantile(std::move(bounds), 0.5));
          row.lemma.gap = lemmas[0][s].gap;
        }
        row.factor = fitted_factor(row.thickness);
        row.expected = expected_factor(options.scheme, row.place, row.source, row.measure);
        rows.push_back(std::move(row));
      }
    }
  }
  return rows;
}

}  // namespace snug
