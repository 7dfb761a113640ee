#include <snug/certificate/meeting.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <random>
#include <tuple>

#include <snug/certificate/text.h>
#include <support/point.h>

namespace snug {
namespace {

using Points = std::vector<Point3>;
using Piece = std::unique_ptr<NetRange>;

constexpr std::size_t max_piece_level = 20;
constexpr std::size_t finer_steps = 2;   // of a hull
constexpr std::size_t border_steps = 3;  // of the hull of a border curve
constexpr std::size_t end_steps = 24;    // to limit points, from a piece
constexpr std::array<std::size_t, 3> corner_steps{16, 40, 100};
constexpr std::size_t max_places = 40;  // where contact is looked for
constexpr std::size_t max_attempts = 10'000;
constexpr std::size_t max_visits = 500;  // of pairs on the way to one of them
constexpr std::size_t place_level = 12;  // of the pieces there

void append_steps(std::string& text, std::span<const std::size_t> steps) {
  append_words(text, steps.size());
  for (const std::size_t k : steps) append_words(text, k);
}

void append_direction(std::string& text, const std::array<std::int64_t, 3>& w) {
  for (const std::int64_t x : w) text += ' ' + std::to_string(x);
  text += '\n';
}

// Does a segment cross the triangles from the first corner once, whatever points within `error` are meant? Nothing if that
// depends on them.
std::optional<bool> crosses_once(const std::array<Point3, 2>& ends, std::span<const Point3> corners,
                                 double error) {
  const auto& [a, b] = ends;
  int crossed = 0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const std::array<Vector3, 3> c{corners[0] - a, corners[k] - a, corners[k + 1] - a};
    int turns = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 &p = c[i], &q = c[(i + 1) % 3];
      const double turn = dot(b - a, cross(p, q));
      if (std::fabs(turn) < 8 * error * (length(p) * length(q) + length(b - a) * (length(p) + length(q))))
        return std::nullopt;
      turns += turn > 0 ? 1 : -1;
    }
    if (std::abs(turns) != 3) continue;
    const Vector3 normal = cross(c[1] - c[0], c[2] - c[0]);
    const double at_a = dot(normal, -c[0]), at_b = dot(normal, b - corners[0]);
    const double size = std::max(length(c[1] - c[0]), length(c[2] - c[0]));
    if (std::min(std::fabs(at_a), std::fabs(at_b)) <
        8 * error * (length(normal) + size * (length(c[0]) + size)))
      return std::nullopt;
    if (at_a * at_b < 0) ++crossed;
  }
  return crossed == 1;
}

// The pieces of one surface around a place, from its owner down, and what a proof needs of them.
class Ladder {
 public:
  Ladder(const CertifiedSide& side, PieceName name) : pose_(side.pose), name_(std::move(name)) {
    name_.steps.resize(std::min(name_.steps.size(), max_piece_level));
    pieces_.push_back(side.pieces->only(name_.position));
    for (const std::size_t k : name_.steps) pieces_.push_back(pieces_.back()->finer().only(k));
    hulls_.resize(pieces_.size());
    borders_.resize(pieces_.size());
  }

  [[nodiscard]] std::size_t levels() const { return pieces_.size(); }
  [[nodiscard]] std::size_t corner_count(std::size_t level) const { return pieces_[level]->corner_count(); }

  const Points& hull(std::size_t level) {
    if (hulls_[level].empty()) {
      NetRange* range = pieces_[level].get();
      for (std::size_t i = 0; i < finer_steps; ++i) range = &range->finer();
      hulls_[level] = range->hull(pose_);
    }
    return hulls_[level];
  }

  // Of each border curve.
  const std::vector<Points>& borders(std::size_t level) {
    std::vector<Points>& borders = borders_[level];
    for (std::size_t k = borders.size(); k < corner_count(level); ++k) borders.push_back(border(level, k));
    return borders;
  }

  // Near the limit corners, after some steps towards them; `size` is how near.
  [[nodiscard]] Points corners(std::size_t level, std::size_t steps, double& size) const {
    Points corners;
    for (std::size_t k = 0; k < corner_count(level); ++k) {
      Piece piece = pieces_[level]->only(0);
      for (std::size_t i = 0; i < steps; ++i) piece = piece->finer().only(piece->dual() && i > 0 ? 0 : k);
      corners.push_back(middle(*piece, size));
    }
    return corners;
  }

  // Towards a limit point that lies far along a direction.
  std::vector<std::size_t> farthest(std::size_t level, const Vector3& along, Point3& point,
                                    double& size) const {
    std::vector<std::size_t> steps;
    Piece piece = pieces_[level]->only(0);
    for (std::size_t i = 0; i < end_steps; ++i) {
      NetRange& children = piece->finer();
      double best = -INFINITY;
      std::size_t step = 0;
      for (std::size_t k = 0; k < children.size(); ++k) {
        double unused = 0;
        const double x = dot(along, middle(*children.only(k), unused) - Point3{});
        if (x > best) best = x, step = k;
      }
      steps.push_back(step);
      piece = children.only(step);
    }
    point = middle(*piece, size);
    return steps;
  }

  void append(std::string& text, std::size_t level) const {
    text += "piece";
    append_words(text, name_.position);
    append_steps(text, std::span(name_.steps).first(level));
    append_words(text, finer_steps);
    text += '\n';
  }

 private:
  // Of the box around a piece; `size` becomes at least that of the box.
  [[nodiscard]] Point3 middle(const NetRange& range, double& size) const {
    const Box3 box = box_of(range.hull(pose_));
    size = std::max(size, longest_side(box));
    return box.lower + 0.5 * (box.upper - box.lower);
  }
  [[nodiscard]] Points border(std::size_t level, std::size_t k) const {
    std::vector<std::pair<Piece, std::size_t>> along;
    along.emplace_back(pieces_[level]->only(0), k);
    const std::size_t corners = corner_count(level);
    for (std::size_t i = 0; i < border_steps; ++i) {
      std::vector<std::pair<Piece, std::size_t>> halves;
      for (const auto& [piece, side] : along) {
        NetRange& children = piece->finer();
        halves.emplace_back(children.only(side), children.dual() ? 0 : side);
        halves.emplace_back(children.only((side + 1) % corners), children.dual() ? 3 : side);
      }
      along = std::move(halves);
    }
    Points points;
    for (const auto& [piece, side] : along) {
      const Points own = piece->hull(pose_);
      points.insert(points.end(), own.begin(), own.end());
    }
    return points;
  }

  Motion pose_;
  PieceName name_;
  std::vector<Piece> pieces_;
  std::vector<Points> hulls_;
  std::vector<std::vector<Points>> borders_;
};

// What crosses a disc: a piece of a surface, or a segment.
struct Crossing {
  Ladder* ladder;
  std::size_t level;
  const Points& hull;
};

std::optional<std::string> proof_of(Ladder& disc, std::size_t level, const Crossing& crossing) {
  if (disc.corner_count(level) > 4) return std::nullopt;
  std::string borders;
  for (const Points& border : disc.borders(level)) {
    Vector3 hint;
    const auto w = separating_direction(border, crossing.hull, 0, hint);
    if (!w) return std::nullopt;
    borders += "border";
    append_words(borders, border_steps);
    append_direction(borders, *w);
  }
  double error = 0x1p-48 * largest_coordinate(crossing.hull);
  Points corners = disc.corners(level, corner_steps[0], error);
  const Vector3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  std::string text;
  disc.append(text, level);
  if (crossing.ladder != nullptr) crossing.ladder->append(text, crossing.level);
  std::array<Point3, 2> ends;
  double end_error = 0x1p-48 * largest_coordinate(crossing.hull);
  for (std::size_t side = 0; side < 2; ++side) {
    text += "end";
    if (crossing.ladder != nullptr) {
      append_steps(text, crossing.ladder->farthest(crossing.level, side == 0 ? -normal : normal, ends[side],
                                                   end_error));
    } else {
      ends[side] = crossing.hull[side];
    }
    Vector3 hint = dot(normal, ends[side] - corners[0]) < 0 ? -normal : normal;
    const auto w = separating_direction(disc.hull(level), Points{ends[side]}, 0, hint);
    if (!w) return std::nullopt;
    append_direction(text, *w);
  }
  text += borders + "corners";
  for (const std::size_t steps : corner_steps) {
    error = end_error;
    corners = disc.corners(level, steps, error);
    bool certain = true;
    // The triangles of a quad begin at either diagonal.
    for (std::size_t first = 0; first < corners.size() - 2; ++first) {
      const std::optional<bool> crosses = crosses_once(ends, corners, error);
      if (crosses == true) {
        append_words(text, steps, first);
        return text + '\n';
      }
      certain = certain && crosses.has_value();
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    }
    if (certain) break;
  }
  return std::nullopt;
}

// Looks for pieces that meet, up to their hulls, in a random order.
class Places {
 public:
  explicit Places(const std::array<CertifiedSide, 2>& sides) : sides_(sides) {}

  using Names = std::array<std::optional<PieceName>, 2>;

  // Below the pieces of these names that are so many levels down.
  std::optional<Names> below(const Names& from, std::size_t level) {
    std::array<Node, 2> nodes;
    for (std::size_t s = 0; s < 2; ++s) {
      if (!from[s]) continue;
      nodes[s] = {sides_[s].pieces->only(from[s]->position), from[s]->position, {}};
      for (std::size_t i = 0; i < std::min(level, from[s]->steps.size()); ++i) {
        nodes[s] = nodes[s].children()[from[s]->steps[i]];
      }
    }
    return names_below(nodes);
  }

  // Anywhere on the surfaces.
  std::optional<Names> anywhere() {
    std::array<Node, 2> nodes;
    for (std::size_t s = 0; s < 2; ++s) {
      nodes[s].range = std::shared_ptr<NetRange>(std::shared_ptr<NetRange>(), sides_[s].pieces);
    }
    return names_below(nodes);
  }

 private:
  // Owners that follow each other, or a piece of one; of a segment nothing.
  struct Node {
    std::shared_ptr<NetRange> range;
    std::size_t position = 0;
    std::vector<std::size_t> steps;

    [[nodiscard]] std::vector<Node> children() const {
      std::vector<Node> children;
      if (range->size() > 1) {  // which keep the whole range alive
        for (std::size_t k = 0; k < 2; ++k) {
          NetRange* const half = &range->half(k);
          const std::size_t begin = position + (k == 0 ? 0 : range->half(0).size());
          children.push_back({std::shared_ptr<NetRange>(range, half), begin, {}});
        }
        return children;
      }
      NetRange& finer = range->finer();
      for (std::size_t k = 0; k < finer.size(); ++k) {
        children.push_back({finer.only(k), position, steps});
        children.back().steps.push_back(k);
      }
      return children;
    }
  };

  // Two ranges whose hulls meet, shrunk to this share.
  struct Meeting {
    std::array<Node, 2> nodes;
    double share;
    std::size_t depth;
    std::uint32_t chance;
    // What meets in its middle comes first: there is a disc around it, and it is not by chance of the hulls.
    friend bool operator<(const Meeting& a, const Meeting& b) {
      return std::tuple(-a.share, a.depth, a.chance) < std::tuple(-b.share, b.depth, b.chance);
    }
  };

  std::optional<Names> names_below(const std::array<Node, 2>& nodes) {
    std::priority_queue<Meeting> open;
    add(open, nodes, 0);
    for (std::size_t visit = 0; visit < max_visits && !open.empty(); ++visit) {
      const Meeting meeting = open.top();
      open.pop();
      std::array<double, 2> sizes{};
      for (std::size_t s = 0; s < 2; ++s) {
        const Node& node = meeting.nodes[s];
        if (node.range && node.steps.size() < place_level)
          sizes[s] = longest_side(box_of(points_of(s, node)));
      }
      const std::size_t s = sizes[0] >= sizes[1] ? 0 : 1;
      if (sizes[s] == 0) {
        Names names;
        for (std::size_t k = 0; k < 2; ++k) {
          const Node& node = meeting.nodes[k];
          if (node.range) names[k] = PieceName{node.position, node.steps};
        }
        return names;
      }
      for (const Node& child : meeting.nodes[s].children()) {
        std::array<Node, 2> pair = meeting.nodes;
        pair[s] = child;
        add(open, pair, meeting.depth + 1);
      }
    }
    return std::nullopt;
  }

  void add(std::priority_queue<Meeting>& open, const std::array<Node, 2>& nodes, std::size_t depth) {
    const Points a = points_of(0, nodes[0]), b = points_of(1, nodes[1]);
    for (const double share : {0.3, 0.6, 1.0}) {
      Vector3 hint;
      if (separating_direction(shrunk(a, share), shrunk(b, share), 0, hint)) continue;
      open.push({nodes, share, depth, static_cast<std::uint32_t>(random_())});
      return;
    }
  }

  [[nodiscard]] Points points_of(std::size_t side, const Node& node) const {
    if (!node.range) return sides_[side].points;
    return node.range->hull(sides_[side].pose);
  }

  // Towards the middle.
  static Points shrunk(Points points, double share) {
    Vector3 sum;
    for (const Point3& p : points) sum = sum + (p - Point3{});
    const Point3 middle = Point3{} + (1.0 / static_cast<double>(points.size())) * sum;
    for (Point3& p : points) p = middle + share * (p - middle);
    return points;
  }

  const std::array<CertifiedSide, 2>& sides_;
  std::minstd_rand random_;
};

// At one place: each piece around it on either side against each on the other.
bool append_at(std::string& text, const std::array<CertifiedSide, 2>& sides,
               const std::array<std::optional<PieceName>, 2>& names, std::size_t& attempts,
               const WorkMonitor& monitor) {
  std::array<std::optional<Ladder>, 2> ladders;
  for (std::size_t s = 0; s < 2; ++s) {
    if (names[s]) ladders[s].emplace(sides[s], *names[s]);
  }
  for (std::size_t s = 0; s < 2; ++s) {
    if (!ladders[s]) continue;
    auto& other = ladders[1 - s];
    for (std::size_t level = 0; level < ladders[s]->levels(); ++level) {
      for (std::size_t crossing = 0; crossing < (other ? other->levels() : 1); ++crossing) {
        monitor.checkpoint();
        if (attempts-- == 0) return attempts = 0, false;
        const Points& hull = other ? other->hull(crossing) : sides[1 - s].points;
        if (other) {  // what crosses a disc is smaller, and longer than the disc is thick
          const double ratio = longest_side(box_of(hull)) / longest_side(box_of(ladders[s]->hull(level)));
          if (ratio > 0.9 || ratio < 0x1p-5) continue;
        }
        const auto proof = proof_of(*ladders[s], level, {other ? &*other : nullptr, crossing, hull});
        if (!proof) continue;
        text += "meet " + std::to_string(s) + '\n' + *proof;
        return true;
      }
    }
  }
  return false;
}

}  // namespace

bool append_meeting(std::string& text, const std::array<CertifiedSide, 2>& sides,
                    const std::array<std::optional<PieceName>, 2>& hint, const WorkMonitor& monitor) {
  std::size_t attempts = max_attempts;
  if (append_at(text, sides, hint, attempts, monitor)) return true;
  Places places(sides);
  for (std::size_t i = 0; i < max_places && attempts > 0; ++i) {
    // In turn all over, and from small pieces around the hint to large ones.
    const std::size_t level = place_level * (max_places - 1 - i) / max_places;
    const auto names = i % 2 == 0 ? places.anywhere() : places.below(hint, level);
    if (names && append_at(text, sides, *names, attempts, monitor)) return true;
  }
  return false;
}

}  // namespace snug
