#pragma once

#include <span>
#include <vector>

#include <snug/collide.h>

namespace snug {

/// A velocity and an angular velocity that stay what they are, in world coordinates, for one unit of time.
struct SteadyMotion {
  Vector3 velocity{};     ///< of the point `about`
  Vector3 axis{0, 0, 1};  ///< of the rotation, of any positive length
  double radians = 0;  ///< rotated in one unit of time, counterclockwise when the axis points at the viewer
  Point3 about{};      ///< at time 0; it moves with the surface
};

/// How a surface moves: a pose for every time in [0, duration()], continuous in time.
///
/// Over [i, i + 1] it moves as piece i does, with s = t - i:
///
///   S(s) x = Q(s) (R x + t - about) + about + s velocity + (sin(s radians) turning + (1 - cos(s radians)) n x turning) / radians
///
/// where (R | t) is the pose `from`, n = axis / |axis|, and Q(s) rotates by s radians about n. A piece that
/// ends in a given pose moves by S(s) + s (to - S(1)): exactly from `from` to `to`. All of this is meant in
/// exact arithmetic for the doubles of the piece.
class SNUG_API Trajectory {
 public:
  /// Stays at a pose for ever: duration() is 0.
  Trajectory(const Motion& pose);  // NOLINT: implicit, as a pose that does not change

  /// From one pose to another in one unit of time, with a constant twist: along and about the axis of the
  /// screw that takes `from` to `to`, with the shorter rotation.
  /// Errors:    InputError (pose) if the rotations differ by half a turn, up to 4e-8: there is no shorter one;
  ///            (unrepresentable) if the way between the poses does not fit a double.
  [[nodiscard]] static Trajectory screw(const Motion& from, const Motion& to);
  /// The same from pose to pose, in one unit of time each.
  /// Errors:    as screw(), with the number of the pose; (value) if there is none.
  [[nodiscard]] static Trajectory through(std::span<const Motion> poses);
  /// From a pose, for one unit of time. Any number of turns.
  /// Errors:    InputError (value) for numbers that are not finite and an axis of no length.
  [[nodiscard]] static Trajectory steady(const Motion& from, const SteadyMotion& motion);

  [[nodiscard]] double duration() const { return static_cast<double>(pieces_.size()); }
  /// The pose at a time in double precision: up to some roundings, exact where a given pose is.
  /// Errors:    InputError (value) for a time that is not in [0, duration()], but for those that stay.
  [[nodiscard]] Motion at(double time) const;

  /// See above. Those of screw() move with velocity along the axis and `turning` across it, `about` being
  /// the translation of `from`; those of steady() have no `turning`.
  struct Piece {
    Motion from{}, to{};
    bool ends = false;  ///< in `to`
    Vector3 axis{0, 0, 1};
    double radians = 0;
    Point3 about{};
    Vector3 velocity{}, turning{};
  };
  [[nodiscard]] std::span<const Piece> pieces() const { return pieces_; }
  [[nodiscard]] const Motion& start() const { return start_; }

 private:
  Motion start_;
  std::vector<Piece> pieces_;
};

/// A surface whose control points go along lines, each at a constant speed, while a trajectory places it.
struct DeformingSurface {
  Surface surface;  ///< at time 0
  /// The control points at time 1, one for each vertex of the mesh, kept by the caller. Empty: they stay.
  std::span<const Point3> end{};
  Trajectory motion = Motion();
};

struct TimeOfContactOptions {
  /// >= 0, mesh units. Surfaces this close may be reported as within, and times are told to what the surfaces
  /// move by so much in. With 0 only proofs of contact or separation count. Default: 0.1 % of the larger
  /// surface's size, at time 0.
  std::optional<double> tolerance{};
  bool solid = false;  ///< of the solids that closed surfaces bound: one inside the other is in contact
  bool prove_contact = true;       ///< before returning `within`, try to prove `intersecting`
  std::uint64_t budget = 100'000;  ///< most splits for each time that is looked at
  int max_looks = 1000;            ///< most times that are looked at in each unit of time
};

/// The first contact of two moving surfaces.
struct TimeOfContact {
  /// separated: they never meet. within: at time.upper they are at most the tolerance apart. intersecting:
  /// they have a common point at some time in `time`. undecided: none of these could be shown.
  Verdict verdict = Verdict::undecided;
  /// At no time before the lower end they have a common point. The upper end is infinite if nothing shows
  /// that they come near each other, as for `separated`, whose lower end is the end of the motion.
  Interval time{0, std::numeric_limits<double>::infinity()};
  /// Is `time` so short that no point of one surface moves by more than the tolerance, or 1e-10 of the size,
  /// against the other one? Where control points move: none that could meet a point of it.
  bool reached = false;
  std::optional<std::array<Point3, 2>> witness;  ///< of the closest points found at time.upper, on A and on B
  double witness_error = 0;                      ///< as in Collision
  WitnessPlaces at;                              ///< as in Collision
  std::optional<std::size_t> inner;              ///< with `solid`: as in Collision
  int looks = 0;                                 ///< times that were looked at
  SearchStats stats;
};

/// When do two moving limit surfaces first touch?
///
/// Guarantee: at no time in [0, time.lower) the surfaces (with `solid` the solids) have a common point, at
///            time.lower neither unless it is 0 or time.upper; with `separated` at none in all. `intersecting`
///            and `within` hold at time.upper or, for `intersecting`, between the ends. All for the exact
///            motions of the Trajectory, rounding included. The answer depends on the input alone.
/// Requires:  motions of the same duration, or one that stays.
/// Errors:    InputError: (value) for a tolerance that is negative or not finite, and for durations that
///            differ; (unrepresentable) if a result does not fit a double; (refused) if no face of a mesh has
///            a limit surface, and with `solid` if a surface is not closed. Interrupted.
/// Cost:      some dozen distance queries (bench/results/contact_time.txt).
/// Source:    conservative advancement [Mirtich96]; differs: a time that is looked at clears what is before it
///            too, and everything is rounded outward, see derivations/time_of_contact.md.
[[nodiscard]] SNUG_API TimeOfContact time_of_contact(const Surface& a, const Trajectory& motion_a,
                                                     const Surface& b, const Trajectory& motion_b,
                                                     const TimeOfContactOptions& options = {},
                                                     const WorkMonitor& monitor = {},
                                                     Workspace& workspace = Workspace::of_this_thread());

/// The same where control points move: at time s they are (1 - s) times those of the mesh plus s times `end`,
/// in exact arithmetic, and so is the limit surface. A part that turns is cut short: give it as several steps.
///
/// Requires:  motions that stay or last for one unit of time.
/// Errors:    also InputError (value) for another number of control points than the mesh has, (refused) for
///            one that is not finite.
/// Cost:      some dozen distance queries, and a BVH for each (bench/results/contact_time.txt).
[[nodiscard]] SNUG_API TimeOfContact time_of_contact(const DeformingSurface& a, const DeformingSurface& b,
                                                     const TimeOfContactOptions& options = {},
                                                     const WorkMonitor& monitor = {},
                                                     Workspace& workspace = Workspace::of_this_thread());

}  // namespace snug
