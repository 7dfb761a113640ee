#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <tuple>
#include <type_traits>

#include <snug/bound.h>
#include <snug/brep.h>
#include <snug/clearance.h>
#include <snug/collide.h>
#include <snug/contacts.h>
#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/hull.h>
#include <snug/inspect.h>
#include <snug/measure.h>
#include <snug/ray.h>
#include <snug/scene.h>
#include <snug/tessellate.h>
#include <snug/time_of_contact.h>

/// Fields of answers: names, order and a sentence each, once for the command's JSON, the Python module, the JavaScript package and their
/// declarations. Programs in C++ do not need this header; a program that makes another door of snug does.
namespace snug {

/// A member of an answer. Its name is the same at all doors, in the spelling of each: max_radius, maxRadius. std::invoke(of, answer) is its value, a
/// reference if the answer has it in memory. How each kind of value looks at a door is the door's matter.
template <class Of>
struct Field {
  const char* name;
  Of of;
  const char* text;  ///< a sentence or two; lengths are in mesh units
};
template <class Of>
Field(const char*, Of, const char*) -> Field<Of>;

/// The fields of an answer, in order: a tuple of Field. Empty: it is told in other ways.
template <class Answer>
inline constexpr std::tuple<> fields_of{};

template <class Answer>
inline constexpr bool has_fields = std::tuple_size_v<std::remove_cv_t<decltype(fields_of<Answer>)>> != 0;

/// The type of a field of an answer, without reference.
template <class Answer, class Of>
using FieldValue = std::remove_cvref_t<std::invoke_result_t<Of, const Answer&>>;

/// Calls visit(field) for each field of an answer.
template <class Answer, class Visit>
void for_each_field(const Visit& visit) {
  std::apply([&](const auto&... field) { (visit(field), ...); }, fields_of<Answer>);
}

/// Members of answers together, and such that lie deeper in them than their fields tell.
namespace fields {

struct SelfContactStats {
  std::uint64_t stars, pair_tests;
  unsigned levels;
};
struct MeasureStats {
  std::uint64_t splits;
};

inline SelfContactStats self_contact_stats(const SelfContact& t) { return {t.stars, t.pair_tests, t.levels}; }
inline MeasureStats measure_stats(const Measures& t) { return {t.splits}; }
inline bool is_closed(const Measures& t) { return t.volume.has_value(); }
inline std::size_t solids(const Brep& t) {
  return static_cast<std::size_t>(std::count_if(t.shells.begin(), t.shells.end(),
                                                [](const Brep::Shell& s) { return s.closed && !s.void_of; }));
}
inline std::size_t voids(const Brep& t) {
  return static_cast<std::size_t>(std::count_if(t.shells.begin(), t.shells.end(),
                                                [](const Brep::Shell& s) { return s.void_of.has_value(); }));
}
inline std::size_t sheets(const Brep& t) {
  return static_cast<std::size_t>(
      std::count_if(t.shells.begin(), t.shells.end(), [](const Brep::Shell& s) { return !s.closed; }));
}
inline std::size_t face_count(const Brep& t) { return t.faces.size(); }
inline std::size_t edge_count(const Brep& t) { return t.edges.size(); }
inline const Place& place(const LimitPoint& t) { return *t.at; }
inline const Place& nearest_place(const SignedDistance& t) { return *t.nearest.at; }
inline const Point3& nearest_point(const SignedDistance& t) { return t.nearest.point; }
inline const double& nearest_error(const SignedDistance& t) { return t.nearest.error; }
inline const Point3& farthest(const OneSidedDistance& t) { return t.from.point; }
inline const double& farthest_error(const OneSidedDistance& t) { return t.from.error; }
inline const std::optional<Place>& farthest_place(const OneSidedDistance& t) { return t.from.at; }

// Sentences that several answers share.
inline constexpr const char *outcome =
                                "'complete', 'budget-spent' or 'at-rounding'; the answer holds in any case.",
                            *proved_if_complete =
                                "'complete': all guarantees hold; else 'budget-spent' or 'at-rounding'.",
                            *witness = "The two closest points found, on A and on B.",
                            *contained =
                                "With solid: whose surface has a point inside the other, if no crossing was "
                                "proved.",
                            *work = "The work that was done.",
                            *error =
                                "Upper bound, per coordinate, of the distance of `point` from the limit "
                                "point that it stands for.",
                            *problems = "Unless 'complete', some of the failures.";

}  // namespace fields

// Two surfaces, or many.

template <>
inline constexpr auto fields_of<SceneCounts> = std::tuple{
    Field{"pairs", &SceneCounts::pairs, "All pairs that were asked about."},
    Field{"separated_by_boxes", &SceneCounts::separated_by_boxes, "Proved by boxes alone, and not listed."},
    Field{"separated", &SceneCounts::separated,
          "Of the others, by their verdicts; distances beyond the limit are separated."},
    Field{"within", &SceneCounts::within, "Likewise."},
    Field{"intersecting", &SceneCounts::intersecting, "Likewise; of distances, proved contact."},
    Field{"undecided", &SceneCounts::undecided, "Likewise."},
};

template <>
inline constexpr auto fields_of<SearchStats> = std::tuple{
    Field{"box_tests", &SearchStats::box_tests, "Pairs of BVH nodes compared."},
    Field{"triangle_tests", &SearchStats::triangle_tests, "Pairs of base triangles compared."},
    Field{"evaluations", &SearchStats::evaluations, "Pairs of limit points evaluated."},
    Field{"splits", &SearchStats::splits, "Pieces split."},
};

template <>
inline constexpr auto fields_of<Collision> = std::tuple{
    Field{"verdict", &Collision::verdict,
          "'separated': farther apart than the margin. 'within': at most margin + tolerance apart. "
          "'intersecting': with a point in common. All are proved. 'undecided': none of these was."},
    Field{"outcome", &Collision::outcome,
          "'complete', or why the verdict is 'undecided': 'budget-spent' or 'at-rounding'."},
    Field{"distance", &Collision::distance,
          "Contains the distance, in mesh units; the upper end is infinite if no pair of points was near "
          "enough to matter."},
    Field{"witness", &Collision::witness, fields::witness},
    Field{"contained", &Collision::contained, fields::contained},
    Field{"stats", &Collision::stats, fields::work},
};

template <>
inline constexpr auto fields_of<Distance> = std::tuple{
    Field{"outcome", &Distance::outcome, fields::outcome},
    Field{"distance", &Distance::distance,
          "Contains the distance, in mesh units; [0, 0] if contact is proved."},
    Field{"witness", &Distance::witness, fields::witness},
    Field{"contained", &Distance::contained, fields::contained},
    Field{"stats", &Distance::stats, fields::work},
};

template <>
inline constexpr auto fields_of<Penetration> = std::tuple{
    Field{
        "depth", &Penetration::depth,
        "Contains the depth, in mesh units: no translation shorter than the lower end separates the solids."},
    Field{"translation", &Penetration::translation,
          "Added to B's pose it separates them: proved. Zero if they are separated as they are."},
    Field{"outcome", &Penetration::outcome, fields::outcome},
};

template <>
inline constexpr auto fields_of<TimeOfContact> = std::tuple{
    Field{"verdict", &TimeOfContact::verdict,
          "'separated': they never meet. 'within': at the upper end of `time` they are at most the tolerance "
          "apart. "
          "'intersecting': they have a common point at some time in `time`. 'undecided': none of these was "
          "shown."},
    Field{"outcome", &TimeOfContact::outcome, fields::outcome},
    Field{
        "time", &TimeOfContact::time,
        "No common point before the lower end; at the upper end they are found near each other, infinite if "
        "they are not."},
    Field{"witness", &TimeOfContact::witness,
          "The two closest points found at the upper end of `time`, on A and on B."},
    Field{"contained", &TimeOfContact::contained, fields::contained},
    Field{"steps", &TimeOfContact::steps, "Number of times that were looked at."},
    Field{"stats", &TimeOfContact::stats, fields::work},
};

template <>
inline constexpr auto fields_of<ClearanceSpan> = std::tuple{
    Field{"time", &ClearanceSpan::time, "From its beginning to its end."},
    Field{"distance", &ClearanceSpan::distance, "Contains the least distance at all times in it."},
};

template <>
inline constexpr auto fields_of<Clearance> = std::tuple{
    Field{"outcome", &Clearance::outcome, fields::outcome},
    Field{"distance", &Clearance::distance,
          "Contains the least distance of the whole motion, in mesh units."},
    Field{"time", &Clearance::time, "A time at which they are at most the upper end of `distance` apart."},
    Field{"witness", &Clearance::witness, "The two closest points found at that time, on A and on B."},
    Field{"contained", &Clearance::contained, fields::contained},
    Field{"spans", &Clearance::spans, "From time 0 to the end, each from where the one before it ends."},
    Field{"steps", &Clearance::steps, "Number of times that were looked at."},
    Field{"stats", &Clearance::stats, fields::work},
};

// Contacts.

template <>
inline constexpr auto fields_of<PatchContact> = std::tuple{
    Field{"patches", &PatchContact::patches, "Of A and of B."},
    Field{"verdict", &PatchContact::verdict, "That of these patches."},
    Field{"distance", &PatchContact::distance, "Contains their distance in the region."},
};

template <>
inline constexpr auto fields_of<ContactRegion> = std::tuple{
    Field{"verdict", &ContactRegion::verdict,
          "'intersecting': proved. 'within': the witnesses are at most `within` apart. 'undecided': there "
          "may be no "
          "contact here."},
    Field{"distance", &ContactRegion::distance, "Contains the least distance in the region."},
    Field{"box", &ContactRegion::box, "Lower and upper corner of a box around all points in contact."},
    Field{"witness", &ContactRegion::witness, fields::witness},
    Field{"owners", &ContactRegion::owners, "Faces of A and of B (of dual schemes vertices)."},
    Field{"contacts", &ContactRegion::contacts, "Pairs of patches in contact."},
};

template <>
inline constexpr auto fields_of<CurveBox> = std::tuple{
    Field{"box", &CurveBox::box, "Contains the curve between two points."},
    Field{"one_arc", &CurveBox::one_arc, "Is it proved that one arc leads from one to the other?"},
};

template <>
inline constexpr auto fields_of<IntersectionCurve> = std::tuple{
    Field{"region", &IntersectionCurve::region, "Which region it is in."},
    Field{"closed", &IntersectionCurve::closed, "Does it end where it begins?"},
    Field{"proved", &IntersectionCurve::proved,
          "Does each box contain one arc, and do consecutive arcs meet?"},
    Field{"error", &IntersectionCurve::error,
          "Upper bound of the distance between curve and polyline, either way."},
    Field{"at_border", &IntersectionCurve::at_border,
          "Of an open curve: do its first and last point certainly lie on a border?"},
    Field{"points", &IntersectionCurve::points, "The first point of a closed curve is not repeated."},
    Field{"boxes", &IntersectionCurve::boxes,
          "Box i contains the curve between points i and i + 1; of a closed curve the last one leads back."},
};

template <>
inline constexpr auto fields_of<ContactArea> = std::tuple{
    Field{"region", &ContactArea::region, "Which region it is in."},
    Field{"faces", &ContactArea::faces, "Of A and of B."},
    Field{"error", &ContactArea::error,
          "Upper bound, per coordinate, of how far points are from the exact ones."},
    Field{"points", &ContactArea::points, "Corners of a convex polygon, ends of a segment, or a point."},
};

template <>
inline constexpr auto fields_of<OpenBox> = std::tuple{
    Field{"box", &OpenBox::box, "Lower and upper corner."},
    Field{"patches", &OpenBox::patches, "Of A and of B."},
    Field{"region", &OpenBox::region, "Which region it is in."},
};

template <>
inline constexpr auto fields_of<Contacts> = std::tuple{
    Field{"outcome", &Contacts::outcome,
          "'complete', or 'budget-spent' or 'at-rounding' where pieces stayed coarser than requested."},
    Field{"exhaustive", &Contacts::exhaustive,
          "Do the lists hold all contacts? Not where the budget ended first."},
    Field{"regions", &Contacts::regions, "Connected parts of the contact."},
    Field{"curves", &Contacts::curves, "Curves in which the surfaces intersect."},
    Field{"areas", &Contacts::areas, "What plane faces that touch have in common."},
    Field{"open", &Contacts::open, "Boxes in which the surfaces may meet in an unresolved way."},
};

template <>
inline constexpr auto fields_of<fields::SelfContactStats> = std::tuple{
    Field{"stars", &fields::SelfContactStats::stars, "Neighbourhoods of vertices tested."},
    Field{"pair_tests", &fields::SelfContactStats::pair_tests, "Pairs of pieces tested."},
    Field{"levels", &fields::SelfContactStats::levels, "Levels of subdivision that were needed."},
};

template <>
inline constexpr auto fields_of<SelfContactPair> = std::tuple{
    Field{"verdict", &SelfContactPair::verdict, "'intersecting', 'near' or 'undecided'."},
    Field{"witness", &SelfContactPair::points,
          "Points on the two pieces, or on both sides of one that turns over."},
    Field{"distance", &SelfContactPair::distance,
          "Contains the distance of the two pieces; [0, 0] where the surface meets itself."},
    Field{"touching", &SelfContactPair::touching,
          "Of facets: have they no point in common that is inside of both?"},
};

template <>
inline constexpr auto fields_of<SelfContact> = std::tuple{
    Field{"verdict", &SelfContact::verdict,
          "'clear': proved, no two parameters have one limit point. 'intersecting': proved. 'near': proved, "
          "two points "
          "at most `within` apart are farther apart than the radius along the surface. 'undecided'."},
    Field{"outcome", &SelfContact::outcome,
          "'complete', or why the verdict is 'undecided': 'budget-spent' or 'at-rounding'."},
    Field{"radius", &SelfContact::radius, "The radius that was used; 0 without `within`."},
    Field{"pairs", &SelfContact::pairs, "The places that the verdict rests on, at most 100; none if clear."},
    Field{"stats", &fields::self_contact_stats, fields::work},
};

// One surface and points, rays, parameters.

template <>
inline constexpr auto fields_of<ClosestPoint> = std::tuple{
    Field{"distance", &ClosestPoint::distance,
          "Contains the distance, in mesh units; `point` is at most as far away as its upper end."},
    Field{"outcome", &ClosestPoint::outcome, fields::outcome},
    Field{"point", &ClosestPoint::point, "A limit point close to the closest one."},
    Field{"error", &ClosestPoint::error, fields::error},
    Field{"at", &fields::place, "Where it lies."},
};

template <>
inline constexpr auto fields_of<SignedDistance> = std::tuple{
    Field{"distance", &SignedDistance::distance,
          "Contains the signed distance, in mesh units, negative inside."},
    Field{"outcome", &SignedDistance::outcome, fields::outcome},
    Field{"point", &fields::nearest_point, "A limit point close to the closest one."},
    Field{"error", &fields::nearest_error, fields::error},
    Field{"at", &fields::nearest_place, "Where it lies."},
};

template <>
inline constexpr auto fields_of<RayHit> = std::tuple{
    Field{"t", &RayHit::t, "Contains a hit if `certified`, else maybe; in lengths of the direction."},
    Field{"certified", &RayHit::certified, "Is a hit in the interval proved?"},
    Field{"side", &RayHit::side,
          "1 where the ray leaves on the side of the normal, -1 on the other, 0 where that is not known."},
    Field{"point", &RayHit::point, "In the middle of the interval."},
    Field{"error", &RayHit::error,
          "Upper bound, per coordinate, of the distance of the ray's points in the interval from `point`."},
    Field{"at", &fields::place, "Close to the parameters of the hit."},
    Field{"normal", &RayHit::normal, "Unit normal there, if there is one."},
};

template <>
inline constexpr auto fields_of<RayHits> = std::tuple{
    Field{"outcome", &RayHits::outcome,
          "'budget-spent': there may be other hits. 'at-rounding': an interval stays wider than requested."},
    Field{"hits", &RayHits::hits, "By the lower ends of their intervals, in which all hits lie."},
    Field{"certain_hit", &RayHits::certain_hit, "Is it proved that there is a hit?"},
    Field{"certain_miss", &RayHits::certain_miss, "Is it proved that there is none?"},
};

template <>
inline constexpr auto fields_of<QuickHit> = std::tuple{
    Field{"t", &QuickHit::t, "In lengths of the direction; infinite: nothing."},
    Field{"at", &QuickHit::at, "Where it lies, roughly."},
    Field{"normal", &QuickHit::normal, "Roughly, of length 1 or 0."},
};

template <>
inline constexpr auto fields_of<SurfacePoint> = std::tuple{
    Field{"point", &SurfacePoint::point, "The limit point."},
    Field{"error", &SurfacePoint::error, "Upper bound, per coordinate, of its distance from the exact one."},
    Field{"tangents", &SurfacePoint::tangents,
          "Derivatives in u and v where they exist, else two limit tangents."},
    Field{"differentiable", &SurfacePoint::differentiable, "Are `tangents` derivatives?"},
    Field{"normal", &SurfacePoint::normal, "Unit normal, if there is one."},
    Field{"normal_error", &SurfacePoint::normal_error,
          "Upper bound of |normal - exact normal|, where one is proved."},
};

// Answers about a mesh.

template <>
inline constexpr auto fields_of<Defect> = std::tuple{
    Field{"kind", &Defect::kind, "What is wrong."},
    Field{"text", &Defect::text, "A line that names the elements."},
};

template <>
inline constexpr auto fields_of<MeshCounts> = std::tuple{
    Field{"used_vertices", &MeshCounts::used_vertices, "Vertices of faces."},
    Field{"edges", &MeshCounts::edges, "Edges of faces."},
    Field{"boundary_edges", &MeshCounts::boundary_edges, "Edges with one face."},
    Field{"borders", &MeshCounts::borders, "Sets of these joined by vertices."},
    Field{"many_sided_edges", &MeshCounts::many_sided_edges, "Edges with three faces or more."},
    Field{"components", &MeshCounts::components, "Sets of faces joined by vertices."},
    Field{"min_valence", &MeshCounts::min_valence, "Least number of edges at a used vertex."},
    Field{"max_valence", &MeshCounts::max_valence, "Largest number of edges at a used vertex."},
    Field{"extraordinary", &MeshCounts::extraordinary, "Used vertices unlike those of a regular lattice."},
    Field{"creases", &MeshCounts::creases, "Tags on edges of faces."},
    Field{"needles", &MeshCounts::needles, "Faces narrower than a hundredth of their longest side."},
    Field{"closed", &MeshCounts::closed, "Do along every edge as many faces run one way as the other?"},
};

template <>
inline constexpr auto fields_of<Coincidences> = std::tuple{
    Field{"vertices", &Coincidences::vertices, "Vertices that stand exactly where another one stands."},
    Field{"places", &Coincidences::places, "Where these stand."},
    Field{"edges", &Coincidences::edges, "Edges with one face that stand where another such edge stands."},
    Field{"near", &Coincidences::near, "Further vertices that welding by `reach` would join."},
    Field{"nearest", &Coincidences::nearest, "Least distance of one of them from what it would become."},
    Field{"farthest", &Coincidences::farthest, "Largest distance of one of them from what it would become."},
    Field{"on_edges", &Coincidences::on_edges,
          "Vertices of edges with one face within `reach` of another such edge."},
    Field{"reach", &Coincidences::reach, "2^-17 of the longest side of the box around the mesh."},
};

// Answers that are made from a surface.

template <>
inline constexpr auto fields_of<BoundSummary> = std::tuple{
    Field{"count", &BoundSummary::count, "Number of enclosures."},
    Field{"max_radius", &BoundSummary::max_radius, "The largest radius."},
    Field{"outcome", &BoundSummary::outcome,
          "'complete', 'budget-spent', or 'at-rounding' where 60 levels or rounding ended splitting."},
    Field{"splits", &BoundSummary::splits, "Splits in all."},
};

template <>
inline constexpr auto fields_of<Tessellation> = std::tuple{
    Field{"positions", &Tessellation::positions, "Corners of triangles."},
    Field{"normals", &Tessellation::normals, "Unit limit normals at `positions`, 0 0 0 where there is none."},
    Field{"triangles", &Tessellation::triangles, "Rows of `positions`, oriented as the faces."},
    Field{"owners", &Tessellation::owners,
          "Of each triangle the face of the surface (of dual schemes the vertex)."},
    Field{"error_bound", &Tessellation::error_bound,
          "Proved: triangles and surface are nowhere farther apart, either way."},
    Field{"position_error", &Tessellation::position_error,
          "Upper bound, per coordinate, of |position - limit point|."},
    Field{"outcome", &Tessellation::outcome,
          "'complete', or 'budget-spent' where max_splits or max_triangles ended refinement."},
};

template <>
inline constexpr auto fields_of<Hull> = std::tuple{
    Field{"positions", &Hull::positions, "Corners of triangles."},
    Field{"triangles", &Hull::triangles, "Rows of `positions`."},
    Field{"owners", &Hull::owners, "Of each triangle the face of the surface (of dual schemes the vertex)."},
    Field{"gap", &Hull::gap,
          "Neither the hull nor the surface has a point farther than this from the other."},
};

template <>
inline constexpr auto fields_of<HullProblem> = std::tuple{
    Field{"fault", &HullProblem::fault, "What failed."},
    Field{"inner", &HullProblem::inner, "Is it the inner hull's?"},
    Field{"place", &HullProblem::place, "A point there."},
    Field{"owner", &HullProblem::owner, "The face there (of dual schemes the vertex)."},
};

template <>
inline constexpr auto fields_of<Brep> = std::tuple{
    Field{"error_bound", &Brep::error_bound,
          "Proved: at every parameter a face is no farther than this from the limit point there."},
    Field{"gap_bound", &Brep::gap_bound,
          "Proved: borders of faces are no farther than this from the edges and vertices on them."},
    Field{"break_angle", &Brep::break_angle,
          "Degrees: the largest angle between faces measured across edges where the surface is smooth."},
    Field{"outcome", &Brep::outcome,
          "'complete': error and angle are as small as requested; else 'budget-spent' or 'at-rounding'."},
    Field{"solids", fields::solids, "Closed shells that are not voids."},
    Field{"voids", fields::voids, "Closed shells that are voids of solids."},
    Field{"sheets", fields::sheets, "Open shells."},
    Field{"faces", fields::face_count, "Number of faces."},
    Field{"edges", fields::edge_count, "Number of edges."},
    Field{"spans", &Brep::spans, "Polynomial pieces in all faces."},
};

template <>
inline constexpr auto fields_of<Hulls> = std::tuple{
    Field{"closed", &Hulls::closed, "Does the surface bound a solid?"},
    Field{"inner", &Hulls::inner, "Behind the surface, inside the solid."},
    Field{"outer", &Hulls::outer, "In front of the surface, around the solid."},
    Field{"outcome", &Hulls::outcome, fields::proved_if_complete},
    Field{"problems", &Hulls::problems, fields::problems},
};

template <>
inline constexpr auto fields_of<Envelope> = std::tuple{
    Field{"positions", &Envelope::positions, "Corners of triangles."},
    Field{"triangles", &Envelope::triangles, "Rows of `positions`, oriented outward."},
    Field{"error", &Envelope::error, "No point of it is farther than this from the surface."},
    Field{"clearance", &Envelope::clearance, "And none is nearer than this."},
    Field{"volume", &Envelope::volume, "Contains the volume of the solid that it bounds."},
    Field{"bridges", &Envelope::bridges,
          "With a gap: rows of `triangles` that are across what it fills, where `error` does not hold."},
    Field{"bridge_distance", &Envelope::bridge_distance,
          "No point of these is farther than this from the surface."},
    Field{"outcome", &Envelope::outcome, fields::proved_if_complete},
    Field{"problems", &Envelope::problems, fields::problems},
};

template <>
inline constexpr auto fields_of<fields::MeasureStats> = std::tuple{
    Field{"splits", &fields::MeasureStats::splits, "Pieces split."},
};

template <>
inline constexpr auto fields_of<Measures> = std::tuple{
    Field{"outcome", &Measures::outcome,
          "'complete': all are as narrow as requested; else 'budget-spent' or 'at-rounding'."},
    Field{"area", &Measures::area, "Contains the area."},
    Field{"closed", &fields::is_closed, "Does the surface bound a solid?"},
    Field{"volume", &Measures::volume, "Contains the volume, if the surface is closed."},
    Field{"centroid", &Measures::centroid, "x, y, z; none where the volume may be 0."},
    Field{"inertia", &Measures::inertia,
          "xx, yy, zz, xy, yz, zx of the tensor about the centroid with density 1; none likewise."},
    Field{"stats", &fields::measure_stats, fields::work},
};

template <>
inline constexpr auto fields_of<OneSidedDistance> = std::tuple{
    Field{"distance", &OneSidedDistance::distance,
          "Contains the greatest distance of a point of one set from the other, in mesh units."},
    Field{"point", &fields::farthest, "The farthest point found."},
    Field{"error", &fields::farthest_error,
          "Upper bound, per coordinate, of the distance of `point` from its set."},
    Field{"at", &fields::farthest_place, "Where it lies, if its set is a surface."},
    Field{"nearest", &OneSidedDistance::to, "A point of the other set near it."},
};

template <>
inline constexpr auto fields_of<Deviation> = std::tuple{
    Field{"from_surface", &Deviation::from_surface, "Of points of the surface from the candidate."},
    Field{"from_candidate", &Deviation::from_candidate, "Of points of the candidate from the surface."},
    Field{"inside", &Deviation::inside, "With solid: how far the candidate lies inside."},
    Field{"outside", &Deviation::outside, "With solid: how far the candidate lies outside."},
    Field{"verdict", &Deviation::verdict, "With a threshold: 'within', 'exceeds' or 'undecided'."},
    Field{
        "outcome", &Deviation::outcome,
        "'complete': each interval is as narrow as requested or, with a threshold, each question answered."},
};

}  // namespace snug
