#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <snug/mesh/disjoint_sets.h>
#include <snug/query/triangle_pairs.h>
#include <snug/spline/quad_pieces.h>
#include <snug/surface/patch_sides.h>

namespace snug {

/// A quad of a surface: two patches. Of a triangular scheme a pair of triangles, or a single one, which has three sides.
struct SurfaceQuad {
  PatchId patch;                          ///< the first of them
  std::array<std::uint32_t, 4> corners;   ///< names, as LimitSurface::corner_names() has them
  std::array<PatchSide, 4> sides;         ///< from corner k to the next one
  bool half = false;                      ///< its sides are halves: it comes from a first split
  std::optional<PairedTriangles> pair{};  ///< of a triangular scheme

  [[nodiscard]] std::size_t side_count() const { return pair && !pair->upper ? 3 : 4; }
  [[nodiscard]] std::size_t after(std::size_t side) const { return (side + 1) % side_count(); }
};
/// A side of a quad.
struct QuadSide {
  std::uint32_t quad;
  std::size_t side;
};

/// A quad in a face: side k of the face's is side (k + turn) mod 4 of its own.
struct PlacedQuad {
  std::uint32_t quad = 0;
  std::uint8_t turn = 0;
};

/// A rectangle of quads that becomes one face.
struct FaceDraft {
  std::size_t width = 0, height = 0;
  std::vector<PlacedQuad> quads;
  [[nodiscard]] const PlacedQuad& at(std::size_t x, std::size_t y) const { return quads[x + width * y]; }
};

/// How an edge lies on a face: on which side, and from which parameter to which along it.
struct JointUse {
  std::uint32_t face = 0;
  std::uint8_t side = 0;
  double begin = 0, end = 0;
  [[nodiscard]] double length() const { return end - begin; }
};
/// An edge between two faces, or on the border of one, in the direction of the first face's loop.
struct FaceJoint {
  std::array<std::uint32_t, 2> ends;  ///< names of vertices
  std::array<JointUse, 2> uses;
  std::size_t count = 0;  ///< of uses
  std::uint32_t quad = 0,
                side = 0;  ///< a quad of the first face on the edge, and which side of it
};
struct LoopSide {
  std::uint32_t face, joint;
  bool reversed;
};

/// The quads of a surface: their neighbours, how often each is split, and the faces and edges that they make up.
class BrepLayout {
 public:
  /// Errors:    InputError (refused), see to_brep().
  explicit BrepLayout(const LimitSurface& surface);

  [[nodiscard]] const std::vector<SurfaceQuad>& quads() const { return quads_; }
  [[nodiscard]] std::size_t name_count() const { return corner_depths_.size(); }

  [[nodiscard]] QuadDepths depths(std::uint32_t quad) const;
  /// Splits more often towards the corner or the sides that a piece touches.
  void deepen(std::uint32_t quad, const QuadPiece& piece, std::uint8_t levels, std::uint8_t most);
  /// A tip that lies on a side but at no corner of the quad is beside a semi-sharp crease. Such sides, and those connected to them,
  /// get one depth: no piece ends in the middle of the side of another's tip.
  void join_depths(std::uint32_t quad, const QuadPiece& piece);
  void level_depths();
  /// Which of some quads have other depths since the last call.
  [[nodiscard]] std::vector<std::uint32_t> take_changed(const std::vector<std::uint32_t>& among);

  /// Do the surface and its parameters continue smoothly from one side to the other?
  using Continues = std::function<bool(const QuadSide& a, const QuadSide& b)>;
  /// Large rectangles of quads that continue each other; every other quad by itself.
  [[nodiscard]] std::vector<FaceDraft> packed(const Continues& continues) const;
  /// All edges of faces; and the loops made of these, face by face.
  [[nodiscard]] std::vector<FaceJoint> joined(const std::vector<FaceDraft>& faces) const;
  [[nodiscard]] static std::vector<LoopSide> loops(const std::vector<FaceDraft>& faces,
                                                   const std::vector<FaceJoint>& joints);
  /// Is the limit surface smooth across an edge? In double precision.
  [[nodiscard]] bool smooth(const FaceJoint& joint, double length) const;

 private:
  static constexpr std::uint32_t none = UINT32_MAX;
  // A side of a quad that runs along a segment of a limit curve; the whole of it, or a half.
  struct Run {
    std::uint32_t segment;
    bool reversed;
    double length;
  };
  struct Use {
    std::uint32_t quad = none;
    std::uint8_t side = 0;
    bool reversed = false, whole = true;
  };
  struct Segment {
    std::array<std::uint32_t, 2> ends{none, none};
    std::array<Use, 2> uses;
  };
  struct Neighbour {
    std::uint32_t quad = none;
    std::uint8_t side = 0;
  };
  struct Packing;

  void add_quads_of_triangles();
  void connect();
  [[nodiscard]] std::optional<Vector3> normal_on_side(const Use& use, double t) const;
  [[nodiscard]] std::vector<Run> runs_of(std::uint32_t quad, std::size_t side) const;
  void add_use(std::uint32_t quad, std::uint8_t side, const Run& run, bool whole);
  [[nodiscard]] std::uint32_t side_name(const PatchSide& side) const;
  [[nodiscard]] Neighbour across(std::uint32_t quad, std::size_t side) const;

  const LimitSurface& surface_;
  std::size_t edges_;
  std::vector<SurfaceQuad> quads_;
  std::vector<bool> halved_;  // edges
  std::vector<Segment> segments_;
  std::vector<std::uint8_t> corner_depths_, side_depths_;
  DisjointSets creases_;                   // of corners, joined by sides with semi-sharp creases
  std::vector<std::uint32_t> crease_end_;  // of sides: a corner, or none
  std::vector<bool> changed_corners_, changed_sides_;
};

}  // namespace snug
