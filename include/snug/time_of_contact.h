#pragma once

#include <span>
#include <vector>

#include <snug/collide.h>

namespace snug {

/// A constant velocity and a constant angular velocity, in world coordinates, for one unit of time.
struct SteadyMotion {
  Vector3 velocity{};     ///< of the point `about`
  Vector3 axis{0, 0, 1};  ///< of the rotation, of any positive length
  double radians = 0;  ///< rotated in one unit of time, counterclockwise when the axis points at the viewer
  Point3 about{};      ///< centre of rotation at time 0; it moves with the surface
};

/// A joint of a chain: it turns about an axis through the origin of its frame, or slides along it.
struct ChainJoint {
  Motion frame{};         ///< in that of the joint before, or of the world
  Vector3 axis{0, 0, 1};  ///< in its frame, of any positive length
  bool slides = false;
};

/// How a surface moves: a pose for every time in [0, duration()], continuous in time.
///
/// Over [i, i + 1] piece i defines the motion, with s = t - i:
///
///   S(s) x = Q(s) (R x + t - about) + about + s velocity + (sin(s radians) turning + (1 - cos(s radians)) n x turning) / radians
///
/// where (R | t) is the pose `from`, n = axis / |axis|, and Q(s) rotates by s radians about n. A piece that
/// ends in a given pose moves by S(s) + s (to - S(1)): exactly from `from` to `to`. A piece of a chain moves by
/// C(s) + (1 - s) (from - C(0)) + s (to - C(1)), likewise, where C(s) is the product of the chain's frames and of its joints at
/// (1 - s) from + s to. All of this is in exact arithmetic, for the doubles of the piece.
class SNUG_API Trajectory {
 public:
  /// Stays at a pose forever: duration() is 0.
  Trajectory(const Motion& pose);  // NOLINT: implicit, a pose that does not change

  /// From one pose to another in one unit of time, with a constant twist: along and about the axis of the
  /// screw that takes `from` to `to`, with the shorter rotation.
  /// Errors:    InputError (pose) if the rotations differ by half a turn, up to 4e-8: there is no shorter one;
  ///            (unrepresentable) if the motion between the poses does not fit a double.
  [[nodiscard]] static Trajectory screw(const Motion& from, const Motion& to);
  /// The same through a list of poses, one unit of time from each pose to the next.
  /// Errors:    those of screw(), with the number of the pose; (value) if there is no pose.
  [[nodiscard]] static Trajectory through(std::span<const Motion> poses);
  /// Starts at a pose and moves for one unit of time. Any number of turns.
  /// Errors:    InputError (value) for numbers that are not finite and for an axis of length 0.
  [[nodiscard]] static Trajectory steady(const Motion& from, const SteadyMotion& motion);
  /// The motion of the end of a chain of joints: `tip` is its pose in the frame that the last joint moves. In each unit of time every joint
  /// goes at a constant speed from its position in one list to that in the next: radians, or a length.
  /// Errors:    InputError: (value) for no positions, lists that are not as long as the chain, numbers that are not finite,
  ///            more than 1e8 turns, an axis of length 0; (pose), (unrepresentable) if a pose does not fit doubles.
  [[nodiscard]] static Trajectory joints(std::span<const ChainJoint> chain, const Motion& tip,
                                         std::span<const std::vector<double>> positions);

  [[nodiscard]] double duration() const { return static_cast<double>(pieces_.size()); }
  /// The pose at a time in double precision: up to some roundings, and exact at times of given poses.
  /// Errors:    InputError (value) for a time that is not in [0, duration()], except for a pose that stays.
  [[nodiscard]] Motion at(double time) const;

  /// See above. Pieces of screw() have `velocity` along the axis and `turning` across it, and `about` is the
  /// translation of `from`; pieces of steady() have no `turning`.
  struct Piece {
    Motion from{}, to{};
    bool ends = false;  ///< true: ends exactly in `to`
    Vector3 axis{0, 0, 1};
    double radians = 0;
    Point3 about{};
    Vector3 velocity{}, turning{};
    struct JointPath {
      ChainJoint joint;
      double from, to;
    };
    std::vector<JointPath> chain{};  ///< not empty: these move it, and none of the numbers above
    Motion tip{};
  };
  [[nodiscard]] std::span<const Piece> pieces() const { return pieces_; }
  [[nodiscard]] const Motion& start() const { return start_; }

 private:
  Motion start_;
  std::vector<Piece> pieces_;
};

/// A surface whose control points move along lines, each at a constant speed, while a trajectory places it.
struct DeformingSurface {
  Surface surface;  ///< at time 0
  /// The control points at time 1, one for each vertex of the mesh, kept by the caller. Empty: they stay.
  std::span<const Point3> end{};
  Trajectory motion = Motion();
};

struct TimeOfContactOptions {
  /// >= 0, mesh units. Surfaces this close may be reported as within, and the time interval is narrowed until
  /// the surfaces move by at most this much in it. With 0 only proofs of contact or separation count.
  /// Default: 0.1 % of the larger surface's size, at time 0.
  std::optional<double> tolerance{};
  bool solid = false;  ///< compare the solids that closed surfaces bound: one inside the other is in contact
  bool prove_contact = true;  ///< before returning `within`, try to prove `intersecting`
  /// >= 0, mesh units. With a margin contact is being at most so far apart: `separated` surfaces are always farther apart,
  /// `within` means at most margin + tolerance, and the time interval is that of coming so near.
  double margin = 0;
};

/// The first contact of two moving surfaces.
struct TimeOfContact {
  /// separated: they never meet. within: at time.upper they are at most the tolerance apart. intersecting:
  /// they have a common point at some time in `time`, with a margin at time.upper. undecided: none of these could be shown.
  Verdict verdict = Verdict::undecided;
  /// The surfaces have no common point at any time before the lower end. The upper end is infinite if they were
  /// not found to come near each other, as for `separated`, whose lower end is the end of the motion.
  Interval time{0, std::numeric_limits<double>::infinity()};
  /// `complete` if in `time` no point that could meet the other surface moves by more than the tolerance, or 1e-10 of
  /// the size, relative to it.
  Outcome outcome = Outcome::complete;
  std::optional<WitnessPoints> witness;  ///< the closest points found at time.upper
  std::optional<std::size_t> contained;  ///< with `solid`: as in Collision, at time 0
  int steps = 0;                         ///< number of times evaluated
  SearchStats stats;
};

/// When do two moving limit surfaces first touch?
///
/// Guarantee: the surfaces (with `solid` the solids) have no common point at any time in [0, time.lower), nor at
///            time.lower itself unless it is 0 or time.upper; with `separated`, at no time at all. `within`
///            holds at time.upper; `intersecting` holds at time.upper or between the ends, for the exact motions.
/// Budget:    1,000,000 in each unit of time: a split of a patch and a pair of nodes followed through an interval count
///            1, a time evaluated 1000; no single time takes more than a sixteenth. 256 bytes each.
/// Requires:  motions of the same duration, or one surface that stays.
/// Errors:    InputError: (value) for a tolerance or margin that is negative or not finite, and for durations that
///            differ; (unrepresentable) if a result does not fit a double; (refused) if no face of a mesh has
///            a limit surface, and with `solid` if a surface is not closed. Interrupted.
/// Cost:      some dozen distance queries (bench/results/contact_time.txt); where parts slide or turn close to each
///            other, up to some 80,000 pairs of nodes of a microsecond each.
/// Source:    conservative advancement [Mirtich96]; differs: each time evaluated also clears an interval before
///            it, pairs of nodes are kept apart by one direction over whole intervals, and everything is rounded
///            outward, see derivations/time_of_contact.md.
[[nodiscard]] SNUG_API TimeOfContact time_of_contact(const Surface& a, const Trajectory& motion_a,
                                                     const Surface& b, const Trajectory& motion_b,
                                                     const TimeOfContactOptions& options = {},
                                                     const Run& run = {});

/// The same for moving control points: at time s they are (1 - s) times those of the mesh plus s times `end`.
/// Points of a turning part thus move along chords; split a large rotation into several steps.
///
/// Requires:  motions that stay or last for one unit of time.
/// Errors:    also InputError (value) if the number of control points is not that of the mesh, (refused) for a
///            control point that is not finite.
/// Cost:      some dozen distance queries, and a BVH for each (bench/results/contact_time.txt).
[[nodiscard]] SNUG_API TimeOfContact time_of_contact(const DeformingSurface& a, const DeformingSurface& b,
                                                     const TimeOfContactOptions& options = {},
                                                     const Run& run = {});

}  // namespace snug
