#include <snug/query/brep_layout.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <snug/patch/limit_evaluator.h>
#include <support/error.h>

namespace snug {
namespace {

using Part = PatchSide::Part;

// Sine of the angle up to which two limit normals count as equal.
constexpr double same_normal = 1e-5;

}  // namespace

BrepLayout::BrepLayout(const LimitSurface& surface)
    : surface_(surface),
      edges_(surface.topology().edge_count()),
      halved_(edges_),
      corner_depths_(surface.corner_name_count(), 1),
      side_depths_(edges_ + surface.patch_count()),
      creases_(corner_depths_.size()),
      crease_end_(side_depths_.size(), none),
      changed_corners_(corner_depths_.size()),
      changed_sides_(side_depths_.size()) {
  if (surface.rules().triangular()) {
    add_quads_of_triangles();
  } else {
    for (std::size_t p = 0; p + 1 < surface.patch_count(); p += 2) {
      const PatchId first(p), second(p + 1);
      if (!surface.has_patch(first)) continue;
      const auto a = surface.corner_names(first), b = surface.corner_names(second);
      const auto s = sides_of(surface, first), t = sides_of(surface, second);
      quads_.push_back(
          {first, {a[0], a[1], a[2], b[1]}, {s[0], s[1], t[0], t[1]}, surface.after_first_split(first)});
      for (const PatchSide& side : quads_.back().sides) {
        if (side.part == Part::first_half || side.part == Part::second_half) halved_[side.number] = true;
      }
    }
  }
  connect();
}

// The lower half has the corners 0, 1 and 2 of the square, the upper one 0, 2 and 3.
void BrepLayout::add_quads_of_triangles() {
  for (const PairedTriangles& pair : paired(surface_)) {
    SurfaceQuad quad{pair.lower, {none, none, none, none}, {}, false, pair};
    const auto names = surface_.corner_names(pair.lower);
    const auto sides = sides_of(surface_, pair.lower);
    for (std::size_t k = 0; k < 3; ++k) {
      quad.corners[k] = names[(k + pair.turn) % 3];
      quad.sides[k] = sides[(k + pair.turn) % 3];
    }
    if (pair.upper) {
      const auto upper = sides_of(surface_, *pair.upper);
      quad.corners[3] = surface_.corner_names(*pair.upper)[(2u + pair.upper_turn) % 3];
      quad.sides[2] = upper[(1u + pair.upper_turn) % 3];
      quad.sides[3] = upper[(2u + pair.upper_turn) % 3];
    }
    quads_.push_back(quad);
  }
}

// Finds which quads are beside each other.
void BrepLayout::connect() {
  if (quads_.empty()) {
    throw InputError(
        InputProblem::refused,
        "no face has a limit surface: all are holes or touch the boundary; use another boundary rule");
  }
  segments_.resize(2 * edges_ + surface_.patch_count());
  for (std::uint32_t q = 0; q < quads_.size(); ++q) {
    for (std::uint8_t k = 0; k < quads_[q].side_count(); ++k) {
      const std::vector<Run> runs = runs_of(q, k);
      for (const Run& run : runs) add_use(q, k, run, runs.size() == 1);
    }
    if (!quads_[q].half) continue;
    // Its sides are half as long, so quads beside it are split once more.
    for (const std::uint32_t name : quads_[q].corners) corner_depths_[name] = 2;
    for (const PatchSide& side : quads_[q].sides) side_depths_[side_name(side)] = 1;
  }
}

std::uint32_t BrepLayout::side_name(const PatchSide& side) const {
  return side.part == Part::inside ? static_cast<std::uint32_t>(edges_) + side.number : side.number;
}

std::vector<BrepLayout::Run> BrepLayout::runs_of(std::uint32_t quad, std::size_t side) const {
  const PatchSide& s = quads_[quad].sides[side];
  if (s.part == Part::inside) return {{static_cast<std::uint32_t>(2 * edges_) + s.number, s.reversed, 1}};
  const std::uint32_t first = 2 * s.number, second = first + 1;
  if (s.part != Part::whole) return {{s.part == Part::first_half ? first : second, s.reversed, 1}};
  if (!halved_[s.number]) return {{first, s.reversed, 1}};
  if (s.reversed) return {{second, true, 0.5}, {first, true, 0.5}};
  return {{first, false, 0.5}, {second, false, 0.5}};
}

void BrepLayout::add_use(std::uint32_t quad, std::uint8_t side, const Run& run, bool whole) {
  const auto& corners = quads_[quad].corners;
  Segment& segment = segments_[run.segment];
  if (segment.ends[0] == none) {
    std::array<std::uint32_t, 2> ends{corners[side], corners[quads_[quad].after(side)]};
    if (run.reversed) std::swap(ends[0], ends[1]);
    if (run.length < 1) {
      const std::uint32_t middle = ends_of(surface_, EdgeId(quads_[quad].sides[side].number))[1];
      ends[run.segment % 2 == 0 ? 1 : 0] = middle;
    }
    segment.ends = ends;
  }
  const std::size_t count = segment.uses[0].quad == none ? 0 : segment.uses[1].quad == none ? 1 : 2;
  if (count < 2) segment.uses[count] = {quad, side, run.reversed, whole};
  const auto owner = [&](std::uint32_t q) { return std::to_string(surface_.place(quads_[q].patch).owner); };
  const std::string word = surface_.rules().owner();
  if (count == 2) {
    throw InputError(InputProblem::refused,
                     word + "s " + owner(segment.uses[0].quad) + ", " + owner(segment.uses[1].quad) +
                         " and " + owner(quad) +
                         " share an edge: B-spline faces need edges of two faces at most; envelope() "
                         "wraps such a surface");
  }
  if (count == 0) return;
  const std::uint32_t other = segment.uses[0].quad;
  if (segment.uses[0].reversed == run.reversed) {
    throw InputError(InputProblem::refused,
                     word + "s " + owner(other) + " and " + owner(quad) +
                         " run along an edge in the same direction: turn one of them over");
  }
  if (other == quad) {
    throw InputError(InputProblem::refused,
                     word + " " + owner(quad) + " is its own neighbour: subdivide the mesh once");
  }
}

QuadDepths BrepLayout::depths(std::uint32_t quad) const {
  const SurfaceQuad& q = quads_[quad];
  const auto less = [&](std::uint8_t depth) {
    return static_cast<std::uint8_t>(depth - (q.half && depth > 0 ? 1 : 0));
  };
  QuadDepths depths;
  for (std::size_t k = 0; k < 4; ++k) {
    depths.corners[k] = less(corner_depths_[q.corners[k]]);
    depths.sides[k] = less(side_depths_[side_name(q.sides[k])]);
  }
  return depths;
}

// A corner is at least as deep as the sides that meet there, so that both quads on a side are split alike along it.
void BrepLayout::deepen(std::uint32_t quad, const QuadPiece& piece, std::uint8_t levels, std::uint8_t most) {
  const SurfaceQuad& q = quads_[quad];
  const auto raise = [&](std::vector<std::uint8_t>& depths, std::vector<bool>& changed, std::uint32_t name,
                         std::uint8_t to) {
    to = std::min(to, most);
    if (depths[name] >= to) return;
    depths[name] = to;
    changed[name] = true;
  };
  const auto depth = static_cast<std::uint8_t>(piece.level + (q.half ? 1u : 0u) + levels);
  const unsigned corners = piece.corners();
  for (std::size_t k = 0; k < 4; ++k) {
    if ((corners >> k) % 2 == 1) raise(corner_depths_, changed_corners_, q.corners[k], depth);
    if (corners != 0 || (piece.sides() >> k) % 2 == 0) continue;
    raise(side_depths_, changed_sides_, side_name(q.sides[k]), depth);
    raise(corner_depths_, changed_corners_, q.corners[k], depth);
    raise(corner_depths_, changed_corners_, q.corners[(k + 1) % 4], depth);
  }
}

void BrepLayout::join_depths(std::uint32_t quad, const QuadPiece& piece) {
  const SurfaceQuad& q = quads_[quad];
  for (std::size_t k = 0; k < 4; ++k) {
    if ((piece.sides() >> k) % 2 == 0) continue;
    creases_.join(q.corners[k], q.corners[(k + 1) % 4]);
    crease_end_[side_name(q.sides[k])] = q.corners[k];
  }
}

void BrepLayout::level_depths() {
  std::vector<std::uint8_t> deepest(corner_depths_.size());
  const auto all = [&](const auto& visit) {
    for (std::uint32_t name = 0; name < corner_depths_.size(); ++name)
      visit(deepest[creases_.least(name)], corner_depths_, changed_corners_, name);
    for (std::uint32_t side = 0; side < side_depths_.size(); ++side) {
      if (crease_end_[side] != none)
        visit(deepest[creases_.least(crease_end_[side])], side_depths_, changed_sides_, side);
    }
  };
  all([](std::uint8_t& most, const auto& depths, const auto&, std::uint32_t name) {
    most = std::max(most, depths[name]);
  });
  all([](std::uint8_t most, auto& depths, auto& changed, std::uint32_t name) {
    if (depths[name] == most) return;
    depths[name] = most;
    changed[name] = true;
  });
}

std::vector<std::uint32_t> BrepLayout::take_changed(const std::vector<std::uint32_t>& among) {
  std::vector<std::uint32_t> changed;
  for (const std::uint32_t quad : among) {
    const SurfaceQuad& q = quads_[quad];
    const bool has = std::any_of(q.corners.begin(), q.corners.end(),
                                 [&](std::uint32_t n) { return changed_corners_[n]; }) ||
                     std::any_of(q.sides.begin(), q.sides.end(),
                                 [&](const PatchSide& s) { return changed_sides_[side_name(s)]; });
    if (has) changed.push_back(quad);
  }
  std::fill(changed_corners_.begin(), changed_corners_.end(), false);
  std::fill(changed_sides_.begin(), changed_sides_.end(), false);
  return changed;
}

BrepLayout::Neighbour BrepLayout::across(std::uint32_t quad, std::size_t side) const {
  const std::vector<Run> runs = runs_of(quad, side);
  if (runs.size() != 1) return {};
  const Segment& segment = segments_[runs[0].segment];
  const Use& other = segment.uses[segment.uses[0].quad == quad && segment.uses[0].side == side ? 1 : 0];
  return other.whole ? Neighbour{other.quad, other.side} : Neighbour{};
}

// Rectangles that grow, strip by strip.
struct BrepLayout::Packing {
  const BrepLayout& layout;
  const Continues& continues;
  std::vector<std::uint32_t> face_of = std::vector<std::uint32_t>(layout.quads_.size(), none);

  // The quad across a side of a placed one, if it continues this one.
  [[nodiscard]] PlacedQuad beside(const PlacedQuad& placed, std::size_t side) const {
    const auto own = static_cast<std::size_t>((side + placed.turn) % 4);
    const Neighbour other = layout.across(placed.quad, own);
    if (other.quad == none || !continues({placed.quad, own}, {other.quad, other.side})) return {none, 0};
    return {other.quad, static_cast<std::uint8_t>((other.side + 8 - side - 2) % 4)};
  }

  [[nodiscard]] bool in_face(std::uint32_t quad, std::uint32_t face,
                             const std::vector<PlacedQuad>& strip) const {
    return quad != none &&
           (face_of[quad] == face ||
            std::any_of(strip.begin(), strip.end(), [&](const PlacedQuad& s) { return s.quad == quad; }));
  }

  // The quads beyond a side of a face, in the order of x or y, if all of them exist, are free and are neighbours; else none.
  [[nodiscard]] std::vector<PlacedQuad> strip(const FaceDraft& draft, std::size_t side,
                                              std::uint32_t face) const {
    const bool upright = side % 2 == 1;
    const std::size_t count = upright ? draft.height : draft.width, along = upright ? 2 : 1;
    std::vector<PlacedQuad> strip;
    for (std::size_t k = 0; k < count; ++k) {
      const PlacedQuad& edge = upright ? draft.at(side == 1 ? draft.width - 1 : 0, k)
                                       : draft.at(k, side == 2 ? draft.height - 1 : 0);
      const PlacedQuad next = beside(edge, side);
      if (next.quad == none || face_of[next.quad] != none || in_face(next.quad, face, strip)) return {};
      if (k > 0) {
        const PlacedQuad expected = beside(strip.back(), along);
        if (expected.quad != next.quad || expected.turn != next.turn) return {};
      }
      strip.push_back(next);
    }
    // A face that is its own neighbour would have a seam.
    const auto meets_itself = [&](const PlacedQuad& placed, std::size_t s) {
      return in_face(layout.across(placed.quad, (s + placed.turn) % 4).quad, face, strip);
    };
    for (const PlacedQuad& placed : strip) {
      if (meets_itself(placed, side)) return {};
    }
    if (meets_itself(strip.front(), (along + 2) % 4) || meets_itself(strip.back(), along)) return {};
    return strip;
  }

  static void attach(FaceDraft& draft, std::size_t side, const std::vector<PlacedQuad>& strip) {
    FaceDraft grown{draft.width + (side % 2), draft.height + (1 - side % 2), {}};
    const std::size_t dx = side == 3 ? 1 : 0, dy = side == 0 ? 1 : 0;
    for (std::size_t y = 0; y < grown.height; ++y) {
      for (std::size_t x = 0; x < grown.width; ++x) {
        const bool inside = x >= dx && x - dx < draft.width && y >= dy && y - dy < draft.height;
        grown.quads.push_back(inside ? draft.at(x - dx, y - dy) : strip[side % 2 == 1 ? y : x]);
      }
    }
    draft = std::move(grown);
  }

  [[nodiscard]] FaceDraft grown_from(std::uint32_t quad, std::uint32_t face) {
    FaceDraft draft{1, 1, {{quad, 0}}};
    face_of[quad] = face;
    if (layout.quads_[quad].side_count() == 3) return draft;
    for (std::size_t failed = 0, side = 0; failed < 4; side = (side + 1) % 4) {
      const std::vector<PlacedQuad> next = strip(draft, side, face);
      if (next.empty()) {
        ++failed;
        continue;
      }
      failed = 0;
      for (const PlacedQuad& placed : next) face_of[placed.quad] = face;
      attach(draft, side, next);
    }
    return draft;
  }
};

std::vector<FaceDraft> BrepLayout::packed(const Continues& continues) const {
  Packing packing{*this, continues};
  std::vector<FaceDraft> faces;
  for (std::uint32_t q = 0; q < quads_.size(); ++q) {
    if (packing.face_of[q] == none)
      faces.push_back(packing.grown_from(q, static_cast<std::uint32_t>(faces.size())));
  }
  return faces;
}

std::vector<FaceJoint> BrepLayout::joined(const std::vector<FaceDraft>& faces) const {
  // All segments on borders of faces, and how many of them end at each vertex.
  struct SideRun {
    Run run;
    std::uint32_t quad;
    std::uint8_t side, own;  // of the face, of the quad
    double begin;
  };
  std::vector<std::vector<SideRun>> sides(faces.size());
  std::vector<bool> seen(segments_.size()), corner(name_count());
  std::vector<std::uint32_t> ends(name_count());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const FaceDraft& draft = faces[f];
    const auto side_count = static_cast<std::uint8_t>(quads_[draft.at(0, 0).quad].side_count());
    for (std::uint8_t side = 0; side < side_count; ++side) {
      double begin = 0;
      const std::size_t count = side % 2 == 0 ? draft.width : draft.height;
      for (std::size_t k = 0; k < count; ++k) {
        const PlacedQuad& placed = side == 0   ? draft.at(k, 0)
                                   : side == 1 ? draft.at(draft.width - 1, k)
                                   : side == 2 ? draft.at(draft.width - 1 - k, draft.height - 1)
                                               : draft.at(0, draft.height - 1 - k);
        const auto own = static_cast<std::uint8_t>((side + placed.turn) % 4);
        if (k == 0) corner[quads_[placed.quad].corners[own]] = true;
        for (const Run& run : runs_of(placed.quad, own)) {
          sides[f].push_back({run, placed.quad, side, own, begin});
          begin += run.length;
          if (seen[run.segment]) continue;
          seen[run.segment] = true;
          for (const std::uint32_t end : segments_[run.segment].ends) ++ends[end];
        }
      }
    }
  }
  const auto halved = [&](std::uint32_t segment) { return segment < 2 * edges_ && halved_[segment / 2]; };
  const auto kept = [&](std::uint32_t name) { return corner[name] || ends[name] != 2; };
  std::vector<FaceJoint> joints;
  std::vector<std::uint32_t> joint_of(segments_.size(), none);
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    for (std::size_t r = 0; r < sides[f].size();) {
      const SideRun& first = sides[f][r];
      const auto end_of = [&](const SideRun& s, bool last) {
        return segments_[s.run.segment].ends[last != s.run.reversed ? 1 : 0];
      };
      JointUse use{f, first.side, first.begin, first.begin};
      std::size_t last = r;
      for (;; ++last) {
        use.end += sides[f][last].run.length;
        if (kept(end_of(sides[f][last], true)) ||
            halved(sides[f][last].run.segment) != halved(sides[f][last + 1].run.segment))
          break;
      }
      std::uint32_t& number = joint_of[first.run.segment];
      const std::uint32_t known = number != none ? number : joint_of[sides[f][last].run.segment];
      if (known == none) {
        for (std::size_t k = r; k <= last; ++k)
          joint_of[sides[f][k].run.segment] = static_cast<std::uint32_t>(joints.size());
        joints.push_back(
            {{end_of(first, false), end_of(sides[f][last], true)}, {use, {}}, 1, first.quad, first.own});
      } else {
        joints[known].uses[1] = use;
        joints[known].count = 2;
      }
      r = last + 1;
    }
  }
  return joints;
}

std::vector<LoopSide> BrepLayout::loops(const std::vector<FaceDraft>& faces,
                                        const std::vector<FaceJoint>& joints) {
  struct SideUse {
    JointUse use;
    std::uint32_t joint;
    bool reversed;
  };
  std::vector<std::vector<SideUse>> of_face(faces.size());
  for (std::uint32_t j = 0; j < joints.size(); ++j) {
    for (std::size_t k = 0; k < joints[j].count; ++k)
      of_face[joints[j].uses[k].face].push_back({joints[j].uses[k], j, k == 1});
  }
  std::vector<LoopSide> loops;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    std::sort(of_face[f].begin(), of_face[f].end(), [](const SideUse& a, const SideUse& b) {
      return std::pair(a.use.side, a.use.begin) < std::pair(b.use.side, b.use.begin);
    });
    for (const SideUse& place : of_face[f]) loops.push_back({f, place.joint, place.reversed});
  }
  return loops;
}

std::optional<Vector3> BrepLayout::normal_on_side(const Use& use, double t) const {
  const SurfaceQuad& quad = quads_[use.quad];
  if (!quad.pair) {
    const std::array<Place, 4> places{{{0, 0, t, 0}, {0, 0, 1, t}, {0, 0, 1 - t, 1}, {0, 0, 0, 1 - t}}};
    return LimitEvaluator(surface_.patch(quad.patch)).frame(places[use.side]).normal;
  }
  const bool lower = use.side < 2 || !quad.pair->upper;
  const std::size_t side = (lower ? use.side + quad.pair->turn : use.side - 1u + quad.pair->upper_turn) % 3;
  const std::array<Place, 3> places{{{0, 0, t, 0}, {0, 0, 1 - t, t}, {0, 0, 0, 1 - t}}};
  return LimitEvaluator(surface_.patch(lower ? quad.patch : *quad.pair->upper)).frame(places[side]).normal;
}

bool BrepLayout::smooth(const FaceJoint& joint, double length) const {
  const std::vector<Run> runs = runs_of(joint.quad, joint.side);
  const Segment& segment = segments_[runs[0].segment];
  if (segment.uses[1].quad == none || !(length > 0)) return false;
  std::array<std::optional<Vector3>, 2> normals;
  for (std::size_t k = 0; k < 2; ++k) {
    const Use& use = segment.uses[k];
    // The middle of the segment, which is a quarter of the way along a side of twice its length.
    double t = 0.5;
    if (!use.whole) t = (runs[0].segment % 2 == 0) != use.reversed ? 0.25 : 0.75;
    normals[k] = normal_on_side(use, t);
  }
  return normals[0] && normals[1] && dot(*normals[0], *normals[1]) > 0 &&
         snug::length(cross(*normals[0], *normals[1])) < same_normal;
}

}  // namespace snug
