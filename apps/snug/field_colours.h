#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <picture/scene.h>
#include <snug/run.h>

#include "scene_builder.h"

namespace snug::command {

/// Colours of surfaces that show a number over them, by its place in the range of all of them light or dark, blue to yellow,
/// or a colour for each kind of patch; and the key to these colours.
///
///   level      how often a patch was split, as the picture needs it
///   kind       grey where the patch is a polynomial, else a colour for each kind
///   thickness  of a patch's interval triangle, its logarithm: from a thousandth of the thickest to that
///   curvature  mean curvature: from -k to k, where k is exceeded by a twentieth of a surface
///   distance   to the other surface: from the least to the largest that is met
///
/// Requires:  one of these names; the surfaces outlive it.
/// Cost:      curvature 45 evaluations a patch, distance 45 queries a patch; a number is kept for each of 15 and 45 places.
class FieldColours {
 public:
  explicit FieldColours(std::string name) : name_(std::move(name)) {}

  void add(const PlacedSurface& surface, const PlacedSurface& other, const Run& run);
  /// Those of the surface that was added as number `which`; for all, once all were added.
  [[nodiscard]] std::function<Colour(const QuickHit&)> of(std::size_t which) const;
  [[nodiscard]] ColourBar bar() const;

  struct Field;

 private:
  std::string name_;
  std::vector<std::shared_ptr<const Field>> fields_;
  double least_ = 0, largest_ = 0;  // of the fields
};

}  // namespace snug::command
