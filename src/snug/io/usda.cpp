#include <snug/io/formats.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <snug/io/transform.h>
#include <snug/io/usda_prims.h>
#include <snug/scheme/scheme.h>
#include <support/error.h>
#include <support/names.h>
#include <support/number.h>
#include <support/read_file.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

constexpr auto boundary_names =
    std::to_array<Named<BoundaryRule>>({{"edgeAndCorner", BoundaryRule::edge_and_corner},
                                        {"edgeOnly", BoundaryRule::edge_only},
                                        {"none", BoundaryRule::none}});
constexpr auto triangle_names = std::to_array<Named<SmoothTriangles>>(
    {{"catmullClark", SmoothTriangles::catmark}, {"smooth", SmoothTriangles::smooth}});
/// `none` is flat here: polygons as they are.
constexpr auto scheme_names = std::to_array<Named<Scheme>>({{"catmullClark", Scheme::catmark},
                                                            {"loop", Scheme::loop},
                                                            {"bilinear", Scheme::bilinear},
                                                            {"none", Scheme::flat}});

/// Why a prim does not count.
enum class LeftOut : std::uint8_t { none, over, abstract, inactive, invisible, guide, proxy };
constexpr auto reasons = std::to_array<Named<LeftOut>>({{"only over, without a definition", LeftOut::over},
                                                        {"a class", LeftOut::abstract},
                                                        {"not active", LeftOut::inactive},
                                                        {"invisible", LeftOut::invisible},
                                                        {"of the purpose guide", LeftOut::guide},
                                                        {"of the purpose proxy", LeftOut::proxy}});

/// Properties that a prim inherits from its ancestors.
struct Inherited {
  LeftOut structure = LeftOut::none;  // over, abstract or inactive
  bool invisible = false;
  std::string_view purpose;
  std::uint32_t map = 0;  // of those known

  [[nodiscard]] LeftOut left_out() const {
    if (structure != LeftOut::none) return structure;
    if (invisible) return LeftOut::invisible;
    return purpose == "guide" ? LeftOut::guide : purpose == "proxy" ? LeftOut::proxy : LeftOut::none;
  }
};

/// Shapes that are not meshes.
bool is_other_shape(std::string_view type) {
  constexpr std::array<std::string_view, 13> types{
      "Sphere", "Cube",        "Cylinder",   "Cylinder_1",    "Capsule", "Capsule_1", "Cone",
      "Plane",  "BasisCurves", "NurbsPatch", "HermiteCurves", "TetMesh", "Points"};
  return std::ranges::find(types, type) != types.end();
}

/// Makes one control mesh of the prims that count, or one of each.
class Assembler {
 public:
  Assembler(const UsdaStage& stage, const std::string& name, const Notes& notes)
      : stage_(stage), name_(name), notes_(notes), inherited_(stage.prims.size()) {}

  ControlMesh assemble() {
    visit_prims();
    set_rules();
    mesh_.metres_per_unit = stage_.metres_per_unit;
    return std::move(mesh_);
  }

  PlacedMeshes assemble_apart() {
    apart_.emplace();
    visit_prims();
    return std::move(*apart_);
  }

 private:
  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const {
    fail_in_file(name_ + ':' + std::to_string(line), message);
  }

  [[nodiscard]] std::string path_of(std::size_t p) const {
    std::string path;
    for (; p != UsdaPrim::no_parent; p = stage_.prims[p].parent) {
      path.insert(0, '/' + std::string(stage_.prims[p].name));
    }
    return path;
  }
  [[nodiscard]] std::string quoted_path(std::size_t p) const { return in_quotes(path_of(p)); }

  void visit_prims() {
    for (std::size_t p = 0; p < stage_.prims.size(); ++p) {
      inherit(p);
      if (inherited_[p].left_out() == LeftOut::none) {
        refuse_content_from_elsewhere(p);
        if (stage_.prims[p].mesh) apart_ ? add_apart(p) : add(p);
        if (is_other_shape(stage_.prims[p].type)) others_.push_back(p);
      } else if (stage_.prims[p].mesh) {
        left_out_[inherited_[p].left_out()].push_back(p);
      }
    }
    write_notes();
    if (used_.empty()) fail_in_file(name_, "the file has no mesh that is defined, visible and for rendering");
  }

  // --- what prims inherit

  void inherit(std::size_t p) {
    const UsdaPrim& prim = stage_.prims[p];
    Inherited& own = inherited_[p];
    if (prim.parent != UsdaPrim::no_parent) own = inherited_[prim.parent];
    if (own.structure == LeftOut::none) {
      own.structure = prim.specifier == UsdaSpecifier::over       ? LeftOut::over
                      : prim.specifier == UsdaSpecifier::abstract ? LeftOut::abstract
                      : !prim.active                              ? LeftOut::inactive
                                                                  : LeftOut::none;
    }
    own.invisible = own.invisible || prim.invisible;
    if (!prim.purpose.empty()) own.purpose = prim.purpose;
    // A scope has no place of its own, nor has a prim without a type.
    const bool has_place = !prim.type.empty() && prim.type != "Scope";
    if (has_place && prim.operations && own.left_out() == LeftOut::none) place(p);
  }

  void place(std::size_t p) {
    const UsdaPrim& prim = stage_.prims[p];
    const UsdaOperations& operations = *prim.operations;
    AffineEnclosure local;
    bool resets = false;
    for (std::string_view name : operations.order) {
      if (name == "!resetXformStack!") {
        resets = true;
        local = {};
        continue;
      }
      constexpr std::string_view invert = "!invert!", front = "xformOp:";
      const bool inverse = name.starts_with(invert);
      if (inverse) name.remove_prefix(invert.size());
      refuse_samples(prim, name);
      const auto given = operations.given.find(name);
      if (given == operations.given.end()) {
        fail_at(operations.order_line,
                "xformOpOrder names " + in_quotes(name) + ", which the prim does not have");
      }
      // "xformOp:KIND" or "xformOp:KIND:SUFFIX"
      const std::string_view kind = name.substr(std::min(front.size(), name.size()));
      const TransformOperation operation =
          transform_operation(kind.substr(0, kind.find(':')), given->second.values, inverse);
      if (!operation.fault.empty()) fail_at(given->second.line, in_quotes(name) + ' ' + operation.fault);
      local = local.after(operation.map);
    }
    Inherited& own = inherited_[p];
    const AffineEnclosure map = resets ? local : maps_[own.map].after(local);
    if (!map.is_finite()) fail_at(operations.order_line, "the transform is beyond the range of doubles");
    if (map == maps_[own.map]) return;
    own.map = static_cast<std::uint32_t>(maps_.size());
    maps_.push_back(map);
  }

  // --- refusals

  void refuse_samples(const UsdaPrim& prim, std::string_view name) const {
    const auto found = std::ranges::find(prim.samples, name, &UsdaPlace::name);
    if (found == prim.samples.end()) return;
    fail_at(found->line, in_quotes(name) + " has values by time, which are not read: export one frame");
  }

  void refuse_content_from_elsewhere(std::size_t p) const {
    const UsdaPrim& prim = stage_.prims[p];
    if (prim.arc.line != 0) {
      fail_at(prim.arc.line, in_quotes(prim.arc.name) +
                                 " are not followed: flatten the file, usdcat --flatten -o flat.usda");
    }
    if (prim.type == "PointInstancer") {
      fail_at(prim.line, "instances are not read: turn those of " + quoted_path(p) + " into meshes");
    }
    for (const UsdaPlace& sample : prim.samples) {
      if (!sample.name.starts_with("xformOp:")) refuse_samples(prim, sample.name);
    }
  }

  // --- meshes

  void add(std::size_t p) {
    const UsdaPrim& prim = stage_.prims[p];
    const UsdaMesh& own = *prim.mesh;
    if (own.face_counts.empty()) {
      empty_.push_back(p);
      return;
    }
    if (own.points.empty()) fail_at(prim.line, quoted_path(p) + " has faces but no points");
    if (mesh_.points.size() + own.points.size() > max_elements ||
        mesh_.face_vertices.size() + own.face_indices.size() > max_elements) {
      fail_at(prim.line,
              "more than " + std::to_string(max_elements) + " vertices or corners: split the mesh");
    }
    const std::size_t first_vertex = mesh_.points.size(), first_face = mesh_.face_count();
    add_points(p);
    add_faces(p, first_vertex);
    add_tags(own, first_vertex, first_face);
    add_rules(p);
    used_.push_back(p);
  }

  void add_apart(std::size_t p) {
    mesh_ = {};
    rules_of_.reset();
    add(p);
    if (mesh_.face_count() == 0) return;
    set_rules();
    mesh_.metres_per_unit = stage_.metres_per_unit;
    apart_->parts.push_back(
        {std::string(stage_.prims[p].name), quoted_path(p), apart_->meshes.size(), maps_[inherited_[p].map]});
    apart_->meshes.push_back(std::move(mesh_));
  }

  void add_points(std::size_t p) {
    const std::vector<Point3>& points = stage_.prims[p].mesh->points;
    const AffineEnclosure& map = maps_[inherited_[p].map];
    if (apart_ || map == AffineEnclosure()) {
      mesh_.points.insert(mesh_.points.end(), points.begin(), points.end());
      return;
    }
    ++moved_;
    for (std::size_t v = 0; v < points.size(); ++v) {
      const std::array<Interval, 3> image = map(points[v]);
      Point3 point;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        point[axis] = middle(image[axis]);
        if (!std::isfinite(point[axis]) || !std::isfinite(radius(image[axis]))) {
          fail_at(stage_.prims[p].line, "vertex " + std::to_string(v) + " of " + quoted_path(p) +
                                            " is moved beyond the range of doubles");
        }
        farthest_ = std::fmax(farthest_, radius(image[axis]));
      }
      mesh_.points.push_back(point);
    }
  }

  void add_faces(std::size_t p, std::size_t first_vertex) {
    const UsdaMesh& own = *stage_.prims[p].mesh;
    const std::size_t counts_line = own.line(UsdaAttribute::face_counts),
                      indices_line = own.line(UsdaAttribute::face_indices);
    const bool left_handed = own.orientation == "leftHanded";
    if (!own.orientation.empty() && !left_handed && own.orientation != "rightHanded") {
      fail_at(own.line(UsdaAttribute::orientation),
              "orientation: " + in_quotes(own.orientation) + " is not one of rightHanded and leftHanded");
    }
    const bool mirrored = !apart_ && maps_[inherited_[p].map].handedness() < 0;
    if (left_handed != mirrored) ++reversed_;
    std::size_t at = 0;
    std::vector<VertexId> corners;
    for (std::size_t f = 0; f < own.face_counts.size(); ++f) {
      const std::int64_t count = own.face_counts[f];
      const std::string face = "face " + std::to_string(f) + ": ";
      if (count <= 0) fail_at(counts_line, face + std::to_string(count) + " is not a number of vertices");
      if (static_cast<std::uint64_t>(count) > own.face_indices.size() - at) {
        fail_at(counts_line,
                face + "faceVertexIndices has only " + std::to_string(own.face_indices.size()) + " values");
      }
      corners.clear();
      for (std::int64_t k = 0; k < count; ++k) {
        corners.emplace_back(first_vertex +
                             index_of(own.face_indices[at++], own.points.size(), indices_line, face));
      }
      if (left_handed != mirrored) std::reverse(corners.begin() + 1, corners.end());
      mesh_.add_face(corners);
    }
    if (at != own.face_indices.size()) {
      fail_at(indices_line, "faceVertexIndices has " + std::to_string(own.face_indices.size()) +
                                " values, and faceVertexCounts add up to " + std::to_string(at));
    }
  }

  std::size_t index_of(std::int64_t index, std::size_t count, std::size_t line,
                       const std::string& what) const {
    if (index < 0 || static_cast<std::uint64_t>(index) >= count) {
      fail_at(line,
              what + "index " + std::to_string(index) + " is outside 0 to " + std::to_string(count - 1));
    }
    return static_cast<std::size_t>(index);
  }

  void add_tags(const UsdaMesh& own, std::size_t first_vertex, std::size_t first_face) {
    add_creases(own, first_vertex);
    const std::size_t line = own.line(UsdaAttribute::corner_sharpness);
    if (own.corner_sharpness.size() != own.corner_indices.size()) {
      fail_at(std::max(line, own.line(UsdaAttribute::corner_indices)),
              std::to_string(own.corner_indices.size()) + " cornerIndices have " +
                  std::to_string(own.corner_sharpness.size()) + " cornerSharpnesses: give one for each");
    }
    for (std::size_t i = 0; i < own.corner_indices.size(); ++i) {
      const std::size_t vertex = index_of(own.corner_indices[i], own.points.size(),
                                          own.line(UsdaAttribute::corner_indices), "cornerIndices: ");
      mesh_.tags.corners.push_back({VertexId(first_vertex + vertex), own.corner_sharpness[i]});
    }
    for (const std::int64_t hole : own.holes) {
      mesh_.tags.holes.emplace_back(first_face + index_of(hole, own.face_counts.size(),
                                                          own.line(UsdaAttribute::holes), "holeIndices: "));
    }
  }

  void add_creases(const UsdaMesh& own, std::size_t first_vertex) {
    const std::size_t indices_line = own.line(UsdaAttribute::crease_indices),
                      lengths_line = std::max(own.line(UsdaAttribute::crease_lengths), indices_line);
    double vertices = 0;
    for (const std::int64_t length : own.crease_lengths) {
      if (length < 2) {
        fail_at(lengths_line, "creaseLengths: " + std::to_string(length) + " is less than two vertices");
      }
      vertices += static_cast<double>(length);
    }
    if (vertices != static_cast<double>(own.crease_indices.size())) {
      fail_at(lengths_line, "creaseLengths do not add up to the " +
                                std::to_string(own.crease_indices.size()) + " creaseIndices");
    }
    const std::size_t creases = own.crease_lengths.size(), sharpnesses = own.crease_sharpness.size();
    const std::size_t edges = own.crease_indices.size() - creases;
    if (sharpnesses != creases && sharpnesses != edges) {
      fail_at(std::max(own.line(UsdaAttribute::crease_sharpness), indices_line),
              std::to_string(sharpnesses) + " creaseSharpnesses: give one for each of " +
                  std::to_string(creases) + " creases, or of " + std::to_string(edges) + " edges");
    }
    std::size_t at = 0, edge = 0;
    for (std::size_t c = 0; c < creases; ++c) {
      VertexId last;
      for (std::int64_t k = 0; k < own.crease_lengths[c]; ++k) {
        const VertexId vertex(first_vertex + index_of(own.crease_indices[at++], own.points.size(),
                                                      indices_line, "creaseIndices: "));
        if (k > 0) {
          const double sharpness = own.crease_sharpness[sharpnesses == edges ? edge++ : c];
          mesh_.tags.creases.push_back({last, vertex, sharpness});
        }
        last = vertex;
      }
    }
  }

  // --- rules

  template <class E, std::size_t n>
  std::optional<E> rule(const UsdaMesh& own, UsdaAttribute attribute, std::string_view word,
                        const std::array<Named<E>, n>& names) const {
    if (own.line(attribute) == 0 || word.empty()) return {};
    const auto value = value_in(names, word);
    if (!value) {
      fail_at(own.line(attribute), std::string(usda_attribute_names[static_cast<std::size_t>(attribute)]) +
                                       ": " + in_quotes(word) + " is not one of " +
                                       listed(all_names(names), "and"));
    }
    return value;
  }

  /// The rules of a mesh as the first one has them; refuses others.
  void add_rules(std::size_t p) {
    const UsdaMesh& own = *stage_.prims[p].mesh;
    const Scheme scheme =
        rule(own, UsdaAttribute::scheme, own.scheme, scheme_names).value_or(Scheme::catmark);
    auto boundary = rule(own, UsdaAttribute::boundary, own.boundary, boundary_names);
    const auto triangles = rule(own, UsdaAttribute::triangle_rule, own.triangle_rule, triangle_names);
    if (scheme == Scheme::flat) boundary.reset();  // polygons have no such rule
    MeshTags& tags = mesh_.tags;
    const bool is_first = !rules_of_;
    if (is_first) {
      tags.scheme = scheme;
      tags.smooth_triangles = triangles.value_or(tags.smooth_triangles);
    }
    const auto is_local = [](Scheme s) { return s == Scheme::flat || s == Scheme::bilinear; };
    const auto effective = [](std::optional<BoundaryRule> r) {
      return r.value_or(BoundaryRule::edge_and_corner);
    };
    const auto refuse = [&](UsdaAttribute attribute) {
      fail_at(stage_.prims[p].line, std::string(usda_attribute_names[static_cast<std::size_t>(attribute)]) +
                                        " of " + quoted_path(p) + " is not that of " +
                                        quoted_path(*rules_of_) + ": write them to different files");
    };
    if (*tags.scheme != scheme && !(is_local(*tags.scheme) && is_local(scheme)))
      refuse(UsdaAttribute::scheme);
    if (!is_first && effective(tags.boundary) != effective(boundary)) refuse(UsdaAttribute::boundary);
    if (tags.smooth_triangles != triangles.value_or(SmoothTriangles::catmark))
      refuse(UsdaAttribute::triangle_rule);
    if (scheme == Scheme::bilinear) tags.scheme = scheme;
    if (boundary) tags.boundary = boundary;
    if (is_first) rules_of_ = p;
  }

  /// Polygons as they are: triangles are flat, others bilinear.
  void set_rules() {
    if (mesh_.tags.scheme != Scheme::flat || scheme_of_faces(mesh_) == Scheme::loop) return;
    mesh_.tags.scheme = Scheme::bilinear;
    if (notes_) {
      notes_(name_ + ": subdivisionScheme none: faces with more than three corners are taken as bilinear");
    }
  }

  // --- notes

  /// "2 meshes are invisible and left out: '/a', '/b'"
  void note_prims(const std::vector<std::size_t>& prims, const std::string& what) const {
    if (prims.empty()) return;
    constexpr std::size_t max_named = 3;
    std::string paths;
    for (std::size_t i = 0; i < std::min(prims.size(), max_named); ++i) {
      paths += (i == 0 ? "" : ", ") + quoted_path(prims[i]);
    }
    if (prims.size() > max_named) paths += " and " + std::to_string(prims.size() - max_named) + " more";
    notes_(name_ + ": " + what + ": " + paths);
  }

  void write_notes() const {
    if (!notes_) return;
    for (const auto& [reason, prims] : left_out_) {
      note_prims(prims, std::string("meshes are left out that are ") + name_in(reasons, reason));
    }
    note_prims(empty_, "meshes without faces are left out");
    note_prims(others_, "shapes that are not meshes are left out");
    if (moved_ > 0) {
      std::string text = name_ + ": points are moved by the transforms of their prims";
      if (farthest_ > 0) {
        text += "; rounding moves a coordinate by at most ";
        append_real(text, farthest_);
      }
      notes_(text);
    }
    if (reversed_ > 0) {
      notes_(name_ + ": faces of left-handed or mirrored meshes are reversed, in " +
             std::to_string(reversed_) + " of " + std::to_string(used_.size()));
    }
    if (stage_.metres_per_unit || !stage_.up_axis.empty()) {
      std::string text = name_ + ':';
      if (stage_.metres_per_unit) {
        text += " metersPerUnit ";
        append_real(text, *stage_.metres_per_unit);
      }
      if (!stage_.up_axis.empty()) text += " upAxis " + in_quotes(stage_.up_axis);
      notes_(text + ": coordinates are taken as they are");
    }
  }

  const UsdaStage& stage_;
  const std::string& name_;
  const Notes& notes_;
  std::vector<Inherited> inherited_;
  std::vector<AffineEnclosure> maps_{AffineEnclosure()};
  ControlMesh mesh_;
  std::optional<PlacedMeshes> apart_;
  std::optional<std::size_t> rules_of_;  // the prim that the rules of mesh_ come from
  std::vector<std::size_t> used_, empty_, others_;
  std::map<LeftOut, std::vector<std::size_t>> left_out_;
  std::size_t moved_ = 0, reversed_ = 0;
  double farthest_ = 0;
};

// --- writing

template <class Values, class Append>
void append_list(std::string& text, const char* head, const Values& values, const Append& append) {
  text.append("    ").append(head).append(" = [");
  bool first = true;
  for (const auto& value : values) {
    if (!first) text += ", ";
    first = false;
    append(value);
  }
  text += "]\n";
}

void append_tuple(std::string& text, const Point3& point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    text += axis == 0 ? "(" : ", ";
    append_real(text, point[axis]);
  }
  text += ')';
}

void append_extent(std::string& text, const ControlMesh& mesh) {
  if (mesh.points.empty()) return;
  Box3 box;
  for (const Point3& point : mesh.points) box.add(point);
  append_list(text, "float3[] extent", std::array{box.lower, box.upper},
              [&](const Point3& corner) { append_tuple(text, corner); });
}

void append_token(std::string& text, const char* head, const char* word) {
  text.append("    ").append(head).append(" = \"").append(word).append("\"\n");
}

/// The scheme as USD names it.
const char* usda_scheme(const ControlMesh& mesh, const std::string& name, const Notes& notes) {
  const Scheme scheme = natural_scheme(mesh);
  if (value_in(scheme_names, name_in(scheme_names, scheme)) != scheme) {
    if (notes) notes(name + ": USD has no scheme " + name_of(scheme) + ": the faces are written as they are");
    return "none";
  }
  // Polygons have no boundary rule; the bilinear patches of triangles are these triangles.
  const bool needs_rule = scheme == Scheme::flat && mesh.tags.boundary == BoundaryRule::none;
  return needs_rule ? "bilinear" : name_in(scheme_names, scheme);
}

void append_tags(std::string& text, const MeshTags& tags) {
  const auto integer = [&](std::uint32_t value) { append_integer(text, value); };
  if (!tags.creases.empty()) {
    append_list(text, "int[] creaseIndices", tags.creases, [&](const CreaseTag& crease) {
      integer(crease.a.value());
      text += ", ";
      integer(crease.b.value());
    });
    append_list(text, "int[] creaseLengths", tags.creases, [&](const CreaseTag&) { text += '2'; });
    append_list(text, "float[] creaseSharpnesses", tags.creases,
                [&](const CreaseTag& crease) { append_real(text, crease.sharpness); });
  }
  if (!tags.corners.empty()) {
    append_list(text, "int[] cornerIndices", tags.corners,
                [&](const CornerTag& tag) { integer(tag.vertex.value()); });
    append_list(text, "float[] cornerSharpnesses", tags.corners,
                [&](const CornerTag& tag) { append_real(text, tag.sharpness); });
  }
  if (!tags.holes.empty()) {
    append_list(text, "int[] holeIndices", tags.holes, [&](const FaceId hole) { integer(hole.value()); });
  }
}

}  // namespace

bool begins_like_usda(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text.starts_with("#usda ") || text.starts_with("#sdf ");
}

namespace {

UsdaStage stage_of(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("PK"))
    fail_in_file(name, "this is a packed USD file: convert it to text, usdcat -o mesh.usda");
  const std::string_view text = plain_text(bytes, name);
  if (!begins_like_usda(text))
    fail_in_file(name, "this is not a USD text: it does not begin with '#usda 1.0'");
  return read_usda_prims(text, name);
}

}  // namespace

ControlMesh parse_usda(std::string_view bytes, const std::string& name, const Notes& notes) {
  const UsdaStage stage = stage_of(bytes, name);
  return Assembler(stage, name, notes).assemble();
}

PlacedMeshes read_usda(std::string_view bytes, const std::string& name, const Notes& notes) {
  const UsdaStage stage = stage_of(bytes, name);
  return Assembler(stage, name, notes).assemble_apart();
}

std::string format_usda(const ControlMesh& mesh, const std::string& name, const Notes& notes) {
  if (mesh.vertex_count() > std::numeric_limits<std::int32_t>::max()) {
    throw InputError(InputProblem::refused, name + ": USD has no indices beyond 2^31: write PLY, OBJ or OFF");
  }
  std::string text = "#usda 1.0\n(\n    defaultPrim = \"mesh\"\n)\n\ndef Mesh \"mesh\"\n{\n";
  text.reserve(mesh.vertex_count() * 64 + mesh.face_vertices.size() * 9 + 1000);
  append_token(text, "uniform token subdivisionScheme", usda_scheme(mesh, name, notes));
  if (mesh.tags.boundary) {
    append_token(text, "token interpolateBoundary", name_in(boundary_names, *mesh.tags.boundary));
  }
  if (mesh.tags.smooth_triangles != MeshTags{}.smooth_triangles) {
    append_token(text, "token triangleSubdivisionRule", name_in(triangle_names, mesh.tags.smooth_triangles));
  }
  if (mesh.tags.crease_method != MeshTags{}.crease_method && notes) {
    notes(name + ": USD has no crease method: it is dropped, and creases are uniform");
  }
  append_extent(text, mesh);
  std::vector<std::uint32_t> counts;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    counts.push_back(mesh.face_offsets[f + 1] - mesh.face_offsets[f]);
    require_value(counts.back() > 0, "USD: a face to write has no corners; take it out");
  }
  append_list(text, "int[] faceVertexCounts", counts,
              [&](std::uint32_t count) { append_integer(text, count); });
  append_list(text, "int[] faceVertexIndices", mesh.face_vertices,
              [&](VertexId vertex) { append_integer(text, vertex.value()); });
  append_list(text, "point3f[] points", mesh.points, [&](const Point3& point) { append_tuple(text, point); });
  append_tags(text, mesh.tags);
  text += "}\n";
  return text;
}

}  // namespace snug
