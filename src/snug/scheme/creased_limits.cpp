#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <numeric>
#include <utility>

#include <snug/base/contract.h>
#include <snug/base/recent_values.h>
#include <snug/geometry/rounding.h>
#include <snug/scheme/creased.h>
#include <snug/scheme/loop_masks.h>

// Limits and tangents of schemes with creases.
namespace snug {
namespace {

bool is_dart(const Star& star) {
  return vertex_rule(star.sharpness, star.spokes) == VertexRule::smooth &&
         std::any_of(star.spokes.begin(), star.spokes.end(), [](const Spoke& s) { return s.sharpness > 0; });
}

// Can the limit be read off the star itself?
bool settled(const CreasedRules& rules, const Topology& topology, const Star& star) {
  if (!is_stationary(star)) return false;
  return vertex_rule(star.sharpness, star.spokes) != VertexRule::smooth ||
         rules.is_settled(topology, star, is_dart(star));
}

// The star of a vertex one step on, with what the sharpness of its edges depends on, and the rows that lead there. The vertex comes first.
struct NextStar {
  PartOfMesh part;
  RefinedTopology refined;
};

NextStar next_star(const Topology& topology, const Sharpness& sharpness, const SchemeOptions& options,
                   const Star& star) {
  std::vector<HalfEdge> firsts;  // a face may meet the vertex twice
  const auto add = [&](HalfEdge h) {
    const auto same = [&](HalfEdge g) { return topology.face_of(g) == topology.face_of(h); };
    if (std::none_of(firsts.begin(), firsts.end(), same)) firsts.push_back(h);
  };
  for (const HalfEdge h : star.faces) add(h);
  std::vector<VertexId> far_ends;
  if (!star.faces.empty()) {
    add_far_ends(topology, sharpness, topology.from(star.faces[0]), options, far_ends);
  }
  for (const VertexId end : far_ends) {
    topology.for_each_fan(end, [&](HalfEdge first) { topology.walk_fan(first, add); });
  }
  NextStar next{part_of(topology, sharpness, options.boundary, firsts), {}};
  SchemeOptions inside = options;
  inside.boundary = BoundaryRule::edge_only;
  next.refined = refine(next.part.topology, inside, next.part.sharpness);
  return next;
}

void add_settled_row(const CreasedRules& rules, const Topology& topology, VertexId v, const Star& star,
                     Stencils& out) {
  switch (vertex_rule(star.sharpness, star.spokes)) {
    case VertexRule::corner:
      out.add(v.value(), 1.0);
      break;
    case VertexRule::crease: {
      const loop::RingMask mask = loop::curve_limit_mask();
      out.add(v.value(), mask.centre);
      for (const Spoke& spoke : star.spokes) {
        if (spoke.sharpness > 0) out.add(spoke.end.value(), mask.each);
      }
      break;
    }
    case VertexRule::smooth:
      rules.add_smooth_limit(topology, v, star, out);
  }
  out.end_row();
}

// The step from the star of a dart to the next one, over the same places: row-stochastic.
class DartStep {
 public:
  DartStep(const Topology& topology, const Sharpness& sharpness, const SchemeOptions& options, Star star) {
    // Begin at the sharp edge, in the first star and in the next one: then places agree.
    const auto sharp =
        std::find_if(star.spokes.begin(), star.spokes.end(), [](const Spoke& s) { return s.sharpness > 0; });
    const auto turn = sharp - star.spokes.begin();
    std::rotate(star.faces.begin(), star.faces.begin() + turn, star.faces.end());
    valence_ = star.faces.size();
    NextStar next = next_star(topology, sharpness, options, star);
    std::vector<HalfEdge> firsts;
    for (std::size_t f = 0; f < valence_; ++f) firsts.push_back(4 * next.part.topology.first_of(FaceId(f)));
    const PartOfMesh after = part_of(next.refined.topology, {}, BoundaryRule::edge_only, firsts);
    names_ = std::move(next.part.names);
    SNUG_EXPECT(after.names.size() == names_.size());
    std::vector<std::uint32_t> same(names_.size());
    for (std::size_t i = 0; i < same.size(); ++i) same[i] = static_cast<std::uint32_t>(i);
    for (const VertexId v : after.names) rows_.append(next.refined.stencils.row(v.index()), same);
    for (std::size_t f = 0; f < valence_; ++f) {
      spokes_.push_back(next.part.topology.to(next.part.topology.first_of(FaceId(f))).index());
    }
  }

  [[nodiscard]] std::size_t size() const { return names_.size(); }
  [[nodiscard]] std::span<const VertexId> names() const { return names_; }
  /// Places of the spokes' ends, from the sharp one on.
  [[nodiscard]] std::span<const std::size_t> spokes() const { return spokes_; }

  /// weights * matrix.
  [[nodiscard]] std::vector<double> after(const std::vector<double>& weights) const {
    std::vector<double> result(size(), 0.0);
    for (std::size_t r = 0; r < size(); ++r) {
      const Stencils::Row row = rows_.row(r);
      for (std::size_t i = 0; i < row.sources.size(); ++i)
        result[row.sources[i]] += weights[r] * row.weights[i];
    }
    return result;
  }

  /// Upper bound of the sum over all k of |r S^k|, for a row r of sum 0 and |r| = 1: once all rows of S^m are within 1/2
  /// of each other, it is at most 2 m.
  [[nodiscard]] double decay() const {
    std::vector<std::vector<double>> power;
    for (std::size_t r = 0; r < size(); ++r) {
      power.emplace_back(size(), 0.0);
      power[r][r] = 1;
    }
    for (double m = 1;; ++m) {
      double widest = 0;
      for (std::vector<double>& row : power) row = after(row);
      for (const std::vector<double>& row : power) {
        double distance = 0;
        for (std::size_t c = 0; c < size(); ++c) distance += std::fabs(row[c] - power[0][c]);
        widest = std::max(widest, distance);
      }
      if (widest < 0.49) return 2 * m;
    }
  }

  [[nodiscard]] double row_error() const {
    return enlarged(gamma_bound(size() + 2) * rows_.max_abs_sum() + rows_.max_error());
  }

 private:
  std::size_t valence_ = 0;
  Stencils rows_;
  std::vector<VertexId> names_;
  std::vector<std::size_t> spokes_;
};

double sum_of_sizes(const std::vector<double>& row) {
  double sum = 0;
  for (const double w : row) sum += std::fabs(w);
  return sum;
}

// Limit position of a dart: weights of its places, and how far off they all may be together.
struct DartRow {
  std::vector<double> weights;
  double error;
};

// It has no formula: the left eigenvector of 1 by iteration, its error by the decay of what is left.
DartRow make_dart_row(const DartStep& step) {
  std::vector<double> row(step.size(), 1.0 / static_cast<double>(step.size())), next;
  double change = 1;
  for (int i = 0; i < 400 && change > 1e-17; ++i) {
    next = step.after(row);
    change = 0;
    for (std::size_t c = 0; c < row.size(); ++c) change += std::fabs(next[c] - row[c]);
    row = next;
  }
  double sum = 0;
  for (const double w : row) sum += w;
  next = step.after(row);
  for (std::size_t c = 0; c < row.size(); ++c) next[c] -= row[c];
  const double residual = sum_of_sizes(next) + 2 * step.row_error();
  const double error = enlarged(2 * step.decay() * residual + std::fabs(sum - 1) + gamma_bound(row.size()));
  return {std::move(row), error};
}

// Rows of darts whose places are all different depend on scheme and valence alone, and cost the square of it: the last few are
// kept, at most 256 KiB.
DartRow shared_dart_row(const CreasedRules& rules, const DartStep& step) {
  static std::mutex mutex;
  static RecentValues<std::pair<Scheme, std::size_t>, DartRow, 16> rows;
  const std::lock_guard lock(mutex);
  return rows.get({rules.scheme, step.spokes().size()}, [&] { return make_dart_row(step); });
}

void add_dart_row(const CreasedRules& rules, const DartStep& step, Stencils& out) {
  const std::size_t places = 1 + step.spokes().size() * (rules.corners - 2);
  const DartRow row = step.size() == places ? shared_dart_row(rules, step) : make_dart_row(step);
  for (std::size_t c = 0; c < row.weights.size(); ++c) {
    out.add(step.names()[c].value(), row.weights[c], c == 0 ? row.error : 0.0);
  }
  out.end_row();
}

// Left eigenvectors of the largest eigenvalues below 1, symmetric to the sharp edge and not; by iteration.
// The sine row has no part but its own Fourier mode's, so 40 steps end it; in 300 its roundings would grow
// into the symmetric one, whose eigenvalue is larger below five faces.
void add_dart_tangents(const DartStep& step, Stencils& out) {
  const auto n = static_cast<double>(step.spokes().size());
  for (const bool symmetric : {true, false}) {
    std::vector<double> row(step.size(), 0.0);
    for (std::size_t i = 0; i < step.spokes().size(); ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / n;
      row[step.spokes()[i]] = symmetric ? std::cos(angle) : std::sin(angle);
    }
    for (int i = 0; i < (symmetric ? 300 : 40); ++i) {
      row = step.after(row);
      double sum = 0;
      for (const double w : row) sum += w;
      const double size = sum_of_sizes(row);
      for (double& w : row) w = (w - sum / static_cast<double>(row.size())) / size;
    }
    for (std::size_t c = 0; c < row.size(); ++c) out.add(step.names()[c].value(), row[c]);
    out.end_row();
  }
}

// The spokes and faces from one sharp edge to the next, counter-clockwise, around half-edge `side`.
struct Sector {
  std::vector<VertexId> spokes;
  std::vector<HalfEdge> faces;
};

// Is anything sharp in the fan of `side`? What is sharp may lie in other fans of the vertex alone.
bool has_sector(const Topology& topology, const Sharpness& sharpness, HalfEdge side) {
  bool found = false;
  topology.walk_fan(side, [&](HalfEdge h) {
    for (const HalfEdge g : {h, topology.prev(h)}) {
      found = found || edge_sharpness(topology, sharpness, topology.edge_of(g)) > 0;
    }
  });
  return found;
}

Sector sector_of(const Topology& topology, const Sharpness& sharpness, HalfEdge side) {
  const auto sharp = [&](HalfEdge h) { return edge_sharpness(topology, sharpness, topology.edge_of(h)) > 0; };
  HalfEdge h = side;
  while (!sharp(h)) h = topology.cw(h);
  Sector sector;
  while (true) {
    sector.spokes.push_back(topology.to(h));
    sector.faces.push_back(h);
    const HalfEdge in = topology.prev(h);
    if (sharp(in)) {
      sector.spokes.push_back(topology.from(in));
      return sector;
    }
    h = topology.ccw(h);
  }
}

// Along the crease, from its last spoke to its first, and across. Left eigenvectors with sin(i pi/k) on the spokes inside,
// which fixes the rest; the sum of all weights is 0. derivations/loop_limits.md, catmark_limits.md.
void add_crease_tangents(const CreasedRules& rules, const Topology& topology, VertexId v,
                         const Sector& sector, Stencils& out) {
  const VertexId first = sector.spokes.front(), last = sector.spokes.back();
  out.add(first.value(), 1.0);
  out.add(last.value(), -1.0);
  out.end_row();
  const std::size_t faces = sector.faces.size();
  double end = 1, inner_sum = 0;
  if (faces > 1) {
    const CreasedRules::AcrossCrease across = rules.across_crease(faces);
    for (std::size_t i = 0; i < across.diagonals.size(); ++i) {
      inner_sum += across.diagonals[i];
      out.add(topology.to(topology.next(sector.faces[i])).value(), across.diagonals[i]);
    }
    for (std::size_t i = 0; i < across.inner.size(); ++i) {
      inner_sum += across.inner[i];
      out.add(sector.spokes[i + 1].value(), across.inner[i]);
    }
    end = across.end;
  }
  out.add(v.value(), -inner_sum - 2 * end);
  out.add(first.value(), end);
  out.add(last.value(), end);
  out.end_row();
}

void add_direction(VertexId v, VertexId to, Stencils& out) {
  out.add(v.value(), -1.0);
  out.add(to.value(), 1.0);
  out.end_row();
}

// A corner whose sector has more than two faces, or none that ends, is a spike: there is no plane, and both rows are the
// same.
void add_spike_tangents(const Topology& topology, const Sharpness& sharpness, VertexId v, const Star& star,
                        HalfEdge side, Stencils& out) {
  if (has_sector(topology, sharpness, side)) {
    const Sector sector = sector_of(topology, sharpness, side);
    add_direction(v, sector.spokes.front(), out);
    add_direction(v, sector.faces.size() <= 2 ? sector.spokes.back() : sector.spokes.front(), out);
    return;
  }
  for (int row = 0; row < 2; ++row) {
    for (const Spoke& spoke : star.spokes) {
      out.add(v.value(), -1.0);
      out.add(spoke.end.value(), 1.0);
    }
    out.end_row();
  }
}

// The limit of a vertex that can be read off its star; returns whether it could.
bool add_settled_limit(const CreasedRules& rules, const Topology& topology, VertexId v,
                       const SchemeOptions& options, const Sharpness& sharpness, const Star& star,
                       Stencils& out) {
  if (!settled(rules, topology, star)) return false;
  if (is_dart(star)) {
    add_dart_row(rules, DartStep(topology, sharpness, options, star), out);
  } else {
    add_settled_row(rules, topology, v, star, out);
  }
  return true;
}

}  // namespace

void CreasedRules::add_limit_row(const Topology& topology, VertexId v, const SchemeOptions& options,
                                 const Sharpness& sharpness, Stencils& out) const {
  Star star;
  gather_star(topology, sharpness, v, options.boundary, star);
  if (add_settled_limit(*this, topology, v, options, sharpness, star, out)) return;
  const NextStar next = next_star(topology, sharpness, options, star);
  SchemeOptions inside = options;
  inside.boundary = BoundaryRule::edge_only;
  Stencils limit;
  add_limit_row(next.refined.topology, VertexId(0), inside, next.refined.sharpness, limit);
  add_product(limit.row(0), next.refined.stencils, next.part.names, out);
}

bool CreasedRules::add_corner_limit(const Topology& ring, std::size_t corner, const SchemeOptions& options,
                                    const Sharpness& sharpness, Stencils& out) const {
  const VertexId v = ring.face(FaceId(0))[corner];
  Star star;
  gather_star(ring, sharpness, v, options.boundary, star);
  return add_settled_limit(*this, ring, v, options, sharpness, star, out);
}

Stencils CreasedRules::tangent_rows(const Topology& topology, VertexId v, const SchemeOptions& options,
                                    const Sharpness& sharpness, HalfEdge side) const {
  if (side == no_half_edge) side = topology.leaving(v);
  Stencils out;
  Star star;
  gather_star(topology, sharpness, v, options.boundary, star);
  if (!settled(*this, topology, star)) {
    const NextStar next = next_star(topology, sharpness, options, star);
    const auto place = static_cast<std::size_t>(
        std::find(next.part.faces.begin(), next.part.faces.end(), topology.face_of(side)) -
        next.part.faces.begin());
    SNUG_EXPECT(place < next.part.faces.size());
    const HalfEdge first = next.part.topology.first_of(FaceId(place));
    SchemeOptions inside = options;
    inside.boundary = BoundaryRule::edge_only;
    const Stencils limit =
        tangent_rows(next.refined.topology, VertexId(0), inside, next.refined.sharpness, 4 * first);
    for (std::size_t t = 0; t < 2; ++t) {
      add_product(limit.row(t), next.refined.stencils, next.part.names, out);
    }
    return out;
  }
  switch (vertex_rule(star.sharpness, star.spokes)) {
    case VertexRule::smooth:
      if (is_dart(star)) {
        add_dart_tangents(DartStep(topology, sharpness, options, star), out);
      } else {
        add_smooth_tangents(topology, star, out);
      }
      break;
    case VertexRule::crease:
      if (has_sector(topology, sharpness, side)) {
        add_crease_tangents(*this, topology, v, sector_of(topology, sharpness, side), out);
      } else {  // a closed fan whose curve runs through other sheets: no plane of its own
        for (int row = 0; row < 2; ++row) {
          double sign = 1;
          for (const Spoke& spoke : star.spokes) {
            if (spoke.sharpness > 0) out.add(spoke.end.value(), std::exchange(sign, -1.0));
          }
          out.end_row();
        }
      }
      break;
    case VertexRule::corner:
      add_spike_tangents(topology, sharpness, v, star, side, out);
      break;
  }
  return out;
}

void CreasedRules::add_corner_tangents(const Topology& ring, std::size_t corner, const SchemeOptions& options,
                                       const Sharpness& sharpness, Stencils& out) const {
  const Stencils rows =
      tangent_rows(ring, ring.face(FaceId(0))[corner], options, sharpness, static_cast<HalfEdge>(corner));
  std::vector<std::uint32_t> same_names(ring.vertex_count());
  std::iota(same_names.begin(), same_names.end(), 0u);
  for (std::size_t t = 0; t < 2; ++t) out.append(rows.row(t), same_names);
}

}  // namespace snug
