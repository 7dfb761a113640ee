#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace checker {

enum class Scheme : std::uint8_t { loop, catmark, doo_sabin, midedge };
inline constexpr std::array<Scheme, 4> schemes{Scheme::loop, Scheme::catmark, Scheme::doo_sabin,
                                               Scheme::midedge};
[[nodiscard]] const char* name_of(Scheme scheme);

/// Faces around a corner of a patch, as snug/patch/neighbourhood.h names them: `after` counter-clockwise from
/// the patch, `before` clockwise; all in `after` if the fan is closed. Dual schemes: vertices of the face at
/// the corner.
struct Fan {
  std::uint16_t before = 0, after = 0;
  bool closed = false, sharp = false;
  [[nodiscard]] unsigned faces() const { return 1u + before + after; }
  /// Where all corners are so the patch is polynomial.
  [[nodiscard]] bool regular(Scheme scheme) const;
  friend auto operator<=>(const Fan&, const Fan&) = default;
};

/// Loop has three corners; the last one is then `no_corner`.
using Key = std::array<Fan, 4>;
inline constexpr Fan no_corner{0, 5, true, false};
[[nodiscard]] std::string to_text(Scheme scheme, const Key& key);

struct StoredTable {
  using Plane = std::array<double, 3>;
  std::vector<std::array<double, 2>> layout;
  std::array<std::array<double, 2>, 3> triangle{};
  std::vector<Plane> lower, upper;  // of control points first_bounded(), ...
};

/// The first control point that a table has planes of: Loop's corners need none.
[[nodiscard]] constexpr std::size_t first_bounded(Scheme scheme) { return scheme == Scheme::loop ? 3 : 0; }

struct StoredRows {
  std::uint32_t rows = 0, controls = 0;
  double entry_error = 0, abs_sum = 0;
  std::vector<double> weights;  // [control][row]
  [[nodiscard]] double& weight(std::size_t row, std::size_t control) { return weights[control * rows + row]; }
  [[nodiscard]] double weight(std::size_t row, std::size_t control) const {
    return weights[control * rows + row];
  }
};

/// Weights of the Bezier points of a quadratic over the patch: corners, then middles of the edges 01, 12, 20.
using SixWeights = std::array<double, 6>;

/// Rows from `first` on that are the control points of a piece, a patch of kind `key`; and the Bezier points
/// of the quadratic over that piece.
struct StoredNet {
  Key key;
  std::uint64_t first = 0;
  std::array<SixWeights, 6> restriction{};
};

/// Rows by which a patch and a quadratic are compared: the first ones are Bezier points of pieces, of which
/// the quadratic's are stored, too.
struct StoredComparison : StoredRows {
  std::vector<SixWeights> quadratic;
  std::vector<StoredNet> nets;
};

/// Places of control points in the plane, upper bounds of basis functions, and corners of a polygon: where
/// limit points of the places are less their parameters, up to an error a coordinate.
struct StoredFrame {
  std::vector<std::array<double, 2>> layout;
  std::vector<double> largest;
  double offset_error = 0;
  std::vector<std::array<double, 2>> offsets;
};

/// Data that quadratic triangles near patches rest on.
struct StoredQuadratics {
  std::vector<SixWeights> fit;  // of each control point; nothing rests on them
  std::array<StoredComparison, 2> comparisons;
  std::optional<StoredFrame> frame;
};

struct StoredKind : StoredRows {
  Scheme scheme = Scheme::loop;
  Key key;
  std::vector<StoredTable> tables;
  std::optional<StoredQuadratics> quadratics;
};

struct BoundsFile {
  std::string text;
  std::vector<StoredKind> kinds;
};

/// Reads a file of the format in tablegen/file_writer.h, version 5. Any bytes may come.
/// Errors:    Rejected if it is not one: magic, version, sizes, hash, flags that are neither 0 nor 1, padding
///            that is not zero, numbers that are not finite.
[[nodiscard]] BoundsFile parse(std::span<const std::byte> bytes);

/// The file of these contents, with the right hash.
[[nodiscard]] std::vector<std::byte> to_bytes(const BoundsFile& file);

/// Writes the right length and hash into the header of bytes that were changed; nothing where they are too
/// few.
void seal(std::vector<std::byte>& bytes);

}  // namespace checker
