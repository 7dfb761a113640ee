#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <snug/mesh/disjoint_sets.h>
#include <snug/spline/quad_pieces.h>
#include <snug/surface/patch_sides.h>

namespace snug {

/// A quad of a surface: two patches.
struct SurfaceQuad {
  PatchId patch;                         ///< the first of them
  std::array<std::uint32_t, 4> corners;  ///< names, as LimitSurface::corner_names() has them
  std::array<PatchSide, 4> sides;        ///< from corner k to the next one
  bool half = false;                     ///< its sides are halves: it comes from a first split
};

/// A quad in a face: side k of the face's is side (k + turn) mod 4 of its own.
struct PlacedQuad {
  std::uint32_t quad = 0;
  std::uint8_t turn = 0;
};

/// Quads in rows and columns that are to be one face.
struct FaceDraft {
  std::size_t width = 0, height = 0;
  std::vector<PlacedQuad> quads;
  [[nodiscard]] const PlacedQuad& at(std::size_t x, std::size_t y) const { return quads[x + width * y]; }
};

/// A face beside an edge: which side of it, and the parameters along that where the edge begins and ends.
struct JointUse {
  std::uint32_t face = 0;
  std::uint8_t side = 0;
  double begin = 0, end = 0;
  [[nodiscard]] double length() const { return end - begin; }
};
/// An edge of faces: one curve, along which the first face runs.
struct FaceJoint {
  std::array<std::uint32_t, 2> ends;  ///< names of vertices
  std::array<JointUse, 2> uses;
  std::size_t count = 0;  ///< of uses
  std::uint32_t quad = 0,
                side = 0;  ///< where it is smooth, or not: a quad of the first face and its own side
};
struct LoopSide {
  std::uint32_t face, joint;
  bool reversed;
};

/// Quads of a surface, how they lie side by side, and how far each is split.
class BrepLayout {
 public:
  /// Errors:    InputError (refused), see to_brep().
  explicit BrepLayout(const LimitSurface& surface);

  [[nodiscard]] const std::vector<SurfaceQuad>& quads() const { return quads_; }
  [[nodiscard]] std::size_t name_count() const { return corner_depths_.size(); }

  [[nodiscard]] QuadDepths depths(std::uint32_t quad) const;
  /// Splits more towards what a piece touches, at most so often.
  void deepen(std::uint32_t quad, const QuadPiece& piece, std::uint8_t levels, std::uint8_t most);
  /// Sides that a tip touches alone are of decaying creases: they, and what joins them, are split alike, lest a piece ends amid
  /// the side of a tip.
  void join_depths(std::uint32_t quad, const QuadPiece& piece);
  void level_depths();
  /// Those of some quads whose depths have changed since the last call.
  [[nodiscard]] std::vector<std::uint32_t> take_changed(const std::vector<std::uint32_t>& among);

  /// Rectangles as large as can be found soon of quads that are one polynomial, joined smoothly; all others alone.
  [[nodiscard]] std::vector<FaceDraft> packed(
      const std::function<const TensorPiece*(std::uint32_t)>& polynomial) const;
  /// The edges between faces, and on the border; and the sides of their loops, face by face.
  [[nodiscard]] std::vector<FaceJoint> joined(const std::vector<FaceDraft>& faces) const;
  [[nodiscard]] static std::vector<LoopSide> loops(const std::vector<FaceDraft>& faces,
                                                   const std::vector<FaceJoint>& joints);
  /// Has the surface a tangent plane along an edge? In double precision.
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
  DisjointSets creases_;                   // of corners, joined by sides of decaying creases
  std::vector<std::uint32_t> crease_end_;  // of sides: a corner, or none
  std::vector<bool> changed_corners_, changed_sides_;
};

}  // namespace snug
