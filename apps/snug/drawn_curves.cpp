#include "drawn_curves.h"

#include <algorithm>
#include <cmath>

namespace snug::command {
namespace {

// A chord over a parameter's step h is at most h^2 / 8 times the second derivative from its curve.
double steps_for(double bend, double deviation) {
  return std::max(1.0, std::ceil(std::sqrt(bend / (8 * deviation))));
}

}  // namespace

DrawnCurves::DrawnCurves(const CurveSet& curves, const Motion& pose, const PictureUnits& units)
    : curves_(&curves), pose_(pose), units_(units), starts_{0} {
  const ControlMesh& mesh = curves.mesh();
  for (std::size_t p = 0; p < mesh.polyline_count(); ++p) {
    const auto line = mesh.polyline(PolylineId(p));
    const std::size_t start = starts_.back(), last = line.size() - 1;
    for (const VertexId v : line) vertices_.push_back(units(pose, mesh.points[v.index()]));
    starts_.push_back(vertices_.size());
    // For both degrees the second derivative over an edge is between the second differences at its ends, with
    // none at the ends of an open polygon.
    const bool closed = line.front() == line.back();
    const auto difference = [&](std::size_t i) {
      if (!closed && (i == 0 || i == last)) return 0.0;
      const Point3 before = vertices_[start + (i == 0 ? last : i) - 1],
                   after = vertices_[start + (i == last ? 1 : i + 1)], middle = vertices_[start + i];
      return length((after - middle) - (middle - before));
    };
    for (std::size_t i = 0; i < last; ++i) bends_.push_back(std::max(difference(i), difference(i + 1)));
  }
}

double DrawnCurves::polygon_length() const {
  double sum = 0;
  for (std::size_t p = 0; p + 1 < starts_.size(); ++p) {
    for (std::size_t i = starts_[p]; i + 1 < starts_[p + 1]; ++i)
      sum += length(vertices_[i + 1] - vertices_[i]);
  }
  return sum;
}

double DrawnCurves::chord_count(double deviation) const {
  double sum = 0;
  for (const double bend : bends_) sum += steps_for(bend, deviation);
  return sum;
}

std::vector<Tube> DrawnCurves::tubes(double deviation, double radius, const WorkMonitor& monitor) const {
  std::vector<Tube> result;
  std::size_t edge = 0;
  for (std::size_t p = 0; p + 1 < starts_.size(); ++p) {
    monitor.checkpoint();
    const auto point = [&](double t) { return units_(pose_, evaluate(*curves_, EdgeId(edge), t).point); };
    std::vector<Point3> chain{point(0)};
    for (std::size_t i = starts_[p]; i + 1 < starts_[p + 1]; ++i, ++edge) {
      const auto steps = static_cast<unsigned>(steps_for(bends_[edge], deviation));
      for (unsigned k = 1; k <= steps; ++k) chain.push_back(point(static_cast<double>(k) / steps));
    }
    const auto line = curves_->mesh().polyline(PolylineId(p));
    if (line.front() == line.back()) chain.back() = chain.front();
    result.emplace_back(chain, radius);
  }
  return result;
}

void DrawnCurves::add_polygons(PictureScene& scene, double line_width, Colour line_colour) const {
  for (std::size_t p = 0; p + 1 < starts_.size(); ++p) {
    for (std::size_t i = starts_[p]; i + 1 < starts_[p + 1]; ++i) {
      scene.lines.push_back({vertices_[i], vertices_[i + 1], line_width, line_colour});
    }
  }
}

}  // namespace snug::command
