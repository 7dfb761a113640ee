#include "surface.h"

#include <algorithm>
#include <numeric>

#include "../rejected.h"

namespace answers {
namespace {

constexpr Index most_elements = 1U << 26;
constexpr Index max_size = 1U << 12;  // of a face, and of a vertex's edges

template <class E, std::size_t N>
E one_of(Words& words, const std::array<const char*, N>& names) {
  const std::string_view word = words.next();
  const auto found = std::find(names.begin(), names.end(), word);
  if (found == names.end()) words.refuse("a word that does not belong here");
  return static_cast<E>(found - names.begin());
}

// Do the faces at a vertex follow each other over edges of two faces?
bool is_one_fan(const Net& net, Index v) {
  const std::span<const Index> corners = net.at_vertex[v];
  std::vector<Index> group(corners.size());
  std::iota(group.begin(), group.end(), 0U);
  const auto edges = [&](Index h) { return std::array{net.edge[h], net.edge[net.prev(h)]}; };
  std::size_t groups = corners.size();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto a = edges(corners[i]), b = edges(corners[j]);
      const bool meet =
          std::ranges::any_of(a, [&](Index e) { return std::ranges::count(b, e) > 0; });
      if (!meet || group[i] == group[j]) continue;
      --groups;
      std::ranges::replace(group, Index(group[j]), Index(group[i]));
    }
  }
  return groups <= 1;
}

// A control mesh, its tags, and what follows from both.
class Reader {
 public:
  Reader(Words& words, std::size_t most_points)
      : words_(words), most_points_(most_points), surface_(std::make_unique<Surface>()) {}

  std::unique_ptr<Surface> read() {
    const std::size_t begin = words_.position() - std::string_view("surface").size();
    constexpr std::array schemes{"loop", "catmark", "doo-sabin", "midedge", "bilinear", "flat"};
    Rules& rules = surface_->rules;
    rules.scheme = one_of<Scheme>(words_, schemes);
    rules.boundary = one_of<Boundary>(words_, std::array{"none", "edge-only", "edge-and-corner"});
    rules.chaikin = one_of<int>(words_, std::array{"uniform", "chaikin"}) == 1;
    rules.smooth_triangles = one_of<int>(words_, std::array{"catmark", "smooth"}) == 1;
    read_points();
    read_faces();
    net_.connect();
    check_edges();
    read_sharpness();
    words_.expect("holes");
    std::vector<bool> hole(net_.faces.size());
    for (Index n = words_.count(net_.faces.size()); n > 0; --n) hole[face()] = true;
    surface_->name = std::string(schemes[static_cast<std::size_t>(rules.scheme)]) + ", " +
                     std::to_string(net_.points.size()) + " points, " +
                     std::to_string(net_.faces.size()) + " faces, sha256 " +
                     sha256(words_.up_to_next(begin));
    read_order(hole);
    return std::move(surface_);
  }

 private:
  Index vertex() { return words_.count(static_cast<Index>(net_.points.size()) - 1); }
  Index face() { return words_.count(net_.faces.size() - 1); }
  double sharpness() {
    const double s = words_.real();
    if (s < 0) words_.refuse("a sharpness below 0");
    return s;
  }

  void read_points() {
    words_.expect("points");
    const Index most = static_cast<Index>(std::min<std::size_t>(most_points_, most_elements));
    for (Index n = words_.count(most); n > 0; --n) {
      Point& p = net_.points.emplace_back();
      for (Real& x : p) x = Real(words_.real());
    }
    if (net_.points.empty()) words_.refuse("no points");
  }

  void read_faces() {
    words_.expect("faces");
    for (Index n = words_.count(most_elements); n > 0; --n) {
      const Index size = words_.count(max_size);
      if (size < 3 || (rules().triangles() && size != 3)) words_.refuse("a face of this size");
      for (Index k = 0; k < size; ++k) net_.faces.items.push_back(vertex());
      if (net_.faces.items.size() > most_elements) words_.refuse("too many corners of faces");
      net_.faces.close_row();
      std::vector<Index> sorted(net_.faces.items.end() - size, net_.faces.items.end());
      std::ranges::sort(sorted);
      const bool allowed = rules().linear() && rules().boundary != Boundary::none;
      if (!allowed && std::ranges::adjacent_find(sorted) != sorted.end()) {
        words_.refuse("a face names a vertex twice");
      }
      if (rules().scheme == Scheme::loop) triples_.push_back(sorted);
    }
    if (net_.faces.size() == 0) words_.refuse("no faces");
    // After a step two of their edges would be one.
    std::ranges::sort(triples_);
    if (std::ranges::adjacent_find(triples_) != triples_.end())
      words_.refuse("two faces of the same vertices");
  }

  [[nodiscard]] bool is_manifold(Index e) const {
    const std::span<const Index> sides = net_.on_edge[e];
    return sides.size() == 1 ||
           (sides.size() == 2 && net_.vertex(sides[0]) != net_.vertex(sides[1]));
  }
  [[nodiscard]] bool on_boundary(Index e) const { return net_.on_edge[e].size() == 1; }

  void check_edges() {
    boundary_.assign(net_.points.size(), false);
    pinched_.assign(net_.points.size(), false);
    for (Index e = 0; e < net_.on_edge.size(); ++e) {
      const auto [a, b] = net_.ends(e);
      for (const Index v : {a, b}) {
        if (on_boundary(e)) boundary_[v] = true;
        if (!is_manifold(e)) pinched_[v] = true;
      }
    }
    for (Index v = 0; v < net_.points.size(); ++v) {
      const auto valence = static_cast<Index>(net_.at_vertex[v].size());
      if (valence > max_size) words_.refuse("too many faces at a vertex");
      if (rules().linear()) continue;
      if (!pinched_[v]) pinched_[v] = !is_one_fan(net_, v);
      if (pinched_[v] && rules().dual()) words_.refuse("not a manifold, as this scheme needs");
      const Index least = rules().scheme == Scheme::loop || rules().dual() ? 3 : 2;
      if (valence > 0 && !boundary_[v] && !pinched_[v] && valence < least) {
        words_.refuse("too few faces at a vertex");
      }
    }
  }

  // docs/derivations/creases.md: "Rules" and "What is not manifold".
  void read_sharpness() {
    std::vector<double> tagged(net_.on_edge.size(), 0.0), own(net_.points.size(), 0.0);
    words_.expect("creases");
    for (Index n = words_.count(most_elements); n > 0; --n) {
      const Index a = vertex(), b = vertex();
      const double s = sharpness();
      for (const Index h : net_.at_vertex[a]) {
        for (const Index corner : {h, net_.prev(h)}) {
          const auto [p, q] = net_.ends(net_.edge[corner]);
          if ((p == a && q == b) || (p == b && q == a)) tagged[net_.edge[corner]] = s;
        }
      }
    }
    words_.expect("corners");
    for (Index n = words_.count(most_elements); n > 0; --n) {
      const Index v = vertex();
      own[v] = sharpness();
    }
    open_.assign(net_.points.size(), false);
    for (Index e = 0; e < net_.on_edge.size(); ++e) {
      const auto [a, b] = net_.ends(e);
      if (on_boundary(e) && tagged[e] < infinite_sharpness) open_[a] = open_[b] = true;
    }
    if (rules().linear() || rules().dual()) return;
    net_.sharpness.resize(net_.faces.items.size());
    for (Index h = 0; h < net_.sharpness.size(); ++h) {
      const Index e = net_.edge[h];
      net_.sharpness[h] = on_boundary(e) || !is_manifold(e) ? infinite_sharpness : tagged[e];
    }
    net_.vertex_sharpness = std::move(own);
    if (rules().chaikin) net_.semi_sharp.resize(net_.points.size());
    for (Index v = 0; v < net_.points.size(); ++v) {
      const std::span<const Index> corners = net_.at_vertex[v];
      const bool lone = rules().boundary == Boundary::edge_and_corner && corners.size() == 1;
      if (corners.empty() || lone || (pinched_[v] && !on_curve(v))) {
        net_.vertex_sharpness[v] = infinite_sharpness;
      }
      if (!rules().chaikin) continue;
      for (const Index e : edges_at(v)) {
        const double s = net_.sharpness[net_.on_edge[e][0]];
        if (is_semi_sharp(s)) net_.semi_sharp[v].push_back(s);
      }
      std::ranges::sort(net_.semi_sharp[v]);
    }
  }

  [[nodiscard]] std::vector<Index> edges_at(Index v) const {
    std::vector<Index> edges;
    for (const Index h : net_.at_vertex[v]) {
      edges.push_back(net_.edge[h]);
      edges.push_back(net_.edge[net_.prev(h)]);
    }
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }

  // Two edges that are not manifold, no boundary, and more faces than edges.
  [[nodiscard]] bool on_curve(Index v) const {
    const std::vector<Index> edges = edges_at(v);
    const auto odd = std::ranges::count_if(edges, [&](Index e) { return !is_manifold(e); });
    return odd == 2 && !boundary_[v] && net_.at_vertex[v].size() > edges.size();
  }

  // Faces at a boundary edge have no surface under the rule `none`, unless it is tagged.
  [[nodiscard]] bool loses_surface(Index f) const {
    return std::ranges::any_of(net_.faces[f], [&](Index v) { return open_[v]; });
  }

  void read_order(const std::vector<bool>& hole) {
    const bool dual = rules().dual();
    std::vector<bool> missing(dual ? net_.points.size() : net_.faces.size());
    for (Index i = 0; i < missing.size(); ++i) {
      if (dual) {
        missing[i] = !net_.at_vertex[i].empty() && !boundary_[i];
      } else {
        missing[i] = !hole[i] && (rules().boundary != Boundary::none || !loses_surface(i));
      }
    }
    words_.expect("order");
    const auto count = static_cast<Index>(std::ranges::count(missing, true));
    if (count == 0) words_.refuse("no face has a surface");
    for (Index n = 0; n < count; ++n) {
      const Index i = words_.count(static_cast<Index>(missing.size()) - 1);
      if (!missing[i]) words_.refuse("this one is there already, or has no surface");
      missing[i] = false;
      net_.owners.push_back(dual ? net_.at_vertex[i][0] : i);
    }
  }

  [[nodiscard]] const Rules& rules() const { return surface_->rules; }

  Words& words_;
  std::size_t most_points_;
  std::unique_ptr<Surface> surface_;
  Net& net_ = surface_->net;
  std::vector<std::vector<Index>> triples_;
  std::vector<bool> boundary_, pinched_,
      open_;  // of vertices; open: at a boundary edge that no tag makes sharp
};

}  // namespace

std::unique_ptr<Surface> read_surface(Words& words, std::size_t most_points) {
  return Reader(words, most_points).read();
}

void PieceSet::take(std::size_t points) {
  if (points > points_left_) throw checker::Rejected("more points than this program makes");
  points_left_ -= points;
  taken_ += points;
}

void PieceSet::forget() {
  halves_[0].reset();
  halves_[1].reset();
  finer_.reset();
  hull_ = {};
  points_left_ += taken_;
  taken_ = 0;
}

std::unique_ptr<PieceSet> PieceSet::part(std::shared_ptr<const Net> net, Index begin,
                                         Index end) const {
  constexpr unsigned max_depth = 2000;
  if (depth_ >= max_depth)
    throw checker::Rejected("pieces are divided more often than this program does");
  return std::make_unique<PieceSet>(surface_, std::move(net), begin, end, points_left_, depth_ + 1);
}

PieceSet& PieceSet::half(std::size_t which) {
  std::unique_ptr<PieceSet>& half = halves_[which];
  if (!half) {
    const Index middle = begin_ + size() / 2;
    half = part(net_, which == 0 ? begin_ : middle, which == 0 ? middle : end_);
  }
  return *half;
}

std::unique_ptr<PieceSet> PieceSet::only(Index owner) const {
  return std::make_unique<PieceSet>(surface_, net_, begin_ + owner, begin_ + owner + 1,
                                    points_left_);
}

PieceSet& PieceSet::finer() {
  if (finer_) return *finer_;
  // About what a step makes, known before it is made.
  std::size_t corners = 0;
  for (const Index v : hull_of(*net_, owners(), surface_.rules))
    corners += net_->at_vertex[v].size();
  if (corners > points_left_) throw checker::Rejected("more points than this program makes");
  auto net = std::make_shared<const Net>(refined(*net_, owners(), surface_.rules));
  take(net->points.size());
  const auto count = static_cast<Index>(net->owners.size());
  finer_ = part(std::move(net), 0, count);
  return *finer_;
}

std::span<const Point* const> PieceSet::hull() {
  if (hull_.empty()) {
    const std::vector<Index> vertices = hull_of(*net_, owners(), surface_.rules);
    take(1 + vertices.size() / 64);
    hull_.reserve(vertices.size());
    for (const Index v : vertices) hull_.push_back(&net_->points[v]);
  }
  return hull_;
}

}  // namespace answers
