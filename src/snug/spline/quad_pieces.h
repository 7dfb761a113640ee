#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <snug/patch/limit_evaluator.h>
#include <snug/spline/tensor_piece.h>

namespace snug {

/// How often a quad is split towards where it is no polynomial: towards its corners and towards its sides, side k from corner k.
struct QuadDepths {
  std::array<std::uint8_t, 4> corners{}, sides{};
};

/// A part of a quad's parameters, [i, i + columns] x [j, j + rows] / 2^level, with a polynomial.
struct QuadPiece {
  unsigned level = 0;
  std::uint32_t i = 0, j = 0, columns = 1, rows = 1;
  TensorPiece piece;  ///< on [0, 1]^2
  bool tip = false;   ///< the surface is no polynomial there, and this one is fitted to it
  double distance =
      0;  ///< upper bound of that of the surface, parameter by parameter, beside the error of `piece`

  [[nodiscard]] ParameterBox box() const {
    const double s = 1 / static_cast<double>(std::uint64_t{1} << level);
    return {i * s, (i + columns) * s, j * s, (j + rows) * s};
  }
  /// Which corners of the quad it touches, bit by bit, and which sides.
  [[nodiscard]] unsigned corners() const;
  [[nodiscard]] unsigned sides() const;
};

/// A quad of a scheme with a tensor basis as polynomials. What is none after so many splits is a tip: fitted such that pieces
/// join with continuous derivatives, with the limit point and the tangent plane of extraordinary corners, and on a side of the
/// quad by what is on that side alone: quads beside each other agree there, up to rounding, if their depths do. Beside decaying
/// creases pieces are merged along these.
///
/// Points are relative to the patch's origin.
/// Source:    derivations/brep.md.
class QuadPieces {
 public:
  /// Requires:  half a quad, which stands for all of it; a tensor basis. Tips farther off than `error` are not merged.
  QuadPieces(const Patch& patch, const QuadDepths& depths, double error);
  QuadPieces(const QuadPieces&) = delete;
  QuadPieces& operator=(const QuadPieces&) = delete;
  ~QuadPieces();

  [[nodiscard]] std::vector<QuadPiece> take() { return std::move(pieces_); }
  /// Of all pieces: 3 if there are tips, else the scheme's.
  [[nodiscard]] std::size_t degree() const { return tips_ > 0 ? TensorPiece::max_degree : degree_; }

 private:
  struct Draft;

  void open(ControlNet net, const QuadPiece& place);
  void add_tip(ControlNet net, const QuadPiece& place);
  void fit_tips();
  void fit_block(std::span<Draft> tips, bool along_u);
  [[nodiscard]] bool is_border_of(const QuadPiece& tip, bool along_u, std::size_t samples);
  void merge(bool along_u);
  [[nodiscard]] static std::optional<Draft> merged(const Draft& a, const Draft& b, bool along_u);

  QuadDepths depths_;
  double error_;
  LimitEvaluator evaluator_;
  std::size_t degree_, tips_ = 0;
  std::vector<Draft> drafts_;
  std::vector<QuadPiece> pieces_;
};

}  // namespace snug
