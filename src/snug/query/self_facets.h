#pragma once

#include <vector>

#include <snug/contacts.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// Faces that were compared with each other exactly.
struct ComparedFacets {
  std::vector<bool>
      faces;  ///< which; triangles, and plane polygons that turn the same way at each corner, as they are
  bool all = false;    ///< Are these all faces with a surface?
  SelfContact answer;  ///< clear or intersecting, about them alone
};

/// The part of self_contact() that signs of determinants decide. Faces whose coordinates are too small for these are left out.
/// Errors:    Interrupted.
/// Source:    derivations/self_contact.md, "Facets".
[[nodiscard]] ComparedFacets compare_facets(const LimitSurface& surface, int threads,
                                            const WorkMonitor& monitor);

}  // namespace snug
