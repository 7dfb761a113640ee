#include <snug/certificate/meeting.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include <snug/certificate/disc.h>
#include <snug/certificate/text.h>
#include <support/point.h>

namespace snug {
namespace {

using Points = std::vector<Point3>;

constexpr std::size_t max_piece_level = 20;
constexpr std::size_t max_places = 120;  // where contact is looked for
constexpr std::size_t max_attempts = 10'000;
constexpr std::size_t max_visits = 300;  // of pairs on the way to one of them
constexpr std::size_t place_level = 12;  // of the pieces there

void append_steps(std::string& text, std::span<const std::size_t> steps) {
  append_words(text, steps.size());
  for (const std::size_t k : steps) append_words(text, k);
}

// The pieces of one surface around a place, from its owner down.
class Ladder {
 public:
  Ladder(const CertifiedSide& side, CertifiedPiece name) : name_(std::move(name)) {
    name_.steps.resize(std::min(name_.steps.size(), max_piece_level));
    discs_.emplace_back(side.pieces->only(name_.position), side.pose);
    for (const std::size_t k : name_.steps)
      discs_.emplace_back(discs_.back().piece().finer().only(k), side.pose);
  }

  [[nodiscard]] std::size_t levels() const { return discs_.size(); }
  Disc& at(std::size_t level) { return discs_[level]; }

  void append(std::string& text, std::size_t level) const {
    text += "piece";
    append_words(text, name_.position);
    append_steps(text, std::span(name_.steps).first(level));
    Disc::append_steps_of_hull(text);
    text += '\n';
  }

 private:
  CertifiedPiece name_;
  std::vector<Disc> discs_;
};

// A piece of a surface or a segment that crosses a disc.
struct Crossing {
  Ladder* ladder;
  std::size_t level;
  const Points& hull;
  double magnitude;  // of both sides
};

std::optional<std::string> proof_of(Ladder& ladder, std::size_t level, const Crossing& crossing) {
  Disc& disc = ladder.at(level);
  if (!disc.is_simple()) return std::nullopt;
  std::string borders;
  for (const Points& border : disc.borders()) {
    Vector3 hint;
    const auto w = separating_direction(border, crossing.hull, 0, crossing.magnitude, hint);
    if (!w) return std::nullopt;
    Disc::append_border(borders, *w);
  }
  double error = 0x1p-46 * crossing.magnitude;
  const Points& corners = disc.corners().points;
  const Vector3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  std::string text;
  ladder.append(text, level);
  if (crossing.ladder != nullptr) crossing.ladder->append(text, crossing.level);
  std::array<Point3, 2> ends;
  for (std::size_t side = 0; side < 2; ++side) {
    text += "end";
    const Vector3 out = side == 0 ? -normal : normal;
    if (crossing.ladder != nullptr) {
      Disc& piece = crossing.ladder->at(crossing.level);
      const Disc::Corners& all = piece.corners();
      const auto along = [&](std::size_t k) { return dot(out, all.points[k] - Point3{}); };
      std::size_t k = 0;
      for (std::size_t i = 1; i < all.points.size(); ++i) k = along(i) > along(k) ? i : k;
      ends[side] = all.points[k];
      error = std::max(error, all.size);
      append_steps(text, piece.steps_to(k, all.steps));
    } else {
      ends[side] = crossing.hull[side];
    }
    Vector3 hint = dot(normal, ends[side] - corners[0]) < 0 ? -normal : normal;
    const auto w = separating_direction(disc.hull(), Points{ends[side]}, 0, crossing.magnitude, hint);
    if (!w) return std::nullopt;
    append_direction(text, *w);
  }
  text += borders;
  const auto crossed = disc.append_corners(text, ends[0], ends[1] - ends[0], &ends[1], error);
  if (!crossed || *crossed == 0) return std::nullopt;
  return text;
}

// Looks for pieces that meet, as it seems from where their vertices lie, in a random order.
class Places {
 public:
  explicit Places(const std::array<CertifiedSide, 2>& sides) : sides_(sides) {}

  using Names = std::array<std::optional<CertifiedPiece>, 2>;

  // Below the pieces of these names that are so many levels down.
  std::optional<Names> below(const Names& from, std::size_t level) {
    std::array<Node, 2> nodes;
    for (std::size_t s = 0; s < 2; ++s) {
      if (!from[s]) continue;
      nodes[s] = {sides_[s].pieces->only(from[s]->position), from[s]->position, {}, {}};
      for (std::size_t i = 0; i < std::min(level, from[s]->steps.size()); ++i) {
        nodes[s] = children_of(nodes[s])[from[s]->steps[i]];
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
    Box3 box;
    [[nodiscard]] bool ends() const { return !range || steps.size() >= place_level; }
  };

  [[nodiscard]] static std::vector<Node> children_of(const Node& node) {
    std::vector<Node> children;
    NetRange& range = *node.range;
    if (range.size() > 1) {  // which keep the whole range alive
      for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t begin = node.position + (k == 0 ? 0 : range.half(0).size());
        children.push_back({std::shared_ptr<NetRange>(node.range, &range.half(k)), begin, {}, {}});
      }
      return children;
    }
    NetRange& finer = range.finer();
    for (std::size_t k = 0; k < finer.size(); ++k) {
      children.push_back({finer.only(k), node.position, node.steps, {}});
      children.back().steps.push_back(k);
    }
    return children;
  }

  void find_box(std::size_t side, Node& node) const {
    node.box = node.range ? node.range->rough_box(sides_[side].pose) : box_of(sides_[side].points);
  }

  std::optional<Names> names_below(std::array<Node, 2> nodes) {
    for (std::size_t s = 0; s < 2; ++s) find_box(s, nodes[s]);
    std::vector<std::array<Node, 2>> open{std::move(nodes)};
    for (std::size_t visit = 0; visit < max_visits && !open.empty(); ++visit) {
      std::array<Node, 2> pair = std::move(open.back());
      open.pop_back();
      if (pair[0].ends() && pair[1].ends()) {
        Names names;
        for (std::size_t k = 0; k < 2; ++k) {
          if (pair[k].range) names[k] = CertifiedPiece{pair[k].position, pair[k].steps};
        }
        return names;
      }
      const bool first_larger = longest_side(pair[0].box) >= longest_side(pair[1].box);
      const std::size_t s = pair[0].ends() ? 1 : pair[1].ends() ? 0 : first_larger ? 0 : 1;
      std::vector<Node> children = children_of(pair[s]);
      for (std::size_t i = children.size(); i > 1; --i) std::swap(children[i - 1], children[random_() % i]);
      for (Node& child : children) {
        find_box(s, child);
        if (!may_meet(child, pair[1 - s])) continue;
        std::array<Node, 2>& next = open.emplace_back(pair);
        next[s] = std::move(child);
      }
    }
    return std::nullopt;
  }

  // The surfaces bulge out of boxes around their vertices, a little.
  static bool may_meet(const Node& a, const Node& b) {
    const auto bulge_of = [](const Node& node) { return node.range ? 0.1 * longest_side(node.box) : 0; };
    const double bulge = std::max(bulge_of(a), bulge_of(b));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (a.box.lower[axis] > b.box.upper[axis] + bulge || b.box.lower[axis] > a.box.upper[axis] + bulge)
        return false;
    }
    return true;
  }

  const std::array<CertifiedSide, 2>& sides_;
  std::minstd_rand random_;
};

// At one place: each piece around it on either side against each on the other.
bool append_at(std::string& text, const std::array<CertifiedSide, 2>& sides,
               const std::array<std::optional<CertifiedPiece>, 2>& names, std::size_t& attempts,
               const WorkMonitor& monitor) {
  const double magnitude = std::max(sides[0].magnitude, sides[1].magnitude);
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
        const Points& hull = other ? other->at(crossing).hull() : sides[1 - s].points;
        if (other) {  // what crosses a disc is smaller, and longer than the disc is thick
          const double ratio =
              longest_side(box_of(hull)) / longest_side(box_of(ladders[s]->at(level).hull()));
          if (ratio > 0.9 || ratio < 0x1p-5) continue;
        }
        if (attempts == 0) return false;
        --attempts;
        const auto proof =
            proof_of(*ladders[s], level, {other ? &*other : nullptr, crossing, hull, magnitude});
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
                    const std::array<std::optional<CertifiedPiece>, 2>& hint, const WorkMonitor& monitor) {
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
