#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <experiments/volume_tree.h>
#include <snug/run.h>
#include <snug/surface/limit_surface.h>

/// The measurements behind the dissertation's tables 5.1 to 5.3: triangles, creation, queries in rooms; and of
/// sorts of volumes, of which its text speaks.
namespace snug {

/// Tolerances of the tables, of models of size 1.
inline constexpr std::array table_tolerances{0.02, 0.01, 0.005};
/// Rooms: the two that are printed, then two in which about as many placements collide as the text says of
///        those.
inline constexpr std::array room_sides{6.0, 3.0, 4.5, 2.4};

/// Table 5.1: leaves at one tolerance.
struct LeafCounts {
  std::uint64_t rows = 0;     ///< bounding rows
  std::uint64_t tables = 0;   ///< the dissertation's tables, for every kind of patch
  std::uint64_t printed = 0;  ///< its tables, and at most one extraordinary corner, as it has it
  std::uint64_t boxes =
      0;  ///< AABBs around control points, until half the longest side is half the tolerance
};
[[nodiscard]] LeafCounts count_leaves(const LimitSurface& surface, double tolerance,
                                      const WorkMonitor& monitor = {});

/// Table 5.2: processor time from a control mesh in memory until queries can be asked, in seconds, medians.
/// Kinds are known beforehand, as tables were then.
struct CreationTimes {
  double model = 0;    ///< a query model as it is by default: pieces are bounded when a query touches them
  double tight = 0;    ///< one with a tight tree
  double rows = 0;     ///< all leaves by bounding rows and a tree of oriented boxes
  double printed = 0;  ///< the same by the dissertation's tables, at most one extraordinary corner
};
/// Errors:    InputError (value) unless rounds >= 1.
[[nodiscard]] CreationTimes measure_creation(const ControlMesh& mesh, const SchemeOptions& rules,
                                             double tolerance, unsigned rounds,
                                             const WorkMonitor& monitor = {});

struct RoomOptions {
  double side = 3;
  double tolerance = 0.01;
  std::size_t placements = 150'000;
  std::uint64_t seed = 1;
};

/// Table 5.3: queries for random placements in a room, and what they answered. Times are processor times a
/// query, in seconds, of one thread, after a few hundred queries that are not timed. Models have tight trees.
///
/// The text adds an epsilon to the radii without saying which: the tolerance, which is timed, or Moeller's
/// own.
struct RoomRow {
  double rows = 0;         ///< collide(), bounding rows
  double tables = 0;       ///< collide(), the dissertation's tables
  double printed = 0;      ///< the dissertation's hierarchy with its own pair test
  std::uint64_t hits = 0;  ///< the limit surfaces meet, or are at most 1e-7 apart
  std::uint64_t within =
      0;  ///< collide() shows two points at most the tolerance apart: these the text promises to announce
  std::uint64_t printed_missed = 0;          ///< of these, that the printed test calls separated
  std::uint64_t printed_missed_moeller = 0;  ///< the same with Moeller's own epsilon, 1e-6
  std::uint64_t printed_missed_hits = 0;     ///< hits that it calls separated, with either epsilon
  std::uint64_t printed_alarms = 0;          ///< farther apart than the tolerance, and not called separated
};
/// Requires:  unit models (rooms.h).
/// Errors:    InputError (value) unless placements >= 1.
/// Guarantee: the counts depend on the surfaces and options alone.
[[nodiscard]] RoomRow measure_room(const LimitSurface& a, const LimitSurface& b, const RoomOptions& options,
                                   const WorkMonitor& monitor = {});

/// The queries of one room by a tree of one sort of volumes over bounding rows' leaves.
struct VolumeRow {
  Volume volume = Volume::obb;
  Turning turning = Turning::bounded;
  std::uint64_t bytes = 0;         ///< of the volumes of both trees
  double volume_tests = 0;         ///< a query
  double triangle_tests = 0;       ///< a query
  double seconds = 0;              ///< processor time a query, the median of five rounds in turn
  std::uint64_t possible = 0;      ///< placements in which a pair of leaves is not apart
  std::uint64_t verdicts_sum = 0;  ///< a checksum of all verdicts, the same for all rows
};
/// Comparison of volumes with equal hierarchy, leaves, order and test at leaves: how many tests each sort needs,
/// and what following a rotation costs. A row for each sort, and each turning of the k-DOPs.
/// Requires:  unit models (rooms.h).
/// Errors:    InputError (value) unless placements >= 1.
/// Guarantee: all but the times depends on the surfaces and options alone.
[[nodiscard]] std::vector<VolumeRow> measure_volumes(const LimitSurface& a, const LimitSurface& b,
                                                     const RoomOptions& options,
                                                     const WorkMonitor& monitor = {});

}  // namespace snug
