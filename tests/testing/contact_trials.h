#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>

#include <oracle/contact_twin.h>
#include <snug/surface.h>

/// Placed pairs of Loop surfaces on which the queries are tried, with what is known about them beforehand.
namespace snug::testing {

struct ContestantOptions : SurfaceOptions {
  /// Levels of the parts in which sound/lazy_trees_test.cpp makes their trees; 0: it passes them over.
  unsigned part_level = 0;
};

/// Two surfaces as the library and as the twin see them. The library's coordinates are the twin's times
/// 2^exponent.
class Contestants {
 public:
  Contestants(oracle::TwinMesh a, oracle::TwinMesh b, int exponent, const ContestantOptions& options = {});
  /// One surface twice.
  Contestants(oracle::TwinMesh both, int exponent, const ContestantOptions& options = {});

  [[nodiscard]] PlacedSurface placed(std::size_t side, const oracle::Placement& place) const;
  [[nodiscard]] const Surface& surface(std::size_t side) const { return *sides_[side].surface; }
  [[nodiscard]] oracle::ContactSurface& twin(std::size_t side);
  [[nodiscard]] const oracle::TwinMesh& mesh(std::size_t side) const { return *sides_[side].mesh; }
  [[nodiscard]] const ContestantOptions& options() const { return options_; }
  [[nodiscard]] int exponent() const { return exponent_; }
  [[nodiscard]] double size() const {
    return size_;
  }  ///< longest side of the used vertices' boxes, in twin units

  /// To and from the library's units.
  [[nodiscard]] double scaled(double length) const { return std::ldexp(length, exponent_); }
  [[nodiscard]] double back(double length) const { return std::ldexp(length, -exponent_); }
  [[nodiscard]] oracle::Point back(const Point3& p) const { return {back(p.x), back(p.y), back(p.z)}; }
  [[nodiscard]] Motion scaled(const oracle::Placement& place) const;

 private:
  struct Side {
    std::shared_ptr<oracle::TwinMesh> mesh;
    std::optional<Surface> surface;
    std::shared_ptr<oracle::ContactSurface> twin;  // made when it is asked for
  };
  void make(std::size_t side, oracle::TwinMesh mesh);

  std::array<Side, 2> sides_;
  int exponent_;
  ContestantOptions options_;
  double size_ = 0;
};

/// The true answer of a trial, in exact arithmetic for these very doubles.
struct Truth {
  double lower = 0;                                        ///< the distance is not less
  double upper = std::numeric_limits<double>::infinity();  ///< nor more
  bool apart = false;                                      ///< there is no common point
  bool meet = false;                                       ///< there is one
  bool crossing = false;  ///< and the surfaces pass through each other, well away from their borders
  std::optional<bool> nested = {};  ///< of closed surfaces apart: does one lie inside the other?
  /// Is the distance known, not only some bound of it?
  [[nodiscard]] bool whole() const { return meet || (lower > 0 && upper <= 2 * lower); }
};

struct Trial {
  std::uint64_t number = 0;
  std::string family;
  Contestants* pair = nullptr;
  oracle::Placement a = oracle::kUnmoved, b = oracle::kUnmoved;  ///< in twin units
  Truth truth;
  double tolerance = 0, margin = 0;  ///< in twin units
  bool solid = false, prove_contact = false;
  std::uint64_t budget = 0;
  bool hair = false;       ///< a hair apart: may be undecided at any tolerance
  std::mt19937_64 random;  ///< for what the checks choose
};

/// The trials: the same number, the same trial, whichever were made before.
///
/// Families of which the truth is known: parallel sheets, graphs over a square and the same graphs lifted,
/// graphs that touch in one point, shells in shells, seams, a surface and itself, planes that cross, borders
/// of half planes, tips at extraordinary vertices, mirror images, single triangles with whole-numbered
/// corners. Of the others the twin finds it: random surfaces, the same moved together until they are between
/// half and twice the tolerance apart, closed shells that cross, needles and flat meshes, several components.
class Trials {
 public:
  Trials();
  ~Trials();
  [[nodiscard]] Trial make(std::uint64_t number);

 private:
  struct Pool;
  std::unique_ptr<Pool> pool_;
};

/// How many trials to run: SNUG_PLACEMENTS, or so many; and the first: SNUG_FIRST, or 0.
[[nodiscard]] std::uint64_t trial_count(std::uint64_t usual);
[[nodiscard]] std::uint64_t first_trial();

/// The trial in words, with placements that read back exactly. Writes its meshes to a.obj and b.obj in the
/// folder that SNUG_DUMP names, if it does.
[[nodiscard]] std::string describe(const Trial& trial);

}  // namespace snug::testing
