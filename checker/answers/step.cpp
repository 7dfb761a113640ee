#include <algorithm>
#include <optional>
#include <unordered_map>

#include "../rejected.h"
#include "masks.h"
#include "net.h"

// A step of subdivision. Rules of sharp edges and vertices: docs/derivations/creases.md.
namespace answers {
namespace {

double less_by_one(double s) { return s >= infinite_sharpness ? s : std::max(0.0, s - 1); }

class Step {
 public:
  Step(const Net& net, const Rules& rules) : net_(net), rules_(rules) {}

  // Every new point, and all sharpness, that decides about the pieces of these faces: what is new
  // at their vertices, on edges at these and in faces at these. So it is of the pieces in turn.
  Net around_faces(std::span<const Index> owners) {
    for (const Index f : owners) {
      for (const Index v : net_.faces[f]) core_[v] = true;
    }
    std::vector<Index> all;
    for (const auto& [v, unused] : core_) {
      for (const Index corner : net_.at_vertex[v]) all.push_back(net_.face[corner]);
    }
    if (rules_.linear()) all.assign(owners.begin(), owners.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::unordered_map<Index, Index>
        piece;  // by the corner that it keeps; of a triangle's middle, after
    for (const Index f : all) {
      const std::span<const Index> corners = net_.faces[f];
      const auto size = static_cast<Index>(corners.size());
      const Index first = net_.faces.begin[f];
      Index inside = 0;
      for (Index k = 0; k < size; ++k) {
        if (!core_.contains(corners[k])) continue;
        ++inside;
        piece[first + k] = out_.faces.size();
        add_corner_piece(first + k, rules_.triangles() || size == 4 ? k : 0);
      }
      if (rules_.triangles() && inside >= 2) {
        if (inside == 3) middles_[f] = out_.faces.size();
        for (Index k = 0; k < 3; ++k) add_corner(edge_point(net_.edge[first + (k + 1) % 3]), 0);
        out_.faces.close_row();
      }
    }
    for (const Index f : owners) {
      for (Index h = net_.faces.begin[f]; h < net_.faces.begin[f + 1]; ++h) {
        out_.owners.push_back(piece.at(h));
      }
      if (rules_.triangles()) out_.owners.push_back(middles_.at(f));
    }
    return finished();
  }

  // The same for vertices of a dual scheme: all new faces in the faces around them, across edges at
  // them and at them.
  Net around_vertices(std::span<const Index> owners) {
    std::vector<Index> edges, faces;
    for (const Index owner : owners) {
      for (const Index h : net_.at_vertex[net_.vertex(owner)]) {
        faces.push_back(net_.face[h]);
        edges.push_back(net_.edge[h]);
        edges.push_back(net_.edge[net_.prev(h)]);
      }
    }
    for (std::vector<Index>* const all : {&faces, &edges}) {
      std::sort(all->begin(), all->end());
      all->erase(std::unique(all->begin(), all->end()), all->end());
    }
    std::unordered_map<Index, Index>
        made;  // the new vertex of a corner; also its corner in its own face
    const auto add = [&](Index corner) { add_corner(made.at(corner), 0); };
    for (const Index f : faces) {
      for (Index h = net_.faces.begin[f]; h < net_.faces.begin[f + 1]; ++h) {
        made[h] = static_cast<Index>(out_.points.size());
        out_.points.push_back(dual_vertex(net_, h, rules_.scheme));
        add(h);
      }
      out_.faces.close_row();
    }
    for (const Index e : edges) {
      const Index h = net_.on_edge[e][0], g = net_.twin(h);
      for (const Index corner : {net_.next(h), h, net_.next(g), g}) add(corner);
      out_.faces.close_row();
    }
    for (const Index owner : owners) {
      Index h = owner;
      do {
        add(h);
        out_.owners.push_back(made.at(h));
        h = net_.twin(net_.prev(h));  // counter-clockwise
      } while (h != owner);
      out_.faces.close_row();
    }
    return finished();
  }

 private:
  Net finished() {
    if (rules_.dual()) out_.sharpness.clear();
    out_.connect();
    return std::move(out_);
  }

  void add_corner(Index point, double sharpness) {
    out_.faces.items.push_back(point);
    out_.sharpness.push_back(sharpness);
  }

  // From the corner along its edge, over the middle of the face, and back; it is counted as number
  // `at`.
  void add_corner_piece(Index corner, Index at) {
    const Index v = net_.vertex(corner), before = net_.prev(corner);
    const Index ahead = net_.edge[corner], behind = net_.edge[before];
    std::vector<std::pair<Index, double>> around{{vertex_point(v), half(corner, v)},
                                                 {edge_point(ahead), 0}};
    if (!rules_.triangles()) around.emplace_back(face_point(net_.face[corner]), 0);
    around.emplace_back(edge_point(behind), half(before, v));
    const std::size_t n = around.size();
    for (std::size_t k = 0; k < n; ++k) {
      const auto& [point, sharpness] = around[(k + n - at) % n];
      add_corner(point, sharpness);
    }
    out_.faces.close_row();
  }

  // Sharpness of the half of a corner's edge at its end v, after the step.
  [[nodiscard]] double half(Index corner, Index v) const {
    return rules_.linear() ? 0 : decayed(net_.sharpness[corner], v);
  }
  [[nodiscard]] double decayed(double s, Index v) const {
    if (!rules_.chaikin || !is_semi_sharp(s)) return less_by_one(s);
    const std::vector<double>& all = net_.semi_sharp[v];
    if (all.size() < 2) return less_by_one(s);
    double sum = 0;
    for (const double one : all) sum += one;
    const double others = (sum - s) / static_cast<double>(all.size() - 1);
    return std::max(0.0, 0.75 * s + 0.25 * others - 1);
  }

  Index add_point(Point p, double sharpness, std::vector<double> semi_sharp) {
    out_.points.push_back(std::move(p));
    if (!rules_.linear()) out_.vertex_sharpness.push_back(sharpness);
    if (rules_.chaikin) {
      std::erase_if(semi_sharp, [](double s) { return !is_semi_sharp(s); });
      std::sort(semi_sharp.begin(), semi_sharp.end());
      out_.semi_sharp.push_back(std::move(semi_sharp));
    }
    return static_cast<Index>(out_.points.size() - 1);
  }

  Index vertex_point(Index v) {
    const auto [known, is_new] = vertices_.try_emplace(v);
    if (is_new && rules_.linear()) {
      known->second = add_point(net_.points[v], 0, {});
    } else if (is_new) {
      std::vector<double> left;
      if (rules_.chaikin) {
        for (const double s : net_.semi_sharp[v]) left.push_back(decayed(s, v));
      }
      known->second = add_point(moved(v), less_by_one(net_.vertex_sharpness[v]), left);
    }
    return known->second;
  }

  Index edge_point(Index e) {
    const auto [known, is_new] = edges_.try_emplace(e);
    if (!is_new) return known->second;
    const auto [a, b] = net_.ends(e);
    if (rules_.linear()) return known->second = add_point(middle(a, b), 0, {});
    const double s = net_.sharpness[net_.on_edge[e][0]], at_a = decayed(s, a), at_b = decayed(s, b);
    // Chaikin's rule may keep both halves sharp of an edge below 1.
    const bool crease = s >= 1 || (s > 0 && at_a > 0 && at_b > 0);
    Sum sum;
    if (s > 0) sum.add(crease ? Real(1.0) : Real(s), middle(a, b));
    if (!crease) sum.add(Real(1.0) - Real(s), smooth_edge(e));
    return known->second = add_point(sum.value, 0, {at_a, at_b});
  }

  Index face_point(Index f) {
    const auto [known, is_new] = faces_.try_emplace(f);
    if (is_new) known->second = add_point(mean(f), 0, {});
    return known->second;
  }

  [[nodiscard]] Point middle(Index a, Index b) const {
    Sum sum;
    for (const Index end : {a, b}) sum.add(net_.points[end]);
    sum.scale(Real(0.5));
    return sum.value;
  }
  const Point& mean(Index f) {
    const auto [known, is_new] = means_.try_emplace(f);
    if (is_new) known->second = mean_of_face(net_, f);
    return known->second;
  }
  Point smooth_edge(Index e) {
    const std::span<const Index> sides = net_.on_edge[e];
    if (sides.size() != 2) throw checker::Rejected("an edge of one face is to be smooth");
    if (rules_.scheme == Scheme::loop) return loop_edge(net_, e);
    return catmark_edge(net_, e, {&mean(net_.face[sides[0]]), &mean(net_.face[sides[1]])},
                        rules_.smooth_triangles);
  }

  enum class Rule : std::uint8_t { smooth, crease, corner };
  [[nodiscard]] static Rule rule_of(double own, std::span<const Spoke> spokes) {
    const auto sharp =
        std::ranges::count_if(spokes, [](const Spoke& s) { return s.sharpness > 0; });
    return own > 0 || sharp > 2 ? Rule::corner : sharp == 2 ? Rule::crease : Rule::smooth;
  }

  // Where a vertex goes. If its rule changes, the share of the old one is the mean of what ends.
  Point moved(Index v) {
    std::vector<Spoke> spokes;
    for (const Index corner : net_.at_vertex[v]) {
      const Index before = net_.prev(corner);
      for (const auto& [h, end] : {std::pair{corner, net_.next(corner)}, {before, before}}) {
        const Index e = net_.edge[h];
        if (std::ranges::any_of(spokes, [e](const Spoke& s) { return s.edge == e; })) continue;
        spokes.push_back({e, net_.vertex(end), net_.sharpness[h]});
      }
    }
    const double own = net_.vertex_sharpness[v];
    Real sum = 0.0;
    int ending = 0;
    const auto left = [&](double now, double then) {
      if (now > 0 && then == 0) sum += Real(now), ++ending;
      return then;
    };
    std::vector<Spoke> later = spokes;
    for (Spoke& spoke : later) spoke.sharpness = left(spoke.sharpness, decayed(spoke.sharpness, v));
    const Rule now = rule_of(own, spokes), then = rule_of(left(own, less_by_one(own)), later);
    if (now == then || ending == 0 || sum.certainly_at_least(Real(ending)))
      return by_rule(v, now, spokes);
    const Real share = sum / Real(ending);
    Sum mixed;
    mixed.add(share, by_rule(v, now, spokes));
    mixed.add(Real(1.0) - share, by_rule(v, then, later));
    return mixed.value;
  }

  Point by_rule(Index v, Rule rule, std::span<const Spoke> spokes) {
    if (rule == Rule::corner) return net_.points[v];
    if (rule == Rule::crease) {
      Sum sum;
      sum.add(Real(0.75), net_.points[v]);
      for (const Spoke& spoke : spokes) {
        if (spoke.sharpness > 0) sum.add(Real(0.125), net_.points[spoke.end]);
      }
      return sum.value;
    }
    if (rules_.scheme == Scheme::loop) return loop_vertex(net_, v, spokes);
    std::vector<const Point*> means;
    for (const Index corner : net_.at_vertex[v]) means.push_back(&mean(net_.face[corner]));
    return catmark_vertex(net_, v, spokes, means);
  }

  const Net& net_;
  const Rules& rules_;
  Net out_;
  std::unordered_map<Index, bool> core_;
  std::unordered_map<Index, Index> vertices_, edges_, faces_, middles_;
  std::unordered_map<Index, Point> means_;
};

}  // namespace

Net refined(const Net& net, std::span<const Index> owners, const Rules& rules) {
  Step step(net, rules);
  return rules.dual() ? step.around_vertices(owners) : step.around_faces(owners);
}

}  // namespace answers
