#include "field_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include <fmt/core.h>
#include <snug/bound.h>
#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/inspect.h>

#include "patch_lattice.h"

namespace snug::command {
namespace {

// Lightness carries the same information as blue and yellow.
Colour ramp(double share) {
  constexpr std::array<Colour, 5> stops{Colour::hex(0x3a2a78), Colour::hex(0x3b6c97), Colour::hex(0x3fa58c),
                                        Colour::hex(0x9fd05a), Colour::hex(0xf8e75b)};
  const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double rest = at - static_cast<double>(i);
  const auto blend = [&](double a, double b) { return a + rest * (b - a); };
  return {blend(stops[i].red, stops[i + 1].red), blend(stops[i].green, stops[i + 1].green),
          blend(stops[i].blue, stops[i + 1].blue)};
}

const Colour grey = Colour::hex(0xc9ced6);

Colour distinct_colour(std::size_t number) {
  // Those of Okabe and Ito, distinct without colour vision.
  constexpr std::array<std::uint32_t, 7> codes{0xe69f00, 0x56b4e9, 0x009e73, 0xf0e442,
                                               0x0072b2, 0xd55e00, 0xcc79a7};
  return Colour::hex(codes[number % codes.size()]);
}

}  // namespace

// A number at the places of a lattice on each patch, linear between them.
struct FieldColours::Field {
  PatchLattice lattice;
  std::vector<double> values;
  std::vector<Colour> colours{};  // in their place, of the patches, where kinds are shown

  [[nodiscard]] double at(const QuickHit& hit) const { return lattice.interpolated(values, hit); }
  // The number that a share of all is below of.
  [[nodiscard]] double quantile(double share, bool absolute) const {
    std::vector<double> sorted = values;
    if (absolute) {
      for (double& x : sorted) x = std::fabs(x);
    }
    const auto which =
        sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), which, sorted.end());
    return *which;
  }
};

namespace {

using Field = FieldColours::Field;

// From the changes of the normal over small steps along u and v.
double mean_curvature(const SurfacePoint& here, const SurfacePoint& along_u, const SurfacePoint& along_v) {
  if (!here.normal || !along_u.normal || !along_v.normal) return 0;
  const Vector3 xu = along_u.point - here.point, xv = along_v.point - here.point,
                nu = *along_u.normal - *here.normal, nv = *along_v.normal - *here.normal;
  const double e = dot(xu, xu), f = dot(xu, xv), g = dot(xv, xv), area = e * g - f * f;
  const double change = dot(nu, xu) * g - (dot(nu, xv) + dot(nv, xu)) * f + dot(nv, xv) * e;
  return area > 0 && std::isfinite(change / area) ? change / (2 * area) : 0;
}

// Small steps from the places of a lattice, towards the middle of the owner.
Field curvatures(const Surface& surface, const Run& run) {
  constexpr double step = 1e-3;
  Field field{PatchLattice(surface, 4), {}};
  const double middle = surface.traits().triangular ? 1.0 / 3 : 0.5;
  const auto ask = [&](const Place& at, std::vector<Place>& asked) {
    Place here = at;
    here.u += 0.01 * (middle - here.u);
    here.v += 0.01 * (middle - here.v);
    Place along_u = here, along_v = here;
    along_u.u += here.u > middle ? -step : step;
    along_v.v += here.v > middle ? -step : step;
    asked.insert(asked.end(), {here, along_u, along_v});
  };
  field.lattice.evaluate(surface, run, ask, [&](std::span<const SurfacePoint> points) {
    for (std::size_t i = 0; i < points.size(); i += 3)
      field.values.push_back(mean_curvature(points[i], points[i + 1], points[i + 2]));
  });
  return field;
}

Field distances(const PlacedSurface& surface, const PlacedSurface& other, const Run& run) {
  Field field{PatchLattice(surface.surface(), 8), {}};
  const Motion to_other = other.pose().inverse() * surface.pose();
  const Precision how{.absolute = 1e-3 * other.surface().size()};
  std::vector<Point3> points;
  field.lattice.evaluate(
      surface.surface(), run, [](const Place& at, std::vector<Place>& asked) { asked.push_back(at); },
      [&](std::span<const SurfacePoint> found) {
        for (const SurfacePoint& x : found) points.push_back(to_other.apply(x.point));
      });
  for (const ClosestPoint& found : closest_point(other.surface(), points, how, run))
    field.values.push_back(found.distance.upper);
  return field;
}

// Of each patch the longest side of its interval triangle's boxes.
Field thicknesses(const Surface& surface, const Run& run) {
  Field field{PatchLattice(surface, 1), {}};
  field.values.resize(field.lattice.patches().size());
  bound(
      surface, {},
      [&](const PatchEnclosure& piece) {
        double& side = field.values[field.lattice.rank(piece.patch)];
        for (const Box3& box : piece.interval.corner) side = std::max(side, longest_side(box));
      },
      run);
  return field;
}

Field kinds(const Surface& surface) {
  Field field{PatchLattice(surface, 1), {}};
  std::map<std::uint32_t, std::size_t> numbers;  // in the order of the patches
  for (const PatchPlace& patch : field.lattice.patches()) {
    const std::optional<std::uint32_t> topology = topology_of(surface, patch);
    field.colours.push_back(
        topology ? distinct_colour(numbers.try_emplace(*topology, numbers.size()).first->second) : grey);
  }
  return field;
}

constexpr double thinnest = 1e-3;  // of the thickest: less is as good as nothing
constexpr double deepest_level = 6;

}  // namespace

void FieldColours::add(const PlacedSurface& surface, const PlacedSurface& other, const Run& run) {
  const auto made = [&]() -> Field {
    if (name_ == "thickness") return thicknesses(surface.surface(), run);
    if (name_ == "kind") return kinds(surface.surface());
    if (name_ == "curvature") return curvatures(surface.surface(), run);
    if (name_ == "distance") return distances(surface, other, run);
    return {PatchLattice(surface.surface(), 1), {}};  // levels are those of hits
  };
  const auto field = std::make_shared<const Field>(made());
  if (!field->values.empty()) {
    const bool curvature = name_ == "curvature";
    const double most = field->quantile(curvature ? 0.95 : 1, curvature);
    const double least = curvature ? -most : field->quantile(0, false);
    const bool first = std::all_of(fields_.begin(), fields_.end(),
                                   [](const auto& earlier) { return earlier->values.empty(); });
    largest_ = first ? most : std::max(largest_, most);
    least_ = first ? least : std::min(least_, least);
  }
  fields_.push_back(field);
}

std::function<Colour(const QuickHit&)> FieldColours::of(std::size_t which) const {
  const std::shared_ptr<const Field> field = fields_[which];
  if (name_ == "level") return [](const QuickHit& hit) { return ramp(hit.level / deepest_level); };
  if (name_ == "kind")
    return [field](const QuickHit& hit) { return field->colours[field->lattice.rank(hit.patch)]; };
  const double least = least_, largest = largest_;
  if (name_ == "thickness") {
    return [field, largest](const QuickHit& hit) {
      const double side = field->values[field->lattice.rank(hit.patch)];
      return ramp(largest > 0 && std::isfinite(largest)
                      ? 1 - std::log10(std::max(side / largest, thinnest)) / std::log10(thinnest)
                      : 0);
    };
  }
  const double middle = name_ == "curvature" ? 0.5 : 0;  // where all is the same
  return [field, least, largest, middle](const QuickHit& hit) {
    return ramp(largest > least ? (field->at(hit) - least) / (largest - least) : middle);
  };
}

ColourBar FieldColours::bar() const {
  const auto text = [](double x) { return fmt::format("{:.3g}", x); };
  if (name_ == "level") return {ramp, "splits", "0", text(deepest_level)};
  if (name_ == "kind") {
    const auto colour = [](double share) {
      return share < 0.3 ? grey : distinct_colour(static_cast<std::size_t>((share - 0.3) / 0.1));
    };
    return {colour, "", "polynomial", "a colour a kind"};
  }
  if (name_ == "thickness") return {ramp, "thickness, log", text(thinnest * largest_), text(largest_)};
  return {ramp, name_ == "curvature" ? "mean curvature" : name_, text(least_), text(largest_)};
}

}  // namespace snug::command
