#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <snug/query/linear_patches.h>
#include <snug/query/trajectory.h>
#include <snug/search/piece_cache.h>
#include <snug/time_of_contact.h>

namespace snug {

/// (1 - s) p + s q for each two points, in double precision; exact for s = 0 and s = 1.
[[nodiscard]] std::vector<Point3> points_between(std::span<const Point3> p, std::span<const Point3> q,
                                                 double s);

/// Control points that go along lines from those of a model to others: the surface at any time between.
class Deformation {
 public:
  /// Requires:  the model and the points outlive it.
  /// Errors:    InputError: those of LimitSurface::move(); (unrepresentable) if a velocity does not fit a double.
  Deformation(const SurfaceBvh& model, PieceCache& scratch, std::span<const Point3> end);

  struct Shape {
    const SurfaceBvh& model;
    PieceCache& scratch;
    double error;  ///< upper bound of the distance of its limit points from the exact ones, in mesh units
  };
  /// At s in [0, 1]; until the next call.
  [[nodiscard]] Shape at(double s);
  /// Upper bound of the velocity of any limit point.
  [[nodiscard]] double speed() const { return speed_; }

 private:
  const SurfaceBvh& model_;
  PieceCache& scratch_;
  std::span<const Point3> end_;
  double largest_ = 0, speed_ = 0;
  double time_ = 0;  // of what follows
  SharedPlan plan_;
  std::optional<LimitSurface> surface_;
  std::optional<SurfaceBvh> moved_;
  std::optional<PieceCache> moved_scratch_;
};

/// A model that moves, with a cache as in PlacedBvh.
struct MovingBvh {
  const SurfaceBvh& model;  ///< at time 0
  PieceCache& scratch;
  const Trajectory& motion;
  std::span<const Point3> end{};  ///< as in DeformingSurface
};

/// One side of a time of contact: a surface with its motion, during one piece of it after the other.
class MovingBody {
 public:
  /// Errors:    those of Deformation and PieceMotion.
  explicit MovingBody(const MovingBvh& moving);

  [[nodiscard]] const SurfaceBvh& model() const { return moving_.model; }
  [[nodiscard]] PieceCache& scratch() const { return moving_.scratch; }
  [[nodiscard]] bool deforms() const { return deformation_ != nullptr; }
  [[nodiscard]] double duration() const {
    return deforms() ? std::max(1.0, moving_.motion.duration()) : moving_.motion.duration();
  }
  void enter_piece(std::size_t piece);
  [[nodiscard]] const PieceMotion& piece() const { return *piece_; }
  /// Upper bound of the velocity of any limit point during the piece.
  [[nodiscard]] double speed();
  /// Its patches, if all of them go along lines at constant speeds during the piece.
  [[nodiscard]] std::optional<LinearPatches> linear_patches() const;

  /// At time 0, without rounding.
  [[nodiscard]] PlacedBvh at_start() const {
    return {moving_.model, moving_.scratch, moving_.motion.start()};
  }
  /// At a time s of the piece; until the next call.
  struct Place {
    Deformation::Shape shape;
    BoundedPose pose;
    /// Upper bound of the distance of its points from the exact places.
    /// Requires:  no coordinate of a point is larger than `reach`, before it is placed.
    [[nodiscard]] double deviation(double reach) const {
      const double turned = shape.error == 0 ? 0 : enlarged(shape.error * (1 + 2 * pose.pose.defect()));
      return turned == 0 ? pose.deviation(reach) : enlarged(pose.deviation(reach + shape.error) + turned);
    }
  };
  [[nodiscard]] Place at(double s);

 private:
  const MovingBvh& moving_;
  std::unique_ptr<Deformation> deformation_;
  std::optional<PieceMotion> piece_;
};

}  // namespace snug
