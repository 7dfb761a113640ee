#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <snug/mesh/topology.h>
#include <snug/scheme/creases.h>
#include <snug/scheme/rings.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// Of a patch's corners, those where no other fan at the vertex matters.
using OwnFans = std::array<bool, 4>;

/// The faces around a patch as a mesh, as SchemeRules::ring() counts: vertex i is its control vertex i.
struct Neighbourhood {
  Topology topology;
  Sharpness sharpness;    ///< where it matters to the patch
  SchemeOptions options;  ///< under which it refines as it does inside its mesh
  bool wide;              ///< Does it reach to the faces around the far ends of the corners' edges?
  OwnFans own_fans;       ///< corners of which not all fans are here
  std::size_t hash;       ///< of all this
  Neighbourhood(Topology faces, Sharpness sharp, const SchemeOptions& rules, bool is_wide = false,
                const OwnFans& own = {});
  [[nodiscard]] RuledMesh ruled() const { return {topology, options, sharpness}; }
  friend bool operator==(const Neighbourhood& a, const Neighbourhood& b);
};

/// Names a kind: equal keys, equal rows, matrices and bounds. All that a limit patch depends on, but for its
/// control points.
///
/// Every patch is a triangle. Triangular schemes: the face, its corners turned so that the key is the least
/// of the three it could be; reflections are different kinds. Other schemes: half a quad, from its corner 0
/// by 1 to 2; `corners` are those of the quad. Dual schemes: the quad that has the faces around a vertex of
/// valence 4 as corners.
///
/// Where fans do not say everything, `around` does, and `corners` say what the corners will be when all that
/// decays has decayed. A `polygon` is a face of Catmull-Clark that is no quad, or a vertex of a dual scheme
/// of another valence than 4: no patch, but it splits into some.
struct KindKey {
  Scheme scheme = Scheme::loop;
  std::array<CornerFan, 4> corners{};  ///< of triangles the last one stays as it is here
  bool polygon = false;
  std::shared_ptr<const Neighbourhood> around{};
  [[nodiscard]] bool plain() const { return !around; }
  friend bool operator==(const KindKey& a, const KindKey& b);
};

struct KindKeyHash {
  std::size_t operator()(const KindKey& key) const noexcept;
};

/// The kind of a triangular patch, and which corner of its face the kind calls its corner 0.
struct TurnedKey {
  KindKey key;
  std::uint8_t first = 0;
};

/// The kind of a face of a triangular scheme.
/// Requires:  a topology that require_subdividable accepts, or where at least the fans of the face's corners
///            are whole.
[[nodiscard]] TurnedKey kind_key(const Topology& topology, FaceId face, const SchemeOptions& options,
                                 const Sharpness& sharpness = {});

/// The kind that begins at a half-edge: of the face that it belongs to, with the corner it leaves as corner
/// 0; for dual schemes of the vertex it leaves, with its face as corner 0.
[[nodiscard]] KindKey kind_key_from(const Topology& topology, HalfEdge start, const SchemeOptions& options,
                                    const Sharpness& sharpness = {});

/// The faces around a patch of this kind.
[[nodiscard]] Neighbourhood neighbourhood(const KindKey& key);

/// Finds the control vertices of patches of one kind, in the order that their neighbourhood has them: the
/// patch's faces are walked in the mesh and there side by side. A vertex that stands in two places of a ring
/// by accident of a small mesh is listed twice; where `around` says what there is, each once.
class ControlOrder {
 public:
  ControlOrder(const KindKey& key, const Topology& around);
  /// Those of the patch that begins at `start`.
  void operator()(const Topology& topology, HalfEdge start, std::vector<VertexId>& out) const;

 private:
  // The half-edge so many after the one where a face was entered.
  struct Step {
    std::uint16_t face, edges;
  };
  Scheme scheme_;
  bool wide_ = false;
  OwnFans own_fans_{};
  std::vector<Step> faces_;     // which the faces after the first are entered across
  std::vector<Step> vertices_;  // which leave the control vertices; none: as the faces around name them
};

}  // namespace snug
