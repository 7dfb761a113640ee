#pragma once

#include <functional>
#include <optional>
#include <string>
#include <unordered_map>

#include <snug/certificate/net_range.h>

namespace snug {

/// One of the two sets of a question: pieces of a placed surface; or points and, of a half-line, where it goes.
struct CertifiedSide {
  NetRange* pieces = nullptr;
  Motion pose;
  std::vector<Point3> points;
  std::optional<Vector3> direction;
  /// No coordinate on the way to where the points are placed is larger: what rounding is a share of.
  double magnitude = 0;
};
[[nodiscard]] CertifiedSide side_of(NetRange& pieces, const Motion& pose);
[[nodiscard]] CertifiedSide side_of(std::vector<Point3> points, std::optional<Vector3> direction = {});

/// The budget of a search for a proof, and its monitor.
struct ProofLimits {
  std::size_t leaves;
  const WorkMonitor& monitor;
};

enum class Found : std::uint8_t {
  proof,
  too_many_leaves,
  at_rounding,  ///< what remains cannot be told from a common point in doubles
};

/// Appends a proof that one piece crosses a half-line, or false.
using AppendCrossing = std::function<bool(std::string& text, NetRange& piece)>;

/// Appends a tree that proves two sets to be more than `margin` apart, as docs/certificates.md has it. Without a proof
/// what was appended is of no use. The tree is proved by who checks it: this is a search in double precision.
/// `crossing`, if given, is asked about pieces of the first set that are not seen to be apart from the second.
[[nodiscard]] Found append_separation(std::string& text, const std::array<CertifiedSide, 2>& sides,
                                      double margin, const ProofLimits& limits,
                                      const AppendCrossing& crossing = {});

[[nodiscard]] Box3 box_of(std::span<const Point3> points);
[[nodiscard]] std::vector<Point3> corners_of(const Box3& box);

/// A direction of integers with `b` farther along than `a` by more than `margin`, and by more than the rounding of points
/// whose coordinates are up to `magnitude`; nothing if none is found. `hint` is tried first, and is then the direction in which
/// the two were separated best.
[[nodiscard]] std::optional<std::array<std::int64_t, 3>> separating_direction(std::span<const Point3> a,
                                                                              std::span<const Point3> b,
                                                                              double margin, double magnitude,
                                                                              Vector3& hint);
/// A half-line from one of these points, all of which are meant.
struct HalfLine {
  std::vector<Point3> from;
  Vector3 along;
};
/// The same with a half-line for `b` and no margin.
[[nodiscard]] std::optional<std::array<std::int64_t, 3>> separating_direction(std::span<const Point3> a,
                                                                              const HalfLine& b,
                                                                              double magnitude,
                                                                              Vector3& hint);

}  // namespace snug
