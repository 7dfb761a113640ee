#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <snug/spline/face_spline.h>
#include <snug/spline/triangle_tree.h>

namespace snug {

/// The limit curve of an edge as cubics that join smoothly: positions and derivatives at knots from 0 to 1.
struct HermiteCurve {
  struct Node {
    double t;
    Vector3 point, along;
  };
  Point3 origin;
  std::vector<Node> nodes;

  /// Position and derivative there, relative to the origin.
  [[nodiscard]] Node at(double t) const;
  [[nodiscard]] HermiteCurve reversed() const;
};

/// The curve from corner 0 to corner 1 of a lower half, with these knots from 0 to 1. At an extraordinary end it is in the tangent
/// plane, if there is one.
[[nodiscard]] HermiteCurve curve_with(TriangleTree& tree, const std::vector<double>& knots);
/// With knots that crowd at extraordinary ends, until it is about `error` near to the limit curve.
[[nodiscard]] HermiteCurve curve_near(TriangleTree& tree, double error);

/// A square of a face: two triangles, or the lower one alone.
struct FaceSquare {
  TriangleTree lower;
  std::optional<TriangleTree> upper;
};

/// A face over squares of triangles, as bicubics that join with continuous first derivatives: by position, derivatives and mixed
/// derivative of the limit surface where its knots cross. Its borders are given curves. A face over one triangle is the lower half of
/// a square, and its third side is the diagonal.
///
/// Source:    derivations/brep.md.
class HermiteFace {
 public:
  /// Squares row by row; curves of the border in the order of the loop, from corner (0, 0) on, square by square.
  HermiteFace(std::size_t width, std::size_t height, std::vector<FaceSquare> squares,
              const std::vector<HermiteCurve>& border);

  /// Splits until the face is so near to the limit surface, or spans would be too many. True if it is that near.
  bool refine(double error, std::size_t most_spans);
  [[nodiscard]] std::size_t spans() const { return (u_.size() - 1) * (v_.size() - 1); }
  /// Its parts; distances are bounds.
  [[nodiscard]] std::vector<FacePart> parts();

 private:
  struct Jet {
    CornerJet jet;
    bool known;  // not at an extraordinary corner, where the mixed derivative is free
  };
  struct Cell {
    TensorPiece bezier;
    double distance = 0;
  };
  struct CellKey {
    double u0, u1, v0, v1;
    friend auto operator<=>(const CellKey&, const CellKey&) = default;
  };
  enum class Place : std::uint8_t { whole, half, outside };

  [[nodiscard]] bool triangle() const { return !squares_.front().upper; }
  [[nodiscard]] Place place(std::size_t i, std::size_t j) const {
    return !triangle() || i > j ? Place::whole : i == j ? Place::half : Place::outside;
  }
  // The half that a point lies in, and its parameters there.
  TriangleTree& tree_at(double& u, double& v);
  [[nodiscard]] Vector3 limit(double u, double v);
  const Jet& jet_at(double u, double v);
  [[nodiscard]] Jet made_jet(double u, double v);
  void put_on_border(double u, double v, Jet& jet) const;
  [[nodiscard]] Jet jet_outside(std::size_t i, std::size_t j);
  [[nodiscard]] HermiteCurve::Node border_at(std::size_t side, double t) const;
  [[nodiscard]] TensorPiece bezier_of(std::size_t i, std::size_t j);
  void fit_inside(std::size_t i, std::size_t j, const std::array<bool, 4>& known, TensorPiece& bezier);
  void take_diagonal(double begin, double end, TensorPiece& bezier) const;
  Cell& cell_at(std::size_t i, std::size_t j, double sufficient);
  void split(std::size_t i, std::size_t j, const TensorPiece& bezier, std::vector<double>& u,
             std::vector<double>& v);

  std::size_t width_, height_;
  std::vector<FaceSquare> squares_;
  Point3 origin_;
  std::array<std::vector<HermiteCurve>, 4>
      border_;  // in the direction of u or v; of a triangle the third is its diagonal
  std::vector<double> u_, v_;
  std::map<std::pair<double, double>, Jet> jets_;
  std::map<CellKey, Cell> cells_;
};

}  // namespace snug
