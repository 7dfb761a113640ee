#pragma once

#include <vector>

#include <snug/hull.h>
#include <snug/query/own_contacts.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// A hull on one side of a surface.
struct OneHull {
  Hull hull;                          ///< whole if there are no problems; not verified
  bool closed = false;                ///< does the surface have no border?
  std::vector<HullProblem> problems;  ///< where the surface goes through itself, only that
};
/// By triangles whose tolerances are made smaller where they fail. From round `asked_from` on it is asked whether the surface goes
/// through itself.
/// Requires:  of the options only `error`, which must be set, and `single_precision` count.
/// Errors:    InputError (refused, unrepresentable). Interrupted.
[[nodiscard]] OneHull make_hull(const LimitSurface& surface, const HullOptions& options, bool inner,
                                OwnContacts& contacts, int asked_from, const Run& run);

}  // namespace snug
