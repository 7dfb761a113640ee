#pragma once

#include <cstdint>
#include <vector>

#include <snug/run.h>
#include <snug/surface.h>

namespace snug {

struct SurfacePlace {
  Point3 point;
  std::uint32_t owner;
};

/// Where a surface is proved to meet itself, found once it is asked for.
class OwnContacts {
 public:
  /// Requires:  both outlive it.
  OwnContacts(const Surface& surface, const Run& run) : surface_(surface), run_(run) {}

  /// The owners and places where it goes through itself.
  [[nodiscard]] const std::vector<SurfacePlace>& through();
  /// Does it touch itself so near to a point? Then no hull gets between its sheets.
  [[nodiscard]] bool touches_near(const Point3& p, double reach);

 private:
  void find();

  const Surface& surface_;
  const Run& run_;
  bool found_ = false;
  std::vector<SurfacePlace> through_;
  std::vector<Point3> touching_;
};

}  // namespace snug
