#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <snug/surface.h>

namespace snug {

struct HullOptions {
  /// > 0, mesh units: largest distance between surface and hull, either way. Default: 1 % of the surface's size.
  std::optional<double> error{};
  bool inner = true, outer = true;  ///< which hulls to make
  bool single_precision = false;    ///< round coordinates to floats, for formats that store floats
};

/// Triangles on one side of a limit surface, oriented as its faces; for a closed surface, outward.
struct Hull {
  std::vector<Point3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t>
      owners;  ///< for each triangle, the face it lies over; in a dual scheme, the vertex
  /// Proved: hull and surface are nowhere farther than this from each other.
  double gap = 0;
};

/// Why a hull could not be verified, or could not be built.
enum class HullFault : std::uint8_t {
  no_position,        ///< no point lies beyond all facets around a vertex, which face all ways
  meets_surface,      ///< a facet could not be separated from the surface
  meets_itself,       ///< two facets could not be separated from each other
  meets_other,        ///< the two hulls could not be separated
  not_around,         ///< the outer hull does not enclose the surface, or the surface the inner one
  too_few_triangles,  ///< the budget is spent, and the hull is not as near as requested
  through_itself,     ///< a hull failed, and the surface goes through itself: proved, as by self_contact()
};
[[nodiscard]] SNUG_API const char* name_of(HullFault fault);

/// Where a hull failed, and why.
struct HullProblem {
  HullFault fault;
  bool inner;                            ///< true: the inner hull failed
  Point3 place;                          ///< a point there, of the surface or the hull, mesh units
  std::optional<std::uint32_t> owner{};  ///< the face there; in a dual scheme, the vertex
};

struct Hulls {
  std::optional<Hull> inner, outer;     ///< no outer one if the inner one was asked for, too, and failed
  Outcome outcome = Outcome::complete;  ///< do all guarantees of hull() hold? Else they may not
  std::vector<HullProblem> problems;    ///< unless `complete`, some of the failures
  bool closed = false;                  ///< does the surface bound a solid?
};

/// Two meshes that sandwich a limit surface. For a closed surface, the inner hull lies inside the solid that it
/// bounds and the outer one around it, whichever way the faces are oriented. For an open surface: one sheet
/// behind it and one in front, with its border offset; a strip along the border as wide as the gap stays
/// uncovered.
///
/// Guarantee: if `complete`, no triangle of a hull meets the limit surface, the other hull, or another triangle
///            of its own hull except in shared vertices and edges; hull and surface are nowhere farther than
///            Hull::gap <= error from each other; the solid of a closed surface lies inside the outer hull
///            and contains the inner one. Everything holds for the returned doubles and, except for a gap below
///            the error, was proved from them, not from how they were found. Where a surface goes through itself hulls
///            fail, and that it does is said if it is proved (through_itself); envelope() is for it. One that touches
///            itself, or whose sheets leave no room between them, is usually not `complete`.
/// Budget:    1,000,000 triangles of a hull; 2 to 3 kB each; if hulls fail, up to 10 kB each and 100 MB more.
/// Errors:    InputError: (value) for an error that is not finite and positive, above half the size, or
///            too small for doubles or floats; (refused), naming two faces, if these run along an edge in the
///            same direction, as on a Moebius strip or where three meet; (unrepresentable). Interrupted.
/// Cost:      50 to 100 microseconds a triangle on one thread; many times that if hulls fail.
/// Source:    [Wu05, sec. 5.2]; differs: planes of whole facets, verified, derivations/hulls.md.
[[nodiscard]] SNUG_API Hulls hull(const Surface& surface, const HullOptions& options = {},
                                  const Run& run = {});

struct EnvelopeOptions {
  /// > 0, mesh units: largest distance of the envelope's points from the surfaces. Default: 1 % of the size of all.
  std::optional<double> error{};
  /// >= 0, mesh units, less than `error`: their least distance. Default: a quarter of the error.
  std::optional<double> clearance{};
  /// Mesh units, from twice the error to a quarter of the size: what no ball as wide gets to from outside is filled.
  std::optional<double> gap{};
  bool single_precision = false;  ///< round coordinates to floats, for formats that store floats
};

/// Closed meshes around limit surfaces, oriented outward.
struct Envelope {
  std::vector<Point3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double error = 0, clearance = 0;      ///< those that were asked for
  std::vector<std::uint32_t> bridges;   ///< with a gap: triangles across what it fills; not within `error`,
  double bridge_distance = 0;           ///< but no point of them is farther than this from the surfaces
  Interval volume;                      ///< contains it, as Measures::volume does
  Outcome outcome = Outcome::complete;  ///< do all guarantees of envelope() hold? Else they may not
  std::vector<HullProblem> problems;    ///< unless `complete`, some of the failures
};

/// One watertight mesh around surfaces of any sort: open, through themselves or each other, not manifold, many parts.
/// Holes and gaps narrower than about `error` + `clearance` are bridged; cavities that the outside does not reach are filled.
///
/// Guarantee: if `complete`, all points of the surfaces lie in the solid that it bounds; each point of it is at least `clearance`
///            and, but for `bridges`, at most `error` from the surfaces; each edge belongs to two triangles, one along it each
///            way, and triangles meet only in vertices and edges that they share. All was proved from the returned doubles, not
///            from how they were found. Points of the surfaces inside of others, or behind bridges, may be anywhere in it.
/// Budget:    4,000,000 cubes in which it is sampled, some (area / error^2); 200 bytes each, and as much for pieces.
/// Errors:    InputError: (value) without surfaces, for lengths out of range, and an error too small for doubles or floats;
///            (refused) if a mesh has no face with a limit surface; (unrepresentable). Interrupted.
/// Cost:      some 5 microseconds a cube; three times that with a gap. Source: derivations/envelopes.md.
[[nodiscard]] SNUG_API Envelope envelope(std::span<const PlacedSurface> parts,
                                         const EnvelopeOptions& options = {}, const Run& run = {});
[[nodiscard]] SNUG_API Envelope envelope(const PlacedSurface& part, const EnvelopeOptions& options = {},
                                         const Run& run = {});

}  // namespace snug
