#include "question.h"

// Two surfaces cross: docs/derivations/contact.md, "A piece that is crossed", by hulls and
// directions.
namespace answers {
namespace {

using Piece = std::unique_ptr<PieceSet>;
using Hull = std::vector<const Point*>;

Hull copy_of(std::span<const Point* const> hull) { return {hull.begin(), hull.end()}; }

int sign_of(const Real& x) {
  return x.certainly_positive() ? 1 : (Real(0.0) - x).certainly_positive() ? -1 : 0;
}

Point between(const Point& a, const Point& b) { return {b[0] - a[0], b[1] - a[1], b[2] - a[2]}; }

Real determinant(const Point& a, const Point& b, const Point& c) {
  const Point across{b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2],
                     b[0] * c[1] - b[1] * c[0]};
  return dot(a, across);
}

// On which side of the plane of p, q and r, seen from a.
int side_of(const Point& a, const Point& p, const Point& q, const Point& r) {
  return sign_of(determinant(between(a, p), between(a, q), between(a, r)));
}

// A disc, a piece of one side, and a connected set of the other one, a piece or a segment, that is
// said to cross it.
class Meeting {
 public:
  Meeting(Words& words, const std::array<Side, 2>& sides) : words_(words) {
    const std::size_t crossed = words.count(1);
    const Side &disc = sides[crossed], &crossing = sides[1 - crossed];
    of_disc_ = &disc.pose;
    of_crossing_ = &crossing.pose;
    if (!disc.pieces) words.refuse("no surface");
    words.expect("piece");
    disc_ = read_piece(words, *disc.pieces);
    disc_hull_ = read_finer(*disc_);
    if (!crossing.pieces) {
      if (crossing.points.size() != 2) words.refuse("neither a surface nor a segment");
      for (const Point& p : crossing.points) crossing_hull_.push_back(&p);
      return;
    }
    words.expect("piece");
    crossing_ = read_piece(words, *crossing.pieces);
    crossing_hull_ = read_finer(*crossing_);
  }

  // Refuses unless the disc and the crossing piece, a connected set, have a point in common. If
  // not, the map (u, t) -> disc(u) - path(t), for a path between two points of the crossing piece,
  // has no zero. On the border of disc x [0, 1] it is deformed without a zero: the path to the
  // segment between its ends, since no border curve meets the hull of the crossing piece; the disc
  // to the triangles between its corners, since the ends are outside of its hull. The degree of the
  // result is the number of crossings of the segment with the triangles, which is 1 or -1; that of
  // a map without zeros is 0.
  void prove() {
    std::array<Point, 2> ends;
    for (std::size_t i = 0; i < 2; ++i) {
      words_.expect("end");
      Piece at;
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
      require_apart(hull, *of_crossing_, disc_hull_, *of_disc_);
    }
    const std::size_t corners = corner_count();
    for (std::size_t k = 0; k < corners; ++k) {
      std::vector<BorderPiece> curve;
      curve.push_back({disc_->only(0), k});
      words_.expect("border");
      for (Index left = words_.count(max_finer); left > 0; --left) curve = finer(curve);
      Hull hull;
      for (const BorderPiece& side : curve)
        hull.insert(hull.end(), side.piece->hull().begin(), side.piece->hull().end());
      require_apart(hull, *of_disc_, crossing_hull_, *of_crossing_);
    }
    std::vector<Point> corner;
    words_.expect("corners");
    const Index depth = words_.count(200);
    const Index first = words_.count(1);
    for (std::size_t k = 0; k < corners; ++k)
      corner.push_back(limit_corner((first + k) % corners, depth));
    if (!crosses_once(ends, corner))
      words_.refuse("the segment does not cross these triangles once");
  }

 private:
  static constexpr Index max_finer = 8;

  // A piece along one of its sides.
  struct BorderPiece {
    Piece piece;
    std::size_t number;
  };

  Hull read_finer(PieceSet& piece) {
    PieceSet* set = &piece;
    for (Index left = words_.count(max_finer); left > 0; --left) set = &set->finer();
    return copy_of(set->hull());
  }

  // A direction of the file holds the hulls apart, either way round.
  void require_apart(const Hull& a, const Pose& of_a, const Hull& b, const Pose& of_b) {
    const Point w = read_direction(words_);
    const Real one = extreme(b, of_b, w, false) - extreme(a, of_a, w, true);
    const Real other = extreme(a, of_a, w, false) - extreme(b, of_b, w, true);
    if (!one.certainly_positive() && !other.certainly_positive()) {
      words_.refuse("these sets are not held apart by this direction");
    }
  }

  [[nodiscard]] std::size_t corner_count() const {
    const Net& net = disc_->net();
    const Index owner = disc_->owners()[0];
    const std::size_t count =
        disc_->rules().dual() ? net.at_vertex[net.vertex(owner)].size() : net.faces[owner].size();
    if (count > 4) words_.refuse("a piece with more than four corners");
    if (disc_->rules().dual() && count != 4) words_.refuse("a piece without four corners");
    if (!disc_->rules().dual() && !disc_->rules().triangles() && count != 4) {
      words_.refuse("a piece without four corners");
    }
    return count;
  }

  // Side k of a piece is that of two of its children, at both its ends.
  static std::vector<BorderPiece> finer(std::vector<BorderPiece>& sides) {
    std::vector<BorderPiece> halves;
    for (const BorderPiece& side : sides) {
      PieceSet& children = side.piece->finer();
      const bool dual = children.rules().dual();
      const Index corners = children.rules().triangles() ? 3 : 4;
      const auto k = static_cast<Index>(side.number);
      halves.push_back({children.only(k), dual ? 0 : k});
      halves.push_back({children.only((k + 1) % corners), dual ? 3 : k});
    }
    return halves;
  }

  [[nodiscard]] Point limit_corner(std::size_t k, Index depth) const {
    Piece piece = disc_->only(0);
    for (Index i = 0; i < depth; ++i) {
      const bool first = disc_->rules().dual() && i > 0;
      piece = piece->finer().only(first ? 0 : static_cast<Index>(k));
    }
    return enclosing_box(*piece, *of_disc_);
  }

  static bool crosses_once(const std::array<Point, 2>& ends, std::span<const Point> corner) {
    const auto& [a, b] = ends;
    int crossed = 0;
    for (std::size_t k = 1; k + 1 < corner.size(); ++k) {
      const std::array<const Point*, 3> c{&corner[0], &corner[k], &corner[k + 1]};
      std::array<int, 3> turns{};
      for (std::size_t i = 0; i < 3; ++i) turns[i] = side_of(a, b, *c[i], *c[(i + 1) % 3]);
      if (turns[0] == 0 || turns[1] == 0 || turns[2] == 0) return false;
      if (turns[0] != turns[1] || turns[1] != turns[2]) continue;  // the line misses this triangle
      const int at_a = side_of(a, *c[0], *c[1], *c[2]), at_b = side_of(b, *c[0], *c[1], *c[2]);
      if (at_a == 0 || at_b == 0 || at_a == at_b) return false;
      ++crossed;
    }
    return crossed == 1;
  }

  Words& words_;
  const Pose *of_disc_, *of_crossing_;
  Piece disc_, crossing_;
  Hull disc_hull_, crossing_hull_;
};

}  // namespace

void prove_meeting(Words& words, const std::array<Side, 2>& sides) {
  Meeting(words, sides).prove();
}

}  // namespace answers
