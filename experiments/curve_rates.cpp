#include <experiments/curve_rates.h>

#include <algorithm>
#include <array>
#include <random>

#include <experiments/quantile.h>
#include <snug/bounds/enclosure.h>
#include <snug/surface/curve_set.h>
#include <support/error.h>
#include <support/names.h>

namespace snug {
namespace {

constexpr std::array all_degrees{CurveDegree::quadratic, CurveDegree::cubic};
constexpr std::array all_places{CurvePlace::closed, CurvePlace::inner, CurvePlace::end};
constexpr std::array measures{ThicknessMeasure::radius, ThicknessMeasure::interval};

// Vertices at distances of about 1 on a random cubic curve; closed or open.
ControlMesh polyline_on_cubic(bool closed, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto even = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  const Vector3 bend{even(), even(), even()}, twist{even(), even(), even()};
  ControlMesh mesh;
  std::vector<VertexId> line;
  for (int i = 0; i < 7; ++i) {
    const double s = i - 3;
    mesh.points.push_back(Point3{s, 0, 0} + (0.1 * s * s) * bend + (0.03 * s * s * s) * twist);
    line.emplace_back(static_cast<std::size_t>(i));
  }
  if (closed) line.push_back(line.front());
  mesh.add_polyline(line);
  return mesh;
}

std::array<Thicknesses, 2> thicknesses(const CurveSet& curves, EdgeId edge, unsigned levels) {
  const PowerOfTwo back = curves.edges().scale().inverse();
  CurvePiece piece = curves.edges().piece(edge);
  std::array<Thicknesses, 2> result;
  BoundingPoints points;
  for (unsigned level = 0; level <= levels; ++level, piece = split(piece, 0)) {
    bounding_points(piece, points);
    const std::array<RelativePoint, 2> limits = limit_ends(piece);
    const std::array<Vector3, 2> ends{limits[0].relative, limits[1].relative};
    const OffsetSegment offset = offset_segment(points, ends);
    const std::array<double, 2> value{offset.radius, thickness(interval_simplex<2>(points, ends))};
    for (std::size_t m = 0; m < 2; ++m) {
      const bool ended = result[m].size() < level;
      if (!ended && value[m] > 1000 * offset.rounding) result[m].push_back(back.apply(value[m]));
    }
  }
  return result;
}

// A curve's radius is its curvature times the square of the length. At an open end there is no curvature:
// what is left is the third derivative for degree 3, and nothing for degree 2.
double expected_factor(CurveDegree degree, CurvePlace place) {
  if (place != CurvePlace::end) return 0.25;
  return degree == CurveDegree::cubic ? 0.125 : 0;
}

}  // namespace

constexpr auto curve_place_names = std::to_array<Named<CurvePlace>>(
    {{"closed", CurvePlace::closed}, {"inner", CurvePlace::inner}, {"end", CurvePlace::end}});

const char* name_of(CurvePlace place) { return name_in(curve_place_names, place); }

std::vector<CurveRateRow> measure_curve_rates(const RateOptions& options, const WorkMonitor& monitor) {
  require_value(options.nets >= 1 && options.levels >= 4 && options.levels <= PiecePath::max_level,
                "rates: give at least one net, and 4 to 60 levels");
  std::vector<CurveRateRow> rows;
  for (const CurveDegree degree : all_degrees) {
    for (const CurvePlace place : all_places) {
      monitor.report(static_cast<double>(rows.size()) / 12);
      std::vector<std::array<Thicknesses, 2>> all;
      for (std::size_t net = 0; net < options.nets; ++net) {
        const CurveSet curves(polyline_on_cubic(place == CurvePlace::closed, options.seed + net), degree);
        all.push_back(thicknesses(curves, EdgeId(place == CurvePlace::end ? 0 : 2), options.levels));
      }
      for (std::size_t m = 0; m < measures.size(); ++m) {
        CurveRateRow row{degree, place, measures[m], {}, {}, expected_factor(degree, place)};
        std::size_t levels = options.levels + 1;
        for (const auto& net : all) levels = std::min(levels, net[m].size());
        for (std::size_t level = 0; level < levels; ++level) {
          std::vector<double> values;
          for (const auto& net : all) values.push_back(net[m][level]);
          row.thickness.push_back(quantile(std::move(values), 0.5));
        }
        if (levels >= 3) row.factor = fitted_factor(row.thickness);
        rows.push_back(std::move(row));
      }
    }
  }
  return rows;
}

}  // namespace snug
