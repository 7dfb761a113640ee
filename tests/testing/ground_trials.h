#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <oracle/limit_twin.h>
#include <oracle/tagged_mesh.h>
#include <snug/scheme/scheme.h>
#include <snug/surface.h>
#include <testing/journeys.h>

/// Placed pairs of surfaces of every scheme, tag and rule, so that each two cases that can go together do.
namespace snug::testing {

/// Properties drawn for a surface. In a surface's choices entry i is one of the values of factor i.
enum class Factor : std::uint8_t { border, holes, connection, tags, triangles, valence, scheme, sets };
inline constexpr std::size_t factor_count = 8;
using Choices = std::array<std::uint8_t, factor_count>;

enum class Border : std::uint8_t { closed, none, edge_only, edge_and_corner };
enum class Connection : std::uint8_t { manifold, edge, vertex };
enum class Tags : std::uint8_t { none, sharp, semi_sharp, chaikin, dart, corner };

[[nodiscard]] std::size_t value_count(std::size_t factor);
[[nodiscard]] std::string name_of_value(std::size_t factor, std::size_t value);
/// Is there such a surface? Dual schemes take manifolds alone, and triangles are smoothed by Catmull-Clark
/// alone.
[[nodiscard]] bool is_possible(const Choices& choices);

/// Choices for A and for B, as one row; and the pairs of values that go together somewhere in a row.
using PairChoices = std::array<std::uint8_t, 2 * factor_count>;
using ValuePair = std::array<std::uint8_t, 4>;  // place and value, place and value, the lower place first
[[nodiscard]] std::set<ValuePair> pairs_of(const PairChoices& row);
/// All pairs that some possible row has.
[[nodiscard]] const std::set<ValuePair>& all_pairs();
/// Rows that have all pairs; the same ones every time.
[[nodiscard]] const std::vector<PairChoices>& covering_rows();

/// So many rows to have all pairs of cases, and some pairs of solids.
[[nodiscard]] std::uint64_t row_count();

/// A control mesh that has what was chosen.
struct GroundMesh {
  oracle::TaggedMesh mesh;
  oracle::Rules rules;
  Scheme scheme = Scheme::loop;
};
[[nodiscard]] GroundMesh make_mesh(const Choices& choices, std::mt19937_64& random);
/// The choices that the mesh does not realize; empty if it realizes all.
[[nodiscard]] std::string missing(const GroundMesh& made, const Choices& choices);

/// A surface as the library and as the twin see it.
struct GroundSide {
  Choices choices{};
  GroundMesh made;
  std::optional<Surface> surface;
  std::optional<Journey> journey;  ///< that it and its tree have made
  std::unique_ptr<oracle::LimitTwin> twin;
  double size = 0;  ///< longest side of the used vertices' box
  /// Of a solid: closed, without holes, and its edges have two faces.
  [[nodiscard]] bool is_solid() const;
  [[nodiscard]] bool has_many() const;  ///< faces around a vertex: 200 or more, with tables 100
  [[nodiscard]] BoundMethod bounds() const;
};

struct GroundTrial {
  std::uint64_t number = 0;
  std::string family;
  std::array<GroundSide, 2>* sides = nullptr;
  std::array<oracle::Placement, 2> places{oracle::kUnmoved, oracle::kUnmoved};
  double tolerance = 0, margin = 0;
  oracle::ContactBounds truth{};  ///< by the twin
  std::mt19937_64 random;         ///< for what the checks choose

  [[nodiscard]] double size() const { return std::max((*sides)[0].size, (*sides)[1].size); }
  /// A side as queries take it.
  [[nodiscard]] PlacedSurface placed(std::size_t side) const;
};

/// The same number, the same trial. The first trials go through row_count() rows, so many of each; then rows
/// are random. Surfaces that move come from elsewhere: their trees are made there and refitted, and what was known
/// of their pieces has to be forgotten.
class GroundTrials {
 public:
  explicit GroundTrials(std::uint64_t of_each_row, bool moving = false);
  ~GroundTrials();
  [[nodiscard]] GroundTrial make(std::uint64_t number);
  /// Of the trial that was made last.
  [[nodiscard]] const PairChoices& row() const { return row_; }

 private:
  struct Shared;
  void make_sides(std::uint64_t row);
  std::uint64_t of_each_row_;
  bool moving_;
  std::uint64_t made_ = UINT64_MAX;
  PairChoices row_{};
  std::array<GroundSide, 2> sides_;
  std::unique_ptr<Shared> shared_;
};

/// In words, with placements that read back exactly. Writes its meshes to a.obj and b.obj in the folder that
/// SNUG_DUMP names, if it does.
[[nodiscard]] std::string describe(const GroundTrial& trial);

}  // namespace snug::testing
