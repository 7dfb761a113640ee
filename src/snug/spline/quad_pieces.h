#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <snug/patch/limit_evaluator.h>
#include <snug/spline/flat_ball.h>

namespace snug {

/// How often a quad is split where it is not polynomial: towards each corner, and towards each side, k being the one from corner k.
struct QuadDepths {
  std::array<std::uint8_t, 4> corners{}, sides{};
};

/// Corners about which a quad becomes flat (FlatBall), with the levels of the pieces that are bent and how often these are split further.
struct QuadFlat {
  double radius = 0;  ///< 0 where it is not flat
  unsigned first = 0, splits = 0;
};

/// A part of a quad's parameters, [i, i + columns] x [j, j + rows] / 2^level, with a polynomial.
struct QuadPiece {
  unsigned level = 0;
  std::uint32_t i = 0, j = 0, columns = 1, rows = 1;
  TensorPiece piece;  ///< on [0, 1]^2
  bool tip = false;   ///< fitted to a surface that is not polynomial there
  bool bent = false;  ///< towards the tangent plane of a corner
  double distance =
      0;  ///< of the surface from it at most, parameter by parameter, beside the error of `piece`

  [[nodiscard]] ParameterBox box() const {
    const double s = 1 / static_cast<double>(std::uint64_t{1} << level);
    return {i * s, (i + columns) * s, j * s, (j + rows) * s};
  }
  /// Which corners of the quad it touches, bit by bit, and which sides.
  [[nodiscard]] unsigned corners() const;
  [[nodiscard]] unsigned sides() const;
};

/// A quad as polynomials. Where the surface is not polynomial after the splits that the depths ask for, there is a tip: a
/// bicubic with the limit point and the tangent plane of an extraordinary corner. Pieces join with continuous first derivatives.
/// On a side of the quad a tip depends on what is on that side alone, so that quads beside each other agree there, up to
/// rounding, if their depths do. Beside semi-sharp creases pieces are merged along the crease.
///
/// Points are relative to the patch's origin.
/// Source:    derivations/brep.md.
class QuadPieces {
 public:
  /// `error`: rows of tips get one polynomial only if it is at most this far off.
  /// Requires:  half a quad, which stands for all of it; a tensor basis.
  QuadPieces(const Patch& patch, const QuadDepths& depths, double error,
             const std::array<QuadFlat, 4>& flats = {});
  QuadPieces(const QuadPieces&) = delete;
  QuadPieces& operator=(const QuadPieces&) = delete;
  ~QuadPieces();

  /// Of one degree: 3 if there are tips, else the scheme's.
  [[nodiscard]] std::vector<QuadPiece> take() { return std::move(pieces_); }

 private:
  struct Draft;

  void open(ControlNet net, const QuadPiece& place);
  void add_tip(ControlNet net, const QuadPiece& place);
  [[nodiscard]] const FlatBall* ball_at(const QuadPiece& place, unsigned level) const;
  void add_bent(const QuadPiece& quarter, const FlatBall& ball, unsigned splits);
  void fit_tips();
  void fit_block(std::span<Draft> tips, bool along_u);
  [[nodiscard]] bool is_border_of(const QuadPiece& tip, bool along_u, std::size_t samples);
  void merge(bool along_u);
  [[nodiscard]] static std::optional<Draft> merged(const Draft& a, const Draft& b, bool along_u);

  QuadDepths depths_;
  std::array<QuadFlat, 4> flats_;
  std::array<FlatBall, 4> balls_{};
  double error_;
  LimitEvaluator evaluator_;
  std::size_t degree_, tips_ = 0;
  std::vector<Draft> drafts_;
  std::vector<QuadPiece> pieces_;
};

}  // namespace snug
