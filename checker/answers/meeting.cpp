#include "disc.h"
#include "question.h"

// Two surfaces cross: docs/derivations/contact.md, "A piece that is crossed", by hulls and
// directions.
namespace answers {
namespace {

// A disc, a piece of one side, and a connected set of the other one, a piece or a segment, that is
// said to cross it.
class Meeting {
 public:
  Meeting(Words& words, const std::array<Side, 2>& sides) : words_(words) {
    const std::size_t crossed = words.count(1);
    const Side &disc = sides[crossed], &crossing = sides[1 - crossed];
    of_crossing_ = &crossing.pose;
    if (!disc.pieces) words.refuse("no surface");
    words.expect("piece");
    disc_.emplace(words, read_piece(words, *disc.pieces), disc.pose);
    disc_hull_ = read_finer(words, disc_->piece());
    if (!crossing.pieces) {
      if (crossing.points.size() != 2) words.refuse("neither a surface nor a segment");
      for (const Point& p : crossing.points) crossing_hull_.push_back(&p);
      return;
    }
    words.expect("piece");
    crossing_ = read_piece(words, *crossing.pieces);
    crossing_hull_ = read_finer(words, *crossing_);
  }

  // Refuses unless the disc and the crossing piece, a connected set, have a point in common. If
  // not, the map (u, t) -> disc(u) - path(t), for a path between two points of the crossing piece,
  // has no zero. On the border of disc x [0, 1] it is deformed without a zero: the path to the
  // segment between its ends, since no border curve meets the hull of the crossing piece; the disc
  // to the triangles between its corners, since the ends are outside of its hull. The degree of the
  // result is the number of crossings of the segment with the triangles, counted by sign; that of
  // a map without zeros is 0.
  void prove() {
    std::array<Point, 2> ends;
    for (std::size_t i = 0; i < 2; ++i) {
      words_.expect("end");
      std::unique_ptr<PieceSet> at;
      Hull hull;
      if (crossing_) {
        at = crossing_->only(0);
        read_steps(words_, at);
        hull = copy_of(at->hull());
        ends[i] = enclosing_box(*at, *of_crossing_);
      } else {
        hull.push_back(crossing_hull_[i]);
        ends[i] = *crossing_hull_[i];
      }
      require_apart(hull, disc_hull_);
    }
    for (std::size_t k = 0; k < disc_->corner_count(); ++k) {
      require_apart(crossing_hull_, disc_->read_border(words_, k));
    }
    const std::vector<Point> corners = disc_->read_corners(words_);
    const auto crossed = crossings(ends[0], between(ends[0], ends[1]), &ends[1], corners);
    if (!crossed || *crossed == 0)
      words_.refuse("the segment is not seen to cross these triangles");
  }

 private:
  // A direction of the file holds hulls of the crossing set and of the disc apart, either way
  // round.
  void require_apart(const Hull& crossing, const Hull& disc) {
    const Point w = read_direction(words_);
    const auto behind = [&](const Hull& a, const Pose& of_a, const Hull& b, const Pose& of_b) {
      return (extreme(b, of_b, w, false) - extreme(a, of_a, w, true)).certainly_positive();
    };
    if (!behind(crossing, *of_crossing_, disc, disc_->pose()) &&
        !behind(disc, disc_->pose(), crossing, *of_crossing_)) {
      words_.refuse("these sets are not held apart by this direction");
    }
  }

  Words& words_;
  const Pose* of_crossing_;
  std::optional<Disc> disc_;
  std::unique_ptr<PieceSet> crossing_;
  Hull disc_hull_, crossing_hull_;
};

}  // namespace

void prove_meeting(Words& words, const std::array<Side, 2>& sides) {
  Meeting(words, sides).prove();
}

}  // namespace answers
