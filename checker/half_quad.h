#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "bezier.h"
#include "bounds_file.h"
#include "piece.h"
#include "real.h"

namespace checker {

class Shapes;

/// The net shared by all patches of Catmull-Clark, Doo-Sabin or Midedge with these faces at the corners of their
/// quad, with control points numbered as snug/patch/neighbourhood.h documents.
/// Catmull-Clark: face 0 is the quad. Dual schemes: vertex 0 is the patch's own, its faces are the corners.
class Shape {
 public:
  /// Weights of control points.
  using Weights = std::map<std::size_t, Real>;
  using Face = std::vector<std::size_t>;  // counter-clockwise

  /// A quarter of the quad as a patch of its own.
  struct Quarter {
    const Shape* shape = nullptr;
    std::vector<Weights> net;  // its control points from those of the whole
  };
  /// A polynomial on a triangle of the quad, whose corners are (0,0), (4,0), (4,4), (0,4).
  struct Part {
    std::array<std::array<unsigned, 2>, 3> corners{};
    unsigned degree = 0;
    std::vector<Row> points;  // Bezier points, in the order of exponents()
  };

  /// Errors:    Rejected for a key that no patch has.
  Shape(Shapes& all, Scheme scheme, const Key& key);

  [[nodiscard]] std::size_t control_count() const { return count_; }
  [[nodiscard]] const Key& key() const { return key_; }
  /// All four corners regular: then the patch is polynomial, with Midedge on each side of its diagonals.
  [[nodiscard]] bool polynomial() const;
  /// Quarters 0 to 3 keep that corner of the quad as their own corner of the same number; 4 is quarter 1
  /// turned by half a turn: the middle of the quad is corner 1 of that one, and corner 1 of the quad its
  /// corner 3.
  /// Errors:    Rejected if a quarter has other corners than the scheme gives it.
  [[nodiscard]] const std::vector<Quarter>& quarters() const;
  /// The half (0,0), (4,0), (4,4): one part, Midedge two.
  /// Requires:  polynomial().
  /// Errors:    Rejected if limits at some point are not those of the polynomials.
  [[nodiscard]] const std::vector<Part>& parts() const;
  /// Where corner k goes in the limit.
  [[nodiscard]] Weights limit(std::size_t k) const;

 private:
  struct Ring {
    std::vector<std::size_t> spokes, faces;  // counter-clockwise; spoke i begins face i; open: one spoke more
    bool closed = false;
    std::size_t own = 0;  // place of the spoke that was asked for
    [[nodiscard]] Fan fan(bool sharp) const;
  };
  // Faces and which of them each directed edge belongs to.
  struct Net {
    std::vector<Face> faces;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> face_of;
    void add(Face face);
    [[nodiscard]] Ring ring(std::size_t v, std::size_t start) const;
    [[nodiscard]] std::size_t after(std::size_t face, std::size_t v) const;
    [[nodiscard]] std::size_t before(std::size_t face, std::size_t v) const;
  };
  // One step of the scheme.
  struct Refined {
    Net net;
    std::vector<Weights> points;
    std::array<std::array<std::size_t, 4>, 4>
        corners{};                         // of each quarter: vertices, or faces of a dual scheme
    std::array<std::size_t, 4> middles{};  // of a dual scheme: the vertex that each quarter belongs to
  };

  [[nodiscard]] bool primal() const { return scheme_ == Scheme::catmark; }
  void make_quads();
  void make_dual();
  [[nodiscard]] Refined refine_quads() const;
  [[nodiscard]] Refined refine_dual() const;
  [[nodiscard]] Quarter quarter(const Refined& refined, std::size_t corner, std::size_t turn) const;
  [[nodiscard]] Weights new_vertex(std::size_t k) const;
  [[nodiscard]] Weights new_edge_point(std::size_t a, std::size_t b) const;
  [[nodiscard]] std::map<std::array<unsigned, 2>, Row> limits_on_grid() const;

  Shapes& all_;
  Scheme scheme_;
  Key key_;
  std::size_t count_ = 0;
  Net net_;
  mutable std::vector<Quarter> quarters_;
  mutable std::vector<Part> parts_;
};

/// Every shape that a proof met.
class Shapes {
 public:
  [[nodiscard]] const Shape& find(Scheme scheme, const Key& key);

 private:
  std::map<std::pair<Scheme, Key>, std::unique_ptr<Shape>> shapes_;
};

/// Half a quad of a net that was refined some levels: the triangle of its corners 0, 1 and 2.
struct HalfQuad {
  const Shape* shape = nullptr;
  std::array<Place, 3> places{};
  std::vector<std::shared_ptr<const Row>> rows;  // of its control points
  unsigned depth = 0;
  [[nodiscard]] bool polynomial() const { return shape->polynomial(); }
};

/// The net of a kind, its control points as unit rows.
/// Errors:    Rejected for a key that no patch has.
[[nodiscard]] HalfQuad root_half(Shapes& shapes, Scheme scheme, const Key& key);
/// One step of the scheme: halves 0 to 2 keep that corner as their own corner of the same number; 3 is the
/// middle one.
/// Errors:    Rejected as Shape::quarters(), or past 28 levels.
[[nodiscard]] std::array<HalfQuad, 4> split(const HalfQuad& piece);
/// The control points of a half, as it is in the order of its kind; none for another kind, or turned.
[[nodiscard]] std::vector<const Row*> net_of(const HalfQuad& piece, const Key& key, std::size_t first);
/// The polynomials of a half.
/// Requires:  polynomial().
[[nodiscard]] std::vector<BezierTriangle> bezier_triangles(const HalfQuad& piece);

}  // namespace checker
