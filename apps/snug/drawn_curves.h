#pragma once

#include <picture/tube.h>
#include <snug/curves.h>

#include "scene_builder.h"

namespace snug::command {

/// Curves where they stand in the picture, and their control polygons.
class DrawnCurves {
 public:
  /// Requires:  the curves outlive it.
  DrawnCurves(const CurveSet& curves, const Motion& pose, const PictureUnits& units);

  /// Of all control polygons together, in picture units.
  [[nodiscard]] double polygon_length() const;
  /// How many chords follow the curves so closely that no point is farther from them than `deviation`; one an
  /// edge if that is infinite.
  [[nodiscard]] double chord_count(double deviation) const;
  /// A tube along such chords for each curve.
  /// Errors:    InputError if a coordinate does not fit a double; Interrupted.
  /// Cost:      an evaluation a chord.
  [[nodiscard]] std::vector<Tube> tubes(double deviation, double radius, const WorkMonitor& monitor) const;
  /// Adds the edges of the control polygons.
  void add_polygons(PictureScene& scene, double line_width, Colour line_colour) const;

 private:
  const CurveSet* curves_;
  Motion pose_;
  PictureUnits units_;
  std::vector<Point3> vertices_;     // polygon by polygon, in picture units
  std::vector<std::size_t> starts_;  // of each polygon among the vertices, and their number
  std::vector<double> bends_;        // of each edge, an upper bound of the second derivative's length
};

}  // namespace snug::command
