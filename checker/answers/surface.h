#pragma once

#include <memory>
#include <string>

#include "net.h"
#include "words.h"

namespace answers {

/// A surface as a file names it.
struct Surface {
  Rules rules;
  Net net;           ///< the control mesh; its owners are in the order of the file
  std::string name;  ///< the scheme, the numbers of points and faces, and a digest of its lines
};

/// Reads a surface, of so many points at most: rules, points, faces, tags, and an order of its
/// owners that names each once.
[[nodiscard]] std::unique_ptr<Surface> read_surface(Words& words, std::size_t most_points);

/// A set of pieces of a surface: owners of a net that follow each other. Halves and finer sets are
/// made when they are first asked for. `points_left` is what all sets may still make, in points of
/// half a kilobyte; what needs more is thrown as checker::Rejected, and so are sets that are
/// divided too often.
class PieceSet {
 public:
  PieceSet(const Surface& surface, std::shared_ptr<const Net> net, Index begin, Index end,
           std::size_t& points_left, unsigned depth = 0)
      : surface_(surface),
        net_(std::move(net)),
        begin_(begin),
        end_(end),
        points_left_(points_left),
        depth_(depth) {}
  ~PieceSet() { forget(); }
  PieceSet(const PieceSet&) = delete;
  PieceSet& operator=(const PieceSet&) = delete;

  [[nodiscard]] Index size() const { return end_ - begin_; }
  /// The first half of the owners, one less than the second of an odd number, or the second.
  /// Requires:  size() >= 2.
  PieceSet& half(std::size_t which);
  /// The same pieces of the surface, each as those that a step makes of it.
  PieceSet& finer();
  /// One owner alone, counted in the set.
  /// Requires:  owner < size().
  [[nodiscard]] std::unique_ptr<PieceSet> only(Index owner) const;
  /// Points whose convex hull contains the pieces.
  std::span<const Point* const> hull();
  /// Drops all that was made of this set.
  void forget();
  [[nodiscard]] std::span<const Index> owners() const {
    return std::span<const Index>(net_->owners).subspan(begin_, size());
  }
  [[nodiscard]] const Net& net() const { return *net_; }
  [[nodiscard]] const Rules& rules() const { return surface_.rules; }

 private:
  void take(std::size_t points);
  std::unique_ptr<PieceSet> part(std::shared_ptr<const Net> net, Index begin, Index end) const;

  const Surface& surface_;
  std::shared_ptr<const Net> net_;
  Index begin_, end_;
  std::size_t& points_left_;
  std::size_t taken_ = 0;
  unsigned depth_;  // sets that this one is a part of
  std::vector<const Point*> hull_;
  std::unique_ptr<PieceSet> halves_[2], finer_;
};

}  // namespace answers
