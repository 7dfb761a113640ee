#pragma once

#include <string>
#include <vector>

#include "runner.h"
#include "subject.h"

/// Contests about bounds of many patches, each printed and returned.
namespace snug::bench {

/// Contestants of bench_faces() and bench_quads().
inline constexpr const char *one_by_one = "offset triangle from bounding rows, a patch at a time",
                            *from_rows = "offset triangle from bounding rows",
                            *from_tables = "offset triangle from tables";
std::vector<Times> bench_faces(const std::string& title, Subject& subject, const std::vector<PatchId>& faces,
                               const Options& options);
/// Both ways of Catmull-Clark patches, by the corners of theirs that are not regular.
std::vector<std::vector<Times>> bench_quads(const std::string& title, const ControlMesh& mesh,
                                            const Options& options);

[[nodiscard]] inline SchemeOptions catmark() { return {Scheme::catmark, BoundaryRule::edge_and_corner}; }

/// Costs of bounding all patches of a mesh in memory, with empty caches.
struct ColdBounds {
  double radii = 0;  ///< their sum
  std::size_t kinds = 0, bytes = 0;
};
[[nodiscard]] ColdBounds cold_bounds(const ControlMesh& mesh);

/// Contestants of bench_creases(): beside Bfr, which approximates what is irregular, its set-up kept and with
/// it.
inline constexpr const char *bfr_cold = "Bfr: surfaces and boxes (no proof)",
                            *snug_cold = "snug: kinds, rows and bounds, cold";
std::vector<Times> bench_creases(const std::string& title, const ControlMesh& mesh, const Options& options);

}  // namespace snug::bench
