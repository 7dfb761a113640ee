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
  std::optional<double> within{};
  /// > 0, mesh units: largest distance between a curve and the line between two of its points, and the size down
  /// to which boxes are split where no curve is proved. Default: 0.1 % of the larger surface's size.
  std::optional<double> error{};
  bool curves = true;  ///< compute intersection curves
};

/// A patch of A and a patch of B that are in contact.
struct PatchContact {
  std::array<PatchPlace, 2> patches;  ///< of A and of B
  Verdict verdict = Verdict::undecided;
  Interval distance;  ///< contains the distance between the parts of both patches in the region
};

/// A connected part of a contact.
///
/// Two pairs of pieces are neighbours if, on A and on B, their patches are the same or share a corner, and the boxes
/// around their pieces intersect; a region is a connected component of this relation. A connected set of contacts is in
/// one region; two sets that are closer to each other than the size of pieces may be in one region, too.
struct ContactRegion {
  /// `intersecting`: proved, a curve runs through the region or a crossing was found; `within`: the witnesses are at
  /// most `within` apart; `undecided`: there may be no contact here.
  Verdict verdict = Verdict::undecided;
  std::vector<PatchContact> contacts;  ///< in the order of patches
  std::array<std::vector<std::uint32_t>, 2>
      owners;  ///< faces of A and of B (vertices in a dual scheme), sorted
  /// Contains all points of A and of B in the region that are at most `within` apart.
  Box3 box;
  Interval distance;      ///< contains the least distance between A and B in the region
  WitnessPoints witness;  ///< the two closest points found, with `at` set; normal_at() gives the normals
};

/// A box on an intersection curve, between one of its points and the next.
struct CurveBox {
  Box3 box;
  /// Proved: a piece of A and a piece of B cross in one arc, from one point to the other; at an end that is an open
  /// box, up to a speck (a tiny box). Else the box joins two arcs that end in it.
  bool one_arc = false;
};

/// A curve in which A and B intersect, as points and the boxes between them.
struct IntersectionCurve {
  std::vector<Point3> points;   ///< a closed curve's first point is not repeated
  std::vector<CurveBox> boxes;  ///< box i is between points i and i + 1; if closed, the last leads back
  bool closed = false;
  /// Every box contains one arc, and consecutive arcs are proved to meet.
  bool proved = false;
  /// For an open curve: whether its first and its last point certainly lie on the border of a surface. Where false,
  /// the curve may continue in an open box.
  std::array<bool, 2> at_border{};
  double error = 0;  ///< upper bound of the distance between polyline and curve, each from the other
  std::uint32_t region = 0;
};

/// A box in which A and B may intersect in an unresolved way: tangentially, in an area, or at a corner of patches.
struct OpenBox {
  Box3 box;
  std::array<PatchPlace, 2> patches;
  std::uint32_t region = 0;
};

struct Contacts {
  /// Not `complete` where pieces stayed coarser than requested.
  Outcome outcome = Outcome::complete;
  /// Do the lists below hold all contacts? False if the budget ran out before all pairs had been compared.
  bool exhaustive = false;
  std::vector<ContactRegion> regions;
  std::vector<IntersectionCurve> curves;
  std::vector<OpenBox> open;
  SearchStats stats;           ///< of the search for regions
  std::uint64_t compared = 0;  ///< pairs of pieces compared for curves
};

/// All contacts of two placed limit surfaces, and the curves in which they intersect.
///
/// Guarantee: if `exhaustive`, any two points of A and B at most `within` apart lie on the two patches of a listed
///            contact, and any common point lies in a box of a curve or in an open box. A curve that is `proved` and
///            `closed` is one closed curve of the intersection. All of this holds for the given doubles, rounding
///            included.
/// Budget:    200,000 pairs of pieces compared for regions, and as many again for curves; 300 bytes each.
/// Errors:    InputError: (value) for `within` negative or not finite, and `error` not positive; (unrepresentable) if a result does not fit a double; (refused) if no face of a mesh has a
///            limit surface. Interrupted.
/// Cost:      grows with the contact, not with the meshes: some 20 to 90 ms for curves of 600 to 2,000 points
///            (bench/results/contacts.txt).
/// Source:    derivations/contacts.md.
[[nodiscard]] SNUG_API Contacts contacts(const PlacedSurface& a, const PlacedSurface& b,
                                         const ContactsOptions& options = {}, const Run& run = {});

}  // namespace snug
