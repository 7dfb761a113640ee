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
/// Two pairs of pieces are neighbours if on A and on B their patches are the same or share a corner, and their boxes intersect; a region
/// is a connected component. A connected set of contacts is in one region; sets closer than the size of pieces may be in one, too.
struct ContactRegion {
  /// `intersecting`: proved, a curve or an area is in the region or a crossing was found; `within`: the witnesses are at
  /// most `within` apart; `undecided`: there may be no contact here.
  Verdict verdict = Verdict::undecided;
  std::vector<PatchContact> contacts;                ///< in the order of patches
  std::array<std::vector<std::uint32_t>, 2> owners;  ///< faces (vertices in a dual scheme), sorted
  Box3 box;               ///< contains all points of A and of B in the region at most `within` apart
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
  bool proved = false;  ///< every box contains one arc, and consecutive arcs are proved to meet
  /// Of an open curve: do its first and its last point certainly lie on a border? If not, it may continue in an open box or at an area.
  std::array<bool, 2> at_border{};
  double error = 0;  ///< upper bound of the distance between polyline and curve, each from the other
  std::uint32_t region = 0;
};

/// The common part of a facet of A and one of B (self_contact() says which are) that touch, exactly for the doubles of meshes and poses.
struct ContactArea {
  std::vector<Point3> points;  ///< of a convex polygon, as the corners of A's face run; a segment; a point
  double error = 0;  ///< upper bound, a coordinate, of how far they are from the exact ones; often 0
  std::array<std::uint32_t, 2> faces{};
  std::uint32_t region = 0;
};

/// A box in which A and B may intersect in an unresolved way: tangentially, in an area, or at a corner of patches. Where there are more
/// than about 4,000, or one for each pair of patches in a region, neighbouring ones are one.
struct OpenBox {
  Box3 box;
  std::array<PatchPlace, 2> patches;
  std::uint32_t region = 0;
};

struct Contacts {
  Outcome outcome = Outcome::complete;  ///< not `complete` where pieces stayed coarser than requested
  /// Do the lists below hold all contacts? False if the budget ran out before all pairs had been compared.
  bool exhaustive = false;
  std::vector<ContactRegion> regions;
  std::vector<IntersectionCurve> curves;
  std::vector<ContactArea> areas;  ///< those of edges and corners only where they lie in no other one
  std::vector<OpenBox> open;
  SearchStats stats;           ///< of the search for regions
  std::uint64_t compared = 0;  ///< pairs of pieces compared for curves
};

/// All contacts of two placed limit surfaces, and the curves in which they intersect.
///
/// Guarantee: if `exhaustive`, any two points of A and B at most `within` apart lie on the two patches of a listed contact, and any
///            common point lies in a box of a curve, in an area or in an open box. A curve that is `proved` and `closed` is one
///            closed curve of the intersection. All of this holds for the given doubles, rounding included.
/// Budget:    200,000 pairs of pieces compared for regions, and as many again for curves; 300 bytes each.
/// Errors:    InputError: (value) for `within` negative or not finite, and `error` not positive; (unrepresentable) if a result does not fit a double; (refused) if no face of a mesh has a
///            limit surface. Interrupted.
/// Cost:      grows with the contact, not with the meshes: some 20 to 90 ms for curves of 600 to 2,000 points
///            (bench/results/contacts.txt).
/// Source:    derivations/contacts.md.
[[nodiscard]] SNUG_API Contacts contacts(const PlacedSurface& a, const PlacedSurface& b,
                                         const ContactsOptions& options = {}, const Run& run = {});

/// Does a surface meet itself?
enum class SelfVerdict : std::uint8_t {
  clear,  ///< proved: no two parameters have the same limit point
  intersecting,  ///< proved: pieces cross, facets or vertices have a common point, or a sheet turns over in its plane
  near,  ///< proved: two points are at most `within` apart, but farther apart than the radius along the surface
  undecided,  ///< none of these could be shown
};
[[nodiscard]] SNUG_API const char* name_of(SelfVerdict verdict);

struct SelfContactOptions {
  /// > 0, in mesh units: points at most this far apart are near each other. Default: only contact is tested.
  std::optional<double> within{};
  /// Only points farther apart along the surface than this count as near; points of different components always do. At least twice
  /// `within`; if it is below pi/2 times that, a sphere of diameter `within` is near itself. Default: 4 times `within`.
  std::optional<double> radius{};
  unsigned levels = 10;  ///< most levels below the coarsest one at which stars are tested
};

/// Two places of a surface that meet, are near each other, or could not be proved apart.
struct SelfContactPair {
  SelfVerdict verdict = SelfVerdict::undecided;  ///< all but clear
  bool touching = false;  ///< of facets: in no point inside of both; of vertices that coincide
  WitnessPoints points;   ///< on the two pieces, or on both sides of a patch that turns over; `at` is set
  Interval distance;      ///< contains the distance of the two pieces; [0, 0] where the surface meets itself
};

/// The answer to "does this surface meet itself?"
struct SelfContact {
  SelfVerdict verdict = SelfVerdict::undecided;
  /// The places that the verdict rests on, the first max_pairs at most; their order depends on the surface alone. None if clear.
  std::vector<SelfContactPair> pairs;
  static constexpr std::size_t max_pairs = 100;
  std::uint64_t stars = 0;              ///< neighbourhoods of vertices tested
  std::uint64_t pair_tests = 0;         ///< pairs of pieces tested
  double radius = 0;                    ///< the radius that was used; 0 without `within`
  unsigned levels = 0;                  ///< levels of subdivision that were needed
  Outcome outcome = Outcome::complete;  ///< `complete` unless `undecided`; `at_rounding` also at `levels`
};

/// Does a limit surface meet itself?
///
/// Pieces without a common corner are proved apart or proved to cross. The pieces around a vertex are together proved not to meet
/// except along shared edges, or are split. With `within`, `clear` also proves that any two points so close are joined by a path on
/// the surface no longer than the radius, and `near` that two of them are not joined by such a path.
///
/// Guarantee: `clear`, `intersecting` and `near` hold in exact arithmetic for the given doubles. Facets (triangles of flat,
///            plane convex faces of bilinear, such faces that are sharp all around) are compared exactly: touching is found, also
///            where vertices coincide but are not one. On others, places where the surface is not an immersion (folded creases,
///            collapsed patches, edges that are not manifold) are `undecided`, never `clear`; so are vertices
///            of very many faces (docs/self_contact.md).
/// Budget:    1,000,000 stars and pairs of pieces tested, about; 100 bytes each.
/// Errors:    InputError: (value) for more than 20 levels, for `within` not positive and finite, and for a radius that is not finite, is
///            below twice `within`, or is given without it; (refused) if no face has a limit surface; (unrepresentable) if a result
///            does not fit a double. Interrupted.
/// Cost:      about 1 to 4 ms per face (docs/self_contact.md). With `within` as long again, and longer by pieces near each other.
/// Source:    derivations/self_contact.md.
[[nodiscard]] SNUG_API SelfContact self_contact(const Surface& surface,
                                                const SelfContactOptions& options = {}, const Run& run = {});

}  // namespace snug
