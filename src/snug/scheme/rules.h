#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <snug/scheme/basis.h>
#include <snug/scheme/bezier.h>
#include <snug/scheme/refine.h>
#include <snug/scheme/rings.h>

namespace snug {

/// Regular patches that fit_kernels.h knows by heart.
enum class RegularKernel : std::uint8_t { none, box_spline, bicubic };

/// Properties of a scheme that are plain values.
struct SchemeFacts {
  Scheme scheme;
  const char* name;
  std::span<const char* const> other_names{};  ///< those of USD and OpenSubdiv
  /// Does a patch belong to a face, and do vertices stay vertices? Dual schemes: a patch belongs to a vertex.
  bool primal = true;
  /// Corners of an owner that is no polygon: 3, it is one patch; 4, two halves of a quad.
  std::size_t corners = 4;
  std::size_t regular_valence = 4;  ///< of vertices, of a dual scheme the size of faces
  /// Least and largest valence of an interior vertex, and most faces around any other one. The work at a vertex
  /// grows with the square of its valence: beyond the largest, queries would take longer than a few seconds.
  std::size_t min_valence = 3, max_valence = 512;
  std::size_t max_face_size = 512;  ///< most vertices of a face
  /// Does a step weight all corners of a polygon for each new one?
  bool full_step = false;
  const char* wants_triangles = nullptr;  ///< advice if other faces are given; none: it takes them
  bool creases = true;                    ///< Does sharpness change the surface?
  /// Does the surface of a face depend on that face alone?
  bool local = false;
  /// Are tables laid out by the rings of the corners (bounds/layout.h)?
  bool laid_by_rings = false;
  RegularKernel kernel = RegularKernel::none;
  RegularBasis basis = RegularBasis::linear;  ///< of regular patches
};

/// All that snug knows of one scheme. Each has a file; other files ask for its properties, not for its name.
class SchemeRules : public SchemeFacts {
 public:
  SchemeRules(const SchemeRules&) = delete;
  SchemeRules& operator=(const SchemeRules&) = delete;
  virtual ~SchemeRules() = default;

  [[nodiscard]] bool triangular() const { return corners == 3; }
  /// Owner of a patch, in a word.
  [[nodiscard]] const char* owner() const { return primal ? "face" : "vertex"; }

  /// Does it answer questions about the surface of a mesh with such a defect all the same? Not where a face
  /// names a vertex twice: its patches have no distinguishable corners.
  [[nodiscard]] virtual bool answers(DefectKind kind) const;

  /// One step of subdivision, see refine.h.
  [[nodiscard]] virtual RefinedTopology refine(const RuledMesh& mesh, const WorkMonitor& monitor) const = 0;
  /// See limit_stencils().
  virtual void add_limit_row(const RuledMesh& mesh, VertexId v, Stencils& out) const = 0;

  /// The faces around a patch whose corners have these fans, as a mesh: the order of its vertices is that of
  /// the control points of the patch, and stands here alone. Its face 0 is the patch's own; of a dual scheme
  /// the first half-edge of each face leaves the patch's vertex, 0.
  [[nodiscard]] virtual Topology ring(std::span<const CornerFan> fans) const = 0;
  /// Half-edges of the refined ring that the children of a patch, or of a polygon, begin at (Kind::children).
  [[nodiscard]] virtual std::vector<HalfEdge> child_starts(const Topology& ring,
                                                           const Topology& refined) const;
  /// Where patches are halves of quads: the half-edge of the refined ring that the quarter at corner 0, 1, 2
  /// or 3 begins at, all corners of the quarter in their places.
  [[nodiscard]] virtual HalfEdge quarter_start(const Topology& ring, const Topology& refined,
                                               std::size_t corner) const;
  /// The half-edge of a ring that names a corner of its patch, or of the quad that it is half of.
  [[nodiscard]] HalfEdge corner_of(const Topology& ring, std::size_t corner) const {
    return primal ? static_cast<HalfEdge>(corner) : ring.first_of(FaceId(corner));
  }
  /// Adds the limit at such a half-edge's vertex (dual schemes: face), if it can be read off what surrounds
  /// it at once, and returns whether it could.
  [[nodiscard]] virtual bool add_corner_limit(const RuledMesh& mesh, HalfEdge corner,
                                              Stencils& out) const = 0;
  /// Adds two rows whose images span the tangent plane there, wherever there is one: the limits of the
  /// directions, of no particular length; their weights sum to 0. Counter-clockwise: their cross product
  /// points to the side from which faces look counter-clockwise. At a boundary the first runs along it; at a
  /// crease they are those of the half-edge's sector.
  /// Source:    left eigenvectors of the local matrix, derivations/loop_limits.md, catmark_limits.md.
  virtual void add_corner_tangents(const RuledMesh& mesh, HalfEdge corner, Stencils& out) const = 0;

  /// Is the surface near a corner as on a regular lattice?
  [[nodiscard]] virtual bool regular(const CornerFan& fan) const = 0;
  /// A patch all of whose corners are regular, as polynomials.
  [[nodiscard]] virtual BezierRows bezier(const Topology& ring, std::span<const CornerFan> fans) const = 0;
  /// Of such a patch the points that its basis functions weight: control points, and ghosts beyond boundaries
  /// and creases. In the order of the basis.
  [[nodiscard]] virtual Lattice lattice(const Topology& ring, std::span<const CornerFan> fans) const = 0;
  /// About the factor by which what surrounds an irregular corner, not sharp and no dart, shrinks a level.
  [[nodiscard]] virtual double shrink_factor(const CornerFan& fan) const = 0;

 protected:
  explicit SchemeRules(const SchemeFacts& facts) : SchemeFacts(facts) {}
};

[[nodiscard]] const SchemeRules& rules_of(Scheme scheme);
/// The rules of all schemes, in the order of Scheme.
[[nodiscard]] std::span<const SchemeRules* const> all_rules();
/// The rules of the scheme with this name, its own or another one; none: there is no such scheme.
[[nodiscard]] const SchemeRules* rules_named(std::string_view name);

// For the files of schemes.

/// The one object of a scheme's class.
template <class Rules>
[[nodiscard]] const SchemeRules& only() {
  static const Rules rules;
  return rules;
}

/// SchemeRules::regular() where patches are halves of quads.
[[nodiscard]] bool regular_among_quads(const CornerFan& fan);

/// Adds two rows, first Fourier modes of n directions counter-clockwise: of cosines, then of sines. add(i,
/// wave) adds entries by wave(i), which is the one at direction i.
template <class Add>
void add_first_modes(std::size_t directions, const Add& add, Stencils& out) {
  const auto n = static_cast<unsigned>(directions);
  for (const unsigned turn : {0u, 3 * n}) {  // sin x = cos(x - pi/2), in quarters of a step
    const auto wave = [=](unsigned i) { return cos_of_turn((4 * i + turn) % (4 * n), 4 * n); };
    for (unsigned i = 0; i < n; ++i) add(i, wave);
    out.end_row();
  }
}

}  // namespace snug
