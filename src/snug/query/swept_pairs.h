#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <snug/query/swept_motion.h>
#include <snug/run.h>
#include <snug/search/pair_walk.h>

namespace snug {

/// One of two surfaces during one piece of its motion.
struct SweptBody {
  const SurfaceBvh& model;
  PieceCache& scratch;
  const PieceMotion& motion;
};

/// Proves that two rigid surfaces stay farther apart than a margin for a while. A pair of nodes is dropped where one direction, which
/// stays or turns with one of the surfaces, keeps them apart over an interval of time: at its ends and in its
/// middle by more than heights along it can bend between. Else a node is opened, if it is large for how far the
/// nodes move meanwhile, or the time is halved; the earlier half comes first.
/// Source:    derivations/time_of_contact.md, "Over an interval of time".
class SweptPairs {
 public:
  /// Requires:  the bodies outlive it; a margin that is finite and >= 0, mesh units.
  SweptPairs(const SweptBody& a, const SweptBody& b, double margin, SearchStats& stats);

  /// The time up to which, itself included, no two points are within the margin: `to`, or `from` where nothing is shown,
  /// or before an interval as short as `least`, or where the budget of splits and of pairs compared ends.
  /// Requires:  0 <= from < to <= 1, times of the piece.
  [[nodiscard]] double clear(double from, double to, double least, std::uint64_t budget,
                             const WorkMonitor& monitor);
  /// Work that clear() has spent.
  [[nodiscard]] std::uint64_t spent() const { return budget_.spent(stats_); }

 private:
  using Nodes = std::array<Node, 2>;
  // Both surfaces at one time.
  struct Sample {
    double time = 0;
    std::array<PlacedFrame, 2> frames;
    // Upper bounds: of what places may lack to those of the exact motions, and of the error of heights along a
    // direction that stays, or turns with a surface.
    double place_doubt = 0;
    std::array<double, 2> turn_doubt{};  // of such directions
    std::array<double, 3> height_doubt{};
  };
  // Of one call of clear(), for pairs compared and splits.
  struct Budget {
    std::uint64_t most = 0, splits_before = 0, steps = 0;
    [[nodiscard]] std::uint64_t spent(const SearchStats& stats) const {
      return steps + (stats.splits - splits_before);
    }
  };
  struct Step;  // from one time to another
  struct Pair;  // what is known of two nodes in a step

  [[nodiscard]] Sample sample(double time) const;
  bool clear(const Sample& first, const Sample& last, std::vector<Nodes> open_pairs);
  [[nodiscard]] Pair pair_of(const Nodes& nodes, const Step& step);
  [[nodiscard]] double height(const Sample& at, const Pair& pair, std::size_t side, const Vector3& w) const;
  [[nodiscard]] double gap(const Sample& at, const Pair& pair, const Vector3& w) const;
  // By a direction that has this value in the middle, and turns with a side or stays.
  [[nodiscard]] bool kept_apart(const Step& step, const Pair& pair, const Vector3& w,
                                std::size_t turns) const;
  // Of the side on which it was found, or of neither: then all are tried.
  [[nodiscard]] bool apart_along(const Step& step, Pair& pair, const Vector3& direction,
                                 std::size_t of) const;
  [[nodiscard]] bool apart(const Step& step, Pair& pair);
  [[nodiscard]] bool apart_by_triangles(const Step& step, Pair& pair);
  [[nodiscard]] bool apart_in_double(const Step& step, Pair& pair);
  [[nodiscard]] std::size_t side_to_open(const Step& step, const Pair& pair) const;
  void open(const Nodes& nodes, std::size_t side, std::vector<Nodes>& out);

  std::array<SweptBody, 2> bodies_;
  double margin_;
  SearchStats& stats_;
  PowerOfTwo world_;
  std::array<double, 2> scales_{};
  std::array<SweptMotion, 2> motions_;
  double closing_ = 0;
  bool possible_ = false;
  double shortest_ = 0, until_ = 0;
  Budget budget_;
  const WorkMonitor* monitor_ = nullptr;
};

}  // namespace snug
