#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <experiments/rooms.h>
#include <snug/mesh/control_mesh.h>

#include "query.h"
#include "runner.h"

namespace snug::bench {

/// A model of examples/models, of size 1 (unit_model).
struct Model {
  std::string name;
  ControlMesh mesh;
};
/// Errors:    as read_mesh.
[[nodiscard]] std::vector<Model> read_models(const std::vector<std::string>& files);
/// Errors:    std::runtime_error if no model has the name.
[[nodiscard]] const Model& named(const std::vector<Model>& models, const std::string& name);

/// The pairs that [Wu05, table 5.3] measures, by the names that our models have.
inline constexpr std::array<std::array<const char*, 2>, 3> model_pairs{
    {{"bust", "head"}, {"star", "pawn"}, {"demon", "figure"}}};

/// How near two placed models are, in the order of what is tried first.
enum class Nearness : std::uint8_t {
  colliding,  ///< two points of the limit surfaces are at most 1e-7 apart
  grazing,    ///< apart, by less than 2 % of the size
  near,       ///< by less than 10 %, or the models' boxes overlap
  far,        ///< all others
};
inline constexpr std::array all_nearness{Nearness::colliding, Nearness::grazing, Nearness::near,
                                         Nearness::far};
[[nodiscard]] const char* name_of(Nearness nearness);

struct Placed {
  PosePair at;
  Nearness nearness;
};

/// Random placements in a room of this side, each sorted once by tight queries that prove what they say.
[[nodiscard]] std::vector<Placed> sorted_placements(const Model& a, const Model& b, double side,
                                                    std::size_t count, std::uint64_t seed);
/// Those of one sort.
[[nodiscard]] std::vector<PosePair> of(const std::vector<Placed>& all, Nearness nearness);
[[nodiscard]] std::vector<PosePair> of(const std::vector<Placed>& all);

/// Placements near first contact: random ones whose model b comes along the line of the middles until the
/// models touch, then goes on or back by up to `reach`, evenly. Those that pass by each other stay as they
/// are drawn.
[[nodiscard]] std::vector<PosePair> contact_placements(const Model& a, const Model& b, double side,
                                                       double reach, std::size_t count, std::uint64_t seed);

/// Loop where all faces are triangles, else Catmull-Clark.
[[nodiscard]] Scheme usual_scheme(const ControlMesh& mesh);

/// Loop, boundary edge and corner: the rules that peers get, too.
[[nodiscard]] inline SchemeOptions loop_rules() { return {Scheme::loop, BoundaryRule::edge_and_corner}; }

/// Prints "bar  what: value, at least (at most) limit: ok" or "missed".
void at_least(const std::string& what, double value, double limit);
void at_most(const std::string& what, double value, double limit);

/// Bytes that the process has from malloc at the moment. Linux's C library alone tells.
[[nodiscard]] std::size_t heap_bytes();

}  // namespace snug::bench
