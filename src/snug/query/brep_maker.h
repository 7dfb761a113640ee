#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include <snug/brep.h>
#include <snug/query/brep_layout.h>
#include <snug/spline/face_spline.h>
#include <support/scaling.h>

namespace snug {

/// Share of the requested error for what is fitted; the rest is for rounding.
inline constexpr double share_of_fits = 0.999;
/// The same for how far faces are bent into the tangent planes of extraordinary vertices.
inline constexpr double share_of_flats = 0.5;
/// Sine of the angle between normals that are taken for one.
inline constexpr double same_plane = 1e-9;
/// Rounds of splits towards a requested angle.
inline constexpr int most_angle_rounds = 16;

/// Makes the boundary representation of one surface. Classes that follow know how its faces become B-spline surfaces; here they are
/// joined.
class BrepMaker {
 public:
  BrepMaker(const LimitSurface& surface, const BrepOptions& options, const Run& run);
  BrepMaker(const BrepMaker&) = delete;
  BrepMaker& operator=(const BrepMaker&) = delete;
  virtual ~BrepMaker() = default;

  [[nodiscard]] Brep run();

 protected:
  /// A tangent break on the border of a face: beside this quad, at this parameter of its side.
  struct Break {
    std::uint32_t quad;
    std::size_t side;
    double at;
    double angle = 0;  // in largest angles that are allowed
  };

  /// Splits until faces are near enough, or the budget is spent; sets drafts_.
  virtual void fit() = 0;
  /// Called before faces are made, again where `again`: false if the budget does not allow it then.
  [[nodiscard]] virtual bool prepare([[maybe_unused]] bool again) { return true; }
  /// Puts a face and its bound there.
  virtual void make_face(const FaceDraft& draft, Brep::Face& face) const = 0;
  /// Are faces here not known to be smooth?
  [[nodiscard]] virtual bool may_break(const FaceDraft& draft) const = 0;
  /// Splits at tangent breaks that are too large; false if nothing was split.
  virtual bool deepen_at_breaks(const std::vector<Break>& breaks) = 0;

  /// The B-spline surface of parts, in mesh units, and its bound.
  void take_parts(const std::vector<FacePart>& parts, std::size_t natural, Brep::Face& face) const;
  void require_spans(std::uint64_t least) const;

  const LimitSurface& surface_;
  const Run& run_;
  const WorkMonitor& monitor_;
  BrepLayout layout_;
  PowerOfTwo back_;
  double error_;  // in scaled units
  std::optional<double> max_angle_;
  std::uint64_t budget_;  // of spans
  bool spent_ = false;
  std::vector<FaceDraft> drafts_;

 private:
  [[nodiscard]] double scaled_error(const BrepOptions& options) const;
  [[nodiscard]] std::optional<Brep> assembled(bool again);
  void join(Brep& brep);
  [[nodiscard]] bool is_diagonal(const JointUse& use) const;
  [[nodiscard]] SplineCurve curve_of(const Brep& brep, const JointUse& use, bool backwards) const;
  [[nodiscard]] double gap_of(const Brep& brep, const JointUse& use, bool backwards,
                              const SplineCurve& curve) const;
  [[nodiscard]] std::array<double, 2> on_side(const FaceDraft& draft, std::size_t side, double t) const;
  [[nodiscard]] Break place_of(const JointUse& use, double t) const;
  void measure_breaks(Brep& brep);
  [[nodiscard]] double break_of(const Brep& brep, const FaceJoint& joint, std::vector<Break>& breaks) const;

  std::vector<FaceJoint> joints_;
  std::vector<Break> breaks_;
};

/// Of schemes of quads, and of Loop's.
[[nodiscard]] Brep brep_of_quads(const LimitSurface& surface, const BrepOptions& options, const Run& run);
[[nodiscard]] Brep brep_of_triangles(const LimitSurface& surface, const BrepOptions& options, const Run& run);

}  // namespace snug
