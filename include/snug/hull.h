#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/surface.h>

namespace snug {

struct HullOptions {
  double tolerance = 0;  ///< > 0, mesh units: no hull is farther than this from the surface, nor it from them
  bool inner = true, outer = true;  ///< which ones are wanted
  /// Most triangles of a hull. Memory: 2 to 3 kB each, and up to 10 kB each and 100 MB where hulls fail.
  std::uint64_t budget = 1'000'000;
  int threads = 0;                ///< 0: all cores
  bool single_precision = false;  ///< coordinates are floats, for formats that hold no others
};

/// Triangles on one side of a limit surface, oriented as its faces; of a closed one outward.
struct Hull {
  std::vector<Point3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t>
      owners;  ///< of each triangle the face that it is over; in a dual scheme, the vertex
  /// Proved: no point of it is farther from the surface, no point of the surface is farther from it.
  double gap = 0;
};

/// What keeps a hull from being proved, or from being at all.
enum class HullFault : std::uint8_t {
  no_position,        ///< the facets around a vertex face all ways: no point is beyond all of them
  meets_surface,      ///< a facet could not be kept off the surface
  meets_itself,       ///< two facets could not be kept off each other
  meets_other,        ///< nor the two hulls
  not_around,         ///< the hull does not enclose the surface, or is not enclosed by it
  too_few_triangles,  ///< the budget allows no more, and these are not near enough to the surface
};
[[nodiscard]] SNUG_API const char* name_of(HullFault fault);

/// Where.
struct HullProblem {
  HullFault fault;
  bool inner;                            ///< of the inner hull
  Point3 place;                          ///< a point of the surface or of the hull there, mesh units
  std::optional<std::uint32_t> owner{};  ///< face there; in a dual scheme, vertex
};

struct Hulls {
  std::optional<Hull> inner, outer;
  bool verified = false;              ///< do all guarantees of hulls() hold?
  std::vector<HullProblem> problems;  ///< if not, some of the places
  bool closed = false;                ///< does the surface bound a solid?
};

/// Two meshes that sandwich a limit surface: the inner hull lies inside of the solid that a closed surface
/// bounds, whichever way its faces are oriented, the outer one around it. Of an open surface they are a sheet
/// behind and one in front of it, with the same border as the surface's, moved: a strip as wide as the gap
/// along it is not covered.
///
/// Guarantee: if `verified`, no triangle of a hull has a point in common with the limit surface, nor with the
///            other hull, nor with its own triangles but for vertices and edges that both name; each point of a
///            hull is within Hull::gap <= tolerance of the surface, and of the surface likewise; the solid of a
///            closed surface lies inside of the outer hull's and around the inner one's. Everything holds for
///            the doubles given and, but for a gap below the tolerance, was proved from them, not by how they
///            were found. Does not depend on threads. Surfaces that touch themselves, or have sheets nearer to
///            each other than hulls fit between, are not `verified`, as a rule.
/// Errors:    InputError: (value) for a tolerance that is not finite and positive, above half of the size, or
///            too small for doubles or floats; (refused), naming two faces, where these run along an edge the
///            same way, as on a Moebius strip or where three meet; (unrepresentable). Interrupted.
/// Cost:      50 to 100 microseconds a triangle in one thread; where hulls fail, many times that.
/// Source:    [Wu05, sec. 5.2]; differs: planes of whole facets, verified; derivations/hulls.md.
[[nodiscard]] SNUG_API Hulls hulls(const Surface& surface, const HullOptions& options,
                                   const WorkMonitor& monitor = {});

}  // namespace snug
