#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/bound.h>
#include <snug/collide.h>

namespace snug {

struct ContactsOptions {
  /// >= 0, mesh units: points of A and B this close are in contact. Default: 0.1 % of the larger surface's size.
  std::optional<double> tolerance{};
  /// > 0, mesh units: how far a line between two points of a curve may be from the curve, and how large the boxes
  /// become in which no curve is proved. Default: 0.1 % of the larger surface's size.
  std::optional<double> precision{};
  std::uint64_t budget =
      200'000;         ///< most pairs of pieces that are compared for regions, and again for curves
  bool curves = true;  ///< look for intersection curves
  int threads = 0;     ///< for curves; 0: all cores
};

/// A patch of A and one of B, in contact.
struct PatchContact {
  std::array<PatchPlace, 2> patches;  ///< of A and of B
  Verdict verdict = Verdict::undecided;
  Interval distance;  ///< contains the distance of the two patches' parts in the region
};

/// A connected part of a contact.
///
/// Two pairs of pieces belong to one region if on both sides their patches are the same or share a corner, and boxes
/// around the pieces meet; and so does what such steps lead to. A connected set of contacts is in one region; two
/// sets nearer to each other than pieces are large may be in one, too.
struct ContactRegion {
  /// `intersecting`: proved, a curve runs through it or a crossing was found; `within`: the witnesses are at most
  /// the tolerance apart; `undecided`: there may be no contact here.
  Verdict verdict = Verdict::undecided;
  std::vector<PatchContact> contacts;  ///< in the order of patches
  std::array<std::vector<std::uint32_t>, 2>
      owners;  ///< faces of A and of B (vertices in a dual scheme), sorted
  /// Contains all points of A and of B in the region that are within the tolerance of each other.
  Box3 box;
  Interval distance;              ///< contains the least distance of A and B in the region
  std::array<Point3, 2> witness;  ///< the two closest points found, on A and on B
  double witness_error = 0;       ///< as in Collision
  WitnessPlaces at;               ///< as in Collision; normal_at() gives the normals
};

/// A box on an intersection curve, between one of its points and the next.
struct CurveBox {
  Box3 box;
  /// Proved: a piece of A and one of B cross in this arc, from the one point to the other, up to a speck at either
  /// end if that is an open box. Else the box joins two arcs that end in it.
  bool one_arc = false;
};

/// A curve in which A and B intersect, as points and the boxes between them.
struct IntersectionCurve {
  std::vector<Point3> points;   ///< a closed curve's first point is not repeated
  std::vector<CurveBox> boxes;  ///< box i is between points i and i + 1; of a closed one the last leads back
  bool closed = false;
  /// Every box has one arc, and arcs are proved to meet where boxes do.
  bool proved = false;
  /// For an open curve: does its first, its last point certainly lie on the border of a surface? Else the curve may
  /// go on in an open box.
  std::array<bool, 2> at_border{};
  double error = 0;  ///< upper bound of the distance of the polyline from the curve, each from the other
  std::uint32_t region = 0;
};

/// Where A and B may intersect in a way that was not found out: along a tangent, in an area, at a corner of patches.
struct OpenBox {
  Box3 box;
  std::array<PatchPlace, 2> patches;
  std::uint32_t region = 0;
};

struct Contacts {
  /// False if the budget ended before everything was compared: then nothing is known of what is not listed.
  bool complete = false;
  bool reached = false;  ///< is everything as fine as asked? Else the budget or rounding left coarse pieces
  std::vector<ContactRegion> regions;
  std::vector<IntersectionCurve> curves;
  std::vector<OpenBox> open;
  SearchStats stats;           ///< of the search for regions
  std::uint64_t compared = 0;  ///< pairs of pieces compared for curves
};

/// All contacts of two placed limit surfaces, and the curves in which they intersect.
///
/// Guarantee: if `complete`, any two points of A and B within the tolerance lie on two patches of one of the contacts
///            listed, and any common point lies in a box of a curve or in an open box. A curve that is `proved` and
///            `closed` is one closed curve of the intersection. All for the given doubles, rounding included. The
///            result depends on the input alone, not on threads or earlier queries.
/// Errors:    InputError: (value) for a tolerance that is negative or not finite, and a precision that is not
///            positive; (unrepresentable) if a result does not fit a double; (refused) if no face of a mesh has a
///            limit surface. Interrupted.
/// Cost:      grows with the contact, not with the meshes: some 20 to 90 ms for curves of 600 to 2,000 points
///            (bench/results/contacts.txt).
/// Source:    derivations/contacts.md.
[[nodiscard]] SNUG_API Contacts contacts(const PlacedSurface& a, const PlacedSurface& b,
                                         const ContactsOptions& options = {}, const WorkMonitor& monitor = {},
                                         Workspace& workspace = Workspace::of_this_thread());

}  // namespace snug
