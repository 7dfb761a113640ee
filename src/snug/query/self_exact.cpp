#include <snug/query/self_exact.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include <snug/geometry/double_double.h>
#include <snug/geometry/exact_sign.h>
#include <snug/query/self_pieces.h>
#include <snug/shape/normal_cone.h>
#include <support/direction.h>

namespace snug {
namespace {

// Of pieces that are looked at for their side.
constexpr unsigned fold_levels = 4;
// Weights of limit points of curves, 1/6 and 2/3, are known this well.
constexpr double weight_error = 1e-12;

// Scaling may round small coordinates, and then tells nothing exactly.
bool scaled_exactly(const LimitSurface& surface, VertexId vertex) {
  const Point3& p = surface.mesh().points[vertex.index()];
  const PowerOfTwo scale = surface.scale();
  return scale.exact(p.x) && scale.exact(p.y) && scale.exact(p.z);
}

using Coordinates = std::tuple<double, double, double>;
Coordinates coordinates(const Point3& p) {
  // -0 and 0 are one.
  return {p.x + 0.0, p.y + 0.0, p.z + 0.0};
}

// A vertex by what its limit point is made of: its control point alone, or with its two neighbours on a curve.
struct Corner {
  VertexId vertex;
  std::array<Coordinates, 3> points;
};
std::optional<Corner> corner_of(const LimitSurface& surface, const Stencils::Row& row,
                                const std::vector<VertexId>& names) {
  std::optional<VertexId> own;
  std::vector<Coordinates> others;
  for (std::size_t i = 0; i < row.sources.size(); ++i) {
    const VertexId vertex = names[row.sources[i]];
    const double weight = row.weights[i];
    if (weight == 0) continue;
    if (!scaled_exactly(surface, vertex)) return std::nullopt;
    if (std::fabs(weight - (row.sources.size() == 1 ? 1 : 2.0 / 3)) <= weight_error && !own) {
      own = vertex;
    } else if (std::fabs(weight - 1.0 / 6) <= weight_error) {
      others.push_back(coordinates(surface.scaled_point(vertex)));
    } else {
      return std::nullopt;
    }
  }
  if (!own || (others.size() != 0 && others.size() != 2)) return std::nullopt;
  std::sort(others.begin(), others.end());
  const Coordinates at = coordinates(surface.scaled_point(*own));
  if (others.empty()) return Corner{*own, {at, at, at}};
  return Corner{*own, {at, others[0], others[1]}};
}

// Is there sharpness that decays? Of hardly any a limit point is nearly that of a curve, and not exactly.
bool has_semi_sharp(const Kind& kind) {
  if (kind.key().plain()) return false;
  const Sharpness& all = kind.key().around->sharpness;
  return std::any_of(all.edges.begin(), all.edges.end(), is_semi_sharp) ||
         std::any_of(all.vertices.begin(), all.vertices.end(), is_semi_sharp);
}

// The normal of the plane that all control points are in, if they are; about.
std::optional<Vector3> plane_of(const LimitSurface& surface) {
  std::vector<const Point3*> points;
  for (std::size_t v = 0; v < surface.topology().vertex_count(); ++v) {
    const VertexId vertex(static_cast<std::uint32_t>(v));
    if (std::binary_search(surface.isolated().begin(), surface.isolated().end(), vertex)) continue;
    points.push_back(&surface.scaled_point(vertex));
    if (!may_be_signed(*points.back()) || !scaled_exactly(surface, vertex)) return std::nullopt;
  }
  if (points.empty()) return std::nullopt;
  const auto on_line = [](const Point3& a, const Point3& b, const Point3& c) {
    return orientation(a, b, c, Projection{0, 1}) == 0 && orientation(a, b, c, Projection{1, 2}) == 0 &&
           orientation(a, b, c, Projection{2, 0}) == 0;
  };
  const auto other =
      std::find_if(points.begin(), points.end(), [&](const Point3* p) { return *p != *points[0]; });
  if (other == points.end()) return std::nullopt;
  const auto third = std::find_if(points.begin(), points.end(),
                                  [&](const Point3* p) { return !on_line(*points[0], **other, *p); });
  if (third == points.end()) return std::nullopt;
  const bool plane = std::all_of(points.begin(), points.end(), [&](const Point3* p) {
    return orientation(*points[0], **other, **third, *p) == 0;
  });
  if (!plane) return std::nullopt;
  return normalized(cross(**other - *points[0], **third - *points[0]));
}

// On which side a piece in a plane is, all over; 0 where that is not seen. Its normals are the plane's or the opposite ones.
int side_of(const Patch& piece, const Vector3& normal) {
  const std::optional<NormalCone> cone = normal_cone(piece);
  if (!cone || cone->angle > 0.5) return 0;
  const double along = dot(cone->axis, normal) / length(cone->axis);
  return along > 0.8 ? 1 : along < -0.8 ? -1 : 0;
}

// The vertex that a sector is at, if it is one of the mesh; of faces that are patches, and where all around it is smooth, or sharp for ever.
std::optional<VertexId> vertex_of(const LimitSurface& surface, const LevelStar::Sector& sector) {
  const PieceName& piece = sector.piece;
  const unsigned centre = sector.centre;
  if (surface.after_first_split(piece.patch) || !surface.kind(piece.patch).key().plain()) return std::nullopt;
  for (unsigned k = 0; k < piece.path.level(); ++k) {
    if (piece.path.digit(k) != centre) return std::nullopt;
  }
  const std::uint32_t name = surface.corner_names(piece.patch)[centre];
  if (name >= surface.topology().vertex_count()) return std::nullopt;
  return VertexId(name);
}

// Are differences from a vertex added up to nothing? False where a sum is not a double.
class Balance {
 public:
  void add(const Vector3& difference) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto [sum, rest] = exact_sum(sum_[a], difference[a]);
      sum_[a] = sum;
      exact_ = exact_ && rest == 0;
    }
  }
  void add(const Point3& from, const Point3& to) {
    for (std::size_t a = 0; a < 3; ++a) exact_ = exact_ && exact_sum(to[a], -from[a]).low == 0;
    add(to - from);
  }
  [[nodiscard]] bool holds() const { return exact_ && sum_ == Vector3{}; }

 private:
  Vector3 sum_;
  bool exact_ = true;
};

}  // namespace

bool is_balanced(const LimitSurface& surface, const LevelStar& fan) {
  if (!fan.fan || !fan.closed || !surface.rules().primal) return false;
  const std::optional<VertexId> vertex = vertex_of(surface, fan.sectors[0]);
  if (!vertex) return false;
  const Point3& at = surface.scaled_point(*vertex);
  Balance spokes, corners;
  std::set<std::uint32_t> faces;
  for (const LevelStar::Sector& sector : fan.sectors) {
    const PatchId patch = sector.piece.patch;
    if (vertex_of(surface, sector) != vertex) return false;
    const Kind& kind = surface.kind(patch);
    const CornerFan& corner = kind.corner((sector.centre + 3 - surface.first(patch)) % 3);
    if (!corner.closed || !corner.sharp || corner.odd) return false;
    if (!faces.insert(surface.place(patch).owner).second) continue;
    const std::span<const VertexId> face = surface.topology().face(FaceId(surface.place(patch).owner));
    const std::size_t count = face.size();
    const auto own = static_cast<std::size_t>(std::find(face.begin(), face.end(), *vertex) - face.begin());
    for (std::size_t k = 1; k < count; ++k) {
      const VertexId other = face[(own + k) % count];
      if (!scaled_exactly(surface, other)) return false;
      (k == 1 || k + 1 == count ? spokes : corners).add(at, surface.scaled_point(other));
    }
  }
  return scaled_exactly(surface, *vertex) && spokes.holds() && corners.holds();
}

bool are_parted_by_facet(const LimitSurface& surface, const LevelStar::Sector& a,
                         const LevelStar::Sector& b) {
  const std::optional<VertexId> vertex = vertex_of(surface, a);
  if (!vertex || vertex_of(surface, b) != vertex || a.piece.path.level() + b.piece.path.level() > 0)
    return false;
  const Point3& at = surface.scaled_point(*vertex);
  std::array<std::vector<VertexId>, 2> names;
  surface.control_vertices(a.piece.patch, names[0]);
  surface.control_vertices(b.piece.patch, names[1]);
  for (std::vector<VertexId>& own : names) {
    std::erase(own, *vertex);
    for (const VertexId v : own) {
      if (!may_be_signed(surface.scaled_point(v)) || !scaled_exactly(surface, v)) return false;
    }
  }
  if (!may_be_signed(at) || !scaled_exactly(surface, *vertex)) return false;
  const auto sides = [&](const Point3& p, const Point3& q, const std::vector<VertexId>& of) {
    std::set<int> signs;
    for (const VertexId v : of) signs.insert(orientation(at, p, q, surface.scaled_point(v)));
    return signs;
  };
  for (const std::size_t s : {0, 1}) {
    const std::vector<VertexId>&own = names[s], &other = names[1 - s];
    for (std::size_t i = 1; i < own.size(); ++i) {
      const Point3 &p = surface.scaled_point(own[i - 1]), &q = surface.scaled_point(own[i]);
      const std::set<int> in_front = sides(p, q, other);
      // p and q are in the plane.
      if (in_front.size() == 1 && !sides(p, q, own).contains(*in_front.begin())) return true;
    }
  }
  return false;
}

std::vector<PieceContact> coincident_vertices(const LimitSurface& surface) {
  std::vector<PieceContact> found;
  if (!surface.rules().primal) return found;
  struct Known {
    VertexId vertex;
    PieceName piece;
    TriangleParameter at;
  };
  std::map<std::array<Coordinates, 3>, std::vector<Known>> all;
  std::vector<VertexId> names;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    const PatchId patch(static_cast<std::uint32_t>(p));
    if (!surface.has_patch(patch) || surface.after_first_split(patch)) continue;
    const Kind& kind = surface.kind(patch);
    if (has_semi_sharp(kind)) continue;
    surface.control_vertices(patch, names);
    const Patch whole = surface.patch(patch);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = corner_of(surface, kind.corner_limits().row(whole.to_kind(k)), names);
      if (!corner) continue;
      std::vector<Known>& here = all[corner->points];
      if (std::any_of(here.begin(), here.end(),
                      [&](const Known& known) { return known.vertex == corner->vertex; }))
        continue;
      here.push_back({corner->vertex, {patch, {}}, {k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0}});
      if (here.size() > 1)
        found.push_back({{here[0].piece, here.back().piece}, {here[0].at, here.back().at}});
    }
  }
  return found;
}

std::vector<PieceContact> flat_folds(const SurfaceBvh& model) {
  const LimitSurface& surface = model.surface();
  const std::optional<Vector3> normal = plane_of(surface);
  if (!normal) return {};
  PieceCache pieces = pieces_of_self(model);
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    const PatchId patch(static_cast<std::uint32_t>(p));
    if (!surface.has_patch(patch)) continue;
    pieces.begin(max_bytes_of_self);
    std::vector<PieceName> level{{patch, {}}};
    std::array<std::optional<PieceName>, 2> sides;
    for (unsigned depth = 0; depth <= fold_levels; ++depth) {
      std::vector<PieceName> next;
      for (const PieceName& piece : level) {
        const int side = side_of(pieces.patch(piece), *normal);
        if (side != 0) {
          sides[side > 0 ? 0 : 1] = piece;
        } else {
          for (unsigned child = 0; child < 4; ++child) next.push_back(piece.child(child));
        }
      }
      if (sides[0] && sides[1]) {
        constexpr TriangleParameter middle{1.0 / 3, 1.0 / 3};
        return {{{*sides[0], *sides[1]}, {middle, middle}}};
      }
      level = std::move(next);
    }
  }
  return {};
}

}  // namespace snug
