#include <snug/query/facet_contacts.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include <snug/geometry/rounding.h>
#include <snug/search/facet.h>

namespace snug {
namespace {

// Products of entries of poses, coordinates and scales are multiples of 2^-353, and so products of three of them of 2^-1059.
constexpr double min_factor = 0x1p-90, min_scale = 0x1p-60, min_offset = 0x1p-290;

bool fits(double x, double least) { return x == 0 || std::fabs(x) >= least; }
bool fits(const Vector3& v, double least) { return fits(v.x, least) && fits(v.y, least) && fits(v.z, least); }

constexpr Rows3 unmoved{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};

}  // namespace

FacetContacts::FacetContacts(const PairFrames& frames, const PlacedBvh& placed_a, const PlacedBvh& placed_b)
    : frames_(frames) {
  const PlacedFrame &a = frames.frame(0), &b = frames.frame(1);
  const PowerOfTwo world = frames.to_mesh_units().inverse();
  for (const Motion* pose : {&placed_a.pose, &placed_b.pose}) {
    const Vector3 t = pose->offset();
    comparable_ = comparable_ && world.exact(t.x) && world.exact(t.y) && world.exact(t.z);
  }
  for (const PlacedFrame* frame : {&a, &b}) {
    comparable_ = comparable_ && frame->deviation == 0 && frame->scale >= min_scale &&
                  frame->scale <= 1 / min_scale && fits(frame->translation, min_offset);
    for (const Vector3& row : frame->rows) comparable_ = comparable_ && fits(row, min_factor);
  }
  for (std::size_t s = 0; s < 2; ++s) comparable_ = comparable_ && surface(s).rules().primal;
  if (a.rows == b.rows && a.translation == b.translation) {
    common_ = a;
    common_->scale = 1;
  }
}

std::optional<ExactPoint> FacetContacts::placed(std::size_t side, VertexId vertex) const {
  const Vector3 p = surface(side).scaled_point(vertex) - Point3{};
  if (!fits(p, min_factor)) return std::nullopt;
  const PlacedFrame& frame = frames_.frame(side);
  if (common_) return ExactPoint(Point3{} + frame.scale * p);
  std::array<ExactNumber, 3> sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum[i] = ExactNumber(frame.translation[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      const DoubleDouble product = exact_product(frame.rows[i][k], frame.scale * p[k]);
      sum[i].add(product.low);
      sum[i].add(product.high);
    }
  }
  return ExactPoint(std::move(sum));
}

std::optional<PlaneFacet> FacetContacts::made(std::size_t side, std::uint32_t owner) const {
  const LimitSurface& from = surface(side);
  const PatchId patch(static_cast<std::uint32_t>(from.patches_of(owner).begin));
  if (!from.has_patch(patch) || !is_exact_facet(from, FaceId(owner), patch)) return std::nullopt;
  std::vector<ExactPoint> corners;
  for (const VertexId v : from.topology().face(FaceId(owner))) {
    std::optional<ExactPoint> corner = placed(side, v);
    if (!corner) return std::nullopt;
    corners.push_back(std::move(*corner));
  }
  return PlaneFacet::made(std::move(corners));
}

const std::optional<PlaneFacet>& FacetContacts::facet(std::size_t side, std::uint32_t owner) {
  const auto [at, added] = facets_[side].try_emplace(owner);
  if (added) at->second = made(side, owner);
  return at->second;
}

const FacetMeeting* FacetContacts::between(std::uint32_t a, std::uint32_t b) {
  if (!comparable_) return nullptr;
  const std::optional<PlaneFacet>&x = facet(0, a), &y = facet(1, b);
  if (!x || !y) return nullptr;
  const auto [at, added] = known_.try_emplace({a, b});
  if (!added) return &at->second;
  FacetMeeting& meeting = at->second;
  meeting = meet(*x, *y);
  for (BoundedPoint& corner : meeting.corners) corner = posed(corner);
  return &meeting;
}

// From where facets are compared to the frames' units.
BoundedPoint FacetContacts::posed(const BoundedPoint& point) const {
  if (!common_ || (common_->rows == unmoved && common_->translation == Vector3{})) return point;
  return common_->apply(point);
}

// The vertices at corners of a face, in rising order.
std::vector<std::uint32_t> FacetContacts::names(std::size_t side, std::uint32_t face,
                                                const std::vector<std::size_t>& corners) const {
  const std::span<const VertexId> vertices = surface(side).topology().face(FaceId(face));
  std::vector<std::uint32_t> result;
  for (const std::size_t k : corners) result.push_back(vertices[k].value());
  std::sort(result.begin(), result.end());
  return result;
}

// Is an element of a face a corner or an edge at which the surface ends?
bool FacetContacts::on_border(std::size_t side, std::uint32_t face,
                              const std::vector<std::size_t>& corners) const {
  const Topology& topology = surface(side).topology();
  const std::span<const VertexId> vertices = topology.face(FaceId(face));
  if (corners.size() == 1) return topology.on_boundary(vertices[corners[0]]);
  if (corners.size() > 2) return false;
  const std::size_t first = corners[0] + 1 == corners[1] ? corners[0] : corners[1];
  return topology.on_boundary(
      topology.edge_of(topology.first_of(FaceId(face)) + static_cast<HalfEdge>(first)));
}

std::vector<FacetContacts::Touching> FacetContacts::touching() const {
  struct Contact {
    Touching touching;
    std::array<std::vector<std::uint32_t>, 2> names;
  };
  std::vector<Contact> all;
  for (const auto& [faces, meeting] : known_) {
    if (meeting.state != FacetMeeting::State::touching) continue;
    Contact contact{{faces, &meeting}, {}};
    for (std::size_t s = 0; s < 2; ++s) contact.names[s] = names(s, faces[s], meeting.elements[s]);
    all.push_back(std::move(contact));
  }
  // By each vertex of A and of B that a contact names.
  using Entry = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;
  std::vector<Entry> entries;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    for (const std::uint32_t u : all[i].names[0]) {
      for (const std::uint32_t v : all[i].names[1]) entries.emplace_back(u, v, i);
    }
  }
  std::sort(entries.begin(), entries.end());
  // All that an edge of A and one of B have in common is in what faces at them have.
  const auto holds = [&](std::uint32_t larger, std::uint32_t smaller) {
    const auto &x = all[larger].names, &y = all[smaller].names;
    if (x == y) return larger < smaller;
    return std::includes(x[0].begin(), x[0].end(), y[0].begin(), y[0].end()) &&
           std::includes(x[1].begin(), x[1].end(), y[1].begin(), y[1].end());
  };
  std::vector<Touching> result;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const std::uint32_t u = all[i].names[0].front(), v = all[i].names[1].front();
    const auto begin = std::lower_bound(entries.begin(), entries.end(), Entry(u, v, 0));
    const bool held =
        std::any_of(begin,
                    std::find_if(begin, entries.end(),
                                 [&](const Entry& e) { return std::get<0>(e) != u || std::get<1>(e) != v; }),
                    [&](const Entry& e) { return holds(std::get<2>(e), i); });
    if (!held) result.push_back(all[i].touching);
  }
  return result;
}

std::vector<FacetContacts::Crossing> FacetContacts::crossings() const {
  std::vector<Crossing> result;
  // By the elements of A and of B that an end is the only common point of.
  using Ends = std::vector<std::uint32_t>;
  std::map<std::array<std::vector<std::uint32_t>, 2>, Ends> at;
  for (const auto& [faces, meeting] : known_) {
    if (meeting.state != FacetMeeting::State::crossing) continue;
    Crossing crossing{{faces, &meeting}};
    for (std::uint32_t e = 0; e < 2; ++e) {
      const auto& [of_a, of_b] = meeting.ends[e];
      at[{names(0, faces[0], of_a), names(1, faces[1], of_b)}].push_back(
          static_cast<std::uint32_t>(2 * result.size() + e));
      crossing.at_border[e] = on_border(0, faces[0], of_a) || on_border(1, faces[1], of_b);
    }
    result.push_back(crossing);
  }
  std::vector<std::uint32_t> point_of(2 * result.size());
  std::uint32_t point = 0;
  for (const auto& [elements, ends] : at) {
    for (const std::uint32_t end : ends) point_of[end] = point;
    ++point;
  }
  const auto next = [&](std::uint32_t end) -> std::uint32_t& { return result[end / 2].next[end % 2]; };
  for (const auto& [elements, ends] : at) {
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (std::size_t k = i + 1; k < ends.size() && next(ends[i]) == Crossing::none; ++k) {
        // Not one that leads back: the same segment of faces that stand twice.
        if (next(ends[k]) != Crossing::none || point_of[ends[i] ^ 1u] == point_of[ends[k] ^ 1u]) continue;
        next(ends[i]) = ends[k];
        next(ends[k]) = ends[i];
      }
    }
  }
  return result;
}

}  // namespace snug
