#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <snug/certificate/net_range.h>

namespace snug {

/// A placed piece of a surface, and what a proof needs of it that something crosses it.
class Disc {
 public:
  Disc(std::unique_ptr<NetRange> piece, const Motion& pose) : piece_(std::move(piece)), pose_(pose) {}

  [[nodiscard]] NetRange& piece() const { return *piece_; }
  [[nodiscard]] std::size_t corner_count() const { return piece_->corner_count(); }
  /// Has it three or four border curves of its own?
  [[nodiscard]] bool is_simple() const;
  /// Points whose hull contains it.
  [[nodiscard]] const std::vector<Point3>& hull();
  /// The same of each border curve.
  [[nodiscard]] const std::vector<std::vector<Point3>>& borders();
  /// Points near the limit corners, after some steps towards them, and the size of what is left around each.
  struct Corners {
    std::size_t steps;
    std::vector<Point3> points;
    double size = 0;
  };
  /// After few steps, and after more; both are kept.
  [[nodiscard]] const Corners& corners(std::size_t more = 0);
  /// So many steps to a corner.
  [[nodiscard]] std::vector<std::size_t> steps_to(std::size_t corner, std::size_t count) const;

  /// Appends the steps that hull() takes, and `border` with those of borders() and a direction.
  static void append_steps_of_hull(std::string& text);
  static void append_border(std::string& text, const std::array<std::int64_t, 3>& direction);
  /// Appends the corners between which a line, up to an end or without one, is seen to cross the piece or not. Returns how
  /// often it crosses, as docs/certificates.md counts that; nothing, and appends nothing, where that is not certain.
  /// `error`: how far the ends may be off.
  [[nodiscard]] std::optional<int> append_corners(std::string& text, const Point3& from, const Vector3& along,
                                                  const Point3* end, double error);

 private:
  [[nodiscard]] std::vector<Point3> border(std::size_t k) const;

  std::unique_ptr<NetRange> piece_;
  Motion pose_;
  std::vector<Point3> hull_;
  std::vector<std::vector<Point3>> borders_;
  std::vector<Corners> corners_;
};

void append_direction(std::string& text, const std::array<std::int64_t, 3>& w);

}  // namespace snug
