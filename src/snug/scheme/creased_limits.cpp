#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/scheme/creased.h>
#include <support/contract.h>
#include <support/recent_values.h>

// Limits and tangents of schemes with creases.
namespace snug {
namespace {

bool is_dart(const Star& star) {
  return vertex_rule(star) == VertexRule::smooth &&
         std::any_of(star.spokes.begin(), star.spokes.end(), [](const Spoke& s) { return s.sharpness > 0; });
}

// Can the limit be read off the star itself?
bool limit_in_star(const CreasedRules& rules, const Topology& topology, const Star& star) {
  return is_stationary(star) &&
         (vertex_rule(star) != VertexRule::smooth || rules.has_limit_in_star(topology, star, is_dart(star)));
}

// The star of a vertex one step on, with what the sharpness of its edges depends on, and the rows that lead
// there. The vertex comes first.
struct NextStar {
  PartOfMesh part;
  SchemeOptions options;
  RefinedTopology refined;
  [[nodiscard]] RuledMesh ruled() const { return {refined.topology, options, refined.sharpness}; }
};

NextStar next_star(const RuledMesh& mesh, const Star& star) {
  const Topology& topology = mesh.topology;
  std::vector<HalfEdge> firsts;  // a face may meet the vertex twice
  const auto add = [&](HalfEdge h) {
    const auto same = [&](HalfEdge g) { return topology.face_of(g) == topology.face_of(h); };
    if (std::none_of(firsts.begin(), firsts.end(), same)) firsts.push_back(h);
  };
  for (const HalfEdge h : star.faces) add(h);
  std::vector<VertexId> far_ends;
  if (!star.faces.empty()) add_far_ends(mesh, topology.from(star.faces[0]), far_ends);
  for (const VertexId end : far_ends) walk_fans(topology, end, add);
  NextStar next{part_of(topology, mesh.sharpness, mesh.options.boundary, firsts), mesh.options, {}};
  next.options.boundary = BoundaryRule::edge_only;
  next.refined = refine(next.part.topology, next.options, next.part.sharpness);
  return next;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t c = 0; c < a.size(); ++c) sum += std::fabs(a[c] - b[c]);
  return sum;
}

// The step from the star of a dart to the next one, over the same places: row-stochastic.
struct DartStep {
  Stencils rows;
  std::vector<VertexId> names;
  std::vector<std::size_t> spokes;  // places of their ends, from the sharp one on

  DartStep(const RuledMesh& mesh, Star star) {
    // Begin at the sharp edge, in the first star and in the next one: then places agree.
    const auto sharp =
        std::find_if(star.spokes.begin(), star.spokes.end(), [](const Spoke& s) { return s.sharpness > 0; });
    std::rotate(star.faces.begin(), star.faces.begin() + (sharp - star.spokes.begin()), star.faces.end());
    NextStar next = next_star(mesh, star);
    std::vector<HalfEdge> firsts;
    for (std::size_t f = 0; f < star.faces.size(); ++f) {
      const HalfEdge first = next.part.topology.first_of(FaceId(f));
      spokes.push_back(next.part.topology.to(first).index());
      firsts.push_back(4 * first);
    }
    const PartOfMesh after = part_of(next.refined.topology, {}, BoundaryRule::edge_only, firsts);
    names = std::move(next.part.names);
    SNUG_EXPECT(after.names.size() == names.size());
    for (const VertexId v : after.names) rows.append(next.refined.stencils.row(v.index()));
  }

  // weights * matrix
  [[nodiscard]] std::vector<double> after(const std::vector<double>& weights) const {
    std::vector<double> result(names.size(), 0.0);
    for (std::size_t r = 0; r < names.size(); ++r) {
      const Stencils::Row row = rows.row(r);
      for (std::size_t i = 0; i < row.sources.size(); ++i)
        result[row.sources[i]] += weights[r] * row.weights[i];
    }
    return result;
  }

  // Upper bound of the sum over all k of |r S^k|, for a row r of sum 0 and |r| = 1: once all rows of S^m are
  // within 1/2 of each other, it is at most 2 m.
  [[nodiscard]] double decay() const {
    std::vector<std::vector<double>> power;
    for (std::size_t r = 0; r < names.size(); ++r) {
      power.emplace_back(names.size(), 0.0);
      power[r][r] = 1;
    }
    for (double m = 1;; ++m) {
      double widest = 0;
      for (std::vector<double>& row : power) row = after(row);
      for (const std::vector<double>& row : power) widest = std::max(widest, distance(row, power[0]));
      if (widest < 0.49) return 2 * m;
    }
  }
};

// Limit position of a dart: weights of its places, and how far off they all may be together.
struct DartRow {
  std::vector<double> weights;
  double error;
};

// It has no formula: the left eigenvector of 1 by iteration, its error by the decay of what is left.
DartRow make_dart_row(const DartStep& step) {
  const std::size_t size = step.names.size();
  std::vector<double> row(size, 1.0 / static_cast<double>(size));
  double change = 1;
  for (int i = 0; i < 400 && change > 1e-17; ++i) {
    const std::vector<double> next = step.after(row);
    change = distance(next, row);
    row = next;
  }
  const double sum = std::accumulate(row.begin(), row.end(), 0.0);
  const double row_error = enlarged(gamma_bound(size + 2) * step.rows.max_abs_sum() + step.rows.max_error());
  const double residual = distance(step.after(row), row) + 2 * row_error;
  const double error = enlarged(2 * step.decay() * residual + std::fabs(sum - 1) + gamma_bound(size));
  return {std::move(row), error};
}

// Rows of darts whose places are all different depend on scheme and valence alone, and cost the square of it:
// the last few are kept, at most 256 KiB.
DartRow shared_dart_row(const CreasedRules& rules, const DartStep& step) {
  static std::mutex mutex;
  static RecentValues<std::pair<Scheme, std::size_t>, DartRow, 16> rows;
  const std::lock_guard lock(mutex);
  return rows.get({rules.scheme, step.spokes.size()}, [&] { return make_dart_row(step); });
}

void add_dart_row(const CreasedRules& rules, const DartStep& step, Stencils& out) {
  const std::size_t places = 1 + step.spokes.size() * (rules.corners - 2);
  const DartRow row = step.names.size() == places ? shared_dart_row(rules, step) : make_dart_row(step);
  for (std::size_t c = 0; c < row.weights.size(); ++c) {
    out.add(step.names[c].value(), row.weights[c], c == 0 ? row.error : 0.0);
  }
  out.end_row();
}

// Left eigenvectors of the largest eigenvalues below 1, symmetric to the sharp edge and not; by iteration.
// The sine row has no part but its own Fourier mode's, so 40 steps end it; in 300 its roundings would grow
// into the symmetric one, whose eigenvalue is larger below five faces.
void add_dart_tangents(const DartStep& step, Stencils& out) {
  const auto n = static_cast<double>(step.spokes.size());
  const std::vector<double> zero(step.names.size(), 0.0);
  for (const bool symmetric : {true, false}) {
    std::vector<double> row = zero;
    for (std::size_t i = 0; i < step.spokes.size(); ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / n;
      row[step.spokes[i]] = symmetric ? std::cos(angle) : std::sin(angle);
    }
    for (int i = 0; i < (symmetric ? 300 : 40); ++i) {
      row = step.after(row);
      const double sum = std::accumulate(row.begin(), row.end(), 0.0), size = distance(row, zero);
      for (double& w : row) w = (w - sum / static_cast<double>(row.size())) / size;
    }
    for (std::size_t c = 0; c < row.size(); ++c) out.add(step.names[c].value(), row[c]);
    out.end_row();
  }
}

// The spokes and faces from one sharp edge to the next, counter-clockwise, around a half-edge.
struct Sector {
  std::vector<VertexId> spokes;
  std::vector<HalfEdge> faces;
};

// None where nothing is sharp in the fan of `side`: what is sharp may lie in other fans of the vertex alone.
std::optional<Sector> sector_of(const RuledMesh& mesh, HalfEdge side) {
  const Topology& topology = mesh.topology;
  const auto sharp = [&](HalfEdge h) {
    return edge_sharpness(topology, mesh.sharpness, topology.edge_of(h)) > 0;
  };
  bool found = false;
  topology.walk_fan(side, [&](HalfEdge h) { found = found || sharp(h) || sharp(topology.prev(h)); });
  if (!found) return {};
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

// Along the crease, from its last spoke to its first, and across. Left eigenvectors with sin(i pi/k) on the
// spokes inside, which fixes the rest; the sum of all weights is 0. derivations/loop_limits.md,
// catmark_limits.md.
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

// A corner whose sector has more than two faces, or none that ends, is a spike: there is no plane, and both
// rows are the same.
void add_spike_tangents(const std::optional<Sector>& sector, VertexId v, const Star& star, Stencils& out) {
  if (sector) {
    add_direction(v, sector->spokes.front(), out);
    add_direction(v, sector->faces.size() <= 2 ? sector->spokes.back() : sector->spokes.front(), out);
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

// A closed fan whose curve runs through other sheets has no plane of its own.
void add_curve_tangents(const Star& star, Stencils& out) {
  for (int row = 0; row < 2; ++row) {
    double sign = 1;
    for (const Spoke& spoke : star.spokes) {
      if (spoke.sharpness > 0) out.add(spoke.end.value(), std::exchange(sign, -1.0));
    }
    out.end_row();
  }
}

// The limit of a vertex, if it can be read off its star; returns whether it could.
bool add_limit_in_star(const CreasedRules& rules, const RuledMesh& mesh, VertexId v, const Star& star,
                       Stencils& out) {
  if (!limit_in_star(rules, mesh.topology, star)) return false;
  if (is_dart(star)) {
    add_dart_row(rules, DartStep(mesh, star), out);
    return true;
  }
  switch (vertex_rule(star)) {
    case VertexRule::corner:
      out.add(v.value(), 1.0);
      break;
    case VertexRule::crease:  // a cubic B-spline
      out.add(v.value(), Interval(2) / Interval(3));
      for (const Spoke& spoke : star.spokes) {
        if (spoke.sharpness > 0) out.add(spoke.end.value(), Interval(1) / Interval(6));
      }
      break;
    case VertexRule::smooth:
      rules.add_smooth_limit(mesh.topology, v, star, out);
  }
  out.end_row();
  return true;
}

}  // namespace

void CreasedRules::add_limit_row(const RuledMesh& mesh, VertexId v, Stencils& out) const {
  Star star;
  gather_star(mesh, v, star);
  if (add_limit_in_star(*this, mesh, v, star, out)) return;
  const NextStar next = next_star(mesh, star);
  Stencils limit;
  add_limit_row(next.ruled(), VertexId(0), limit);
  add_product(limit.row(0), next.refined.stencils, next.part.names, out);
}

bool CreasedRules::add_corner_limit(const RuledMesh& mesh, HalfEdge corner, Stencils& out) const {
  const VertexId v = mesh.topology.from(corner);
  Star star;
  gather_star(mesh, v, star);
  return add_limit_in_star(*this, mesh, v, star, out);
}

void CreasedRules::add_corner_tangents(const RuledMesh& mesh, HalfEdge corner, Stencils& out) const {
  const Topology& topology = mesh.topology;
  const VertexId v = topology.from(corner);
  Star star;
  gather_star(mesh, v, star);
  // The rows of a crease are those of faces that a step no longer changes the size of.
  const auto odd = [&](HalfEdge h) { return topology.face(topology.face_of(h)).size() != corners; };
  const bool odd_crease =
      vertex_rule(star) == VertexRule::crease && std::any_of(star.faces.begin(), star.faces.end(), odd);
  if (odd_crease || !limit_in_star(*this, topology, star)) {
    const NextStar next = next_star(mesh, star);
    const auto& faces = next.part.faces;
    const auto place = std::find(faces.begin(), faces.end(), topology.face_of(corner)) - faces.begin();
    SNUG_EXPECT(place < std::ssize(faces));
    const HalfEdge first = next.part.topology.first_of(FaceId(static_cast<std::size_t>(place)));
    Stencils limit;
    add_corner_tangents(next.ruled(), 4 * first, limit);
    for (std::size_t t = 0; t < 2; ++t)
      add_product(limit.row(t), next.refined.stencils, next.part.names, out);
    return;
  }
  const VertexRule rule = vertex_rule(star);
  if (rule == VertexRule::smooth) {
    is_dart(star) ? add_dart_tangents(DartStep(mesh, star), out) : add_smooth_tangents(topology, star, out);
    return;
  }
  const std::optional<Sector> sector = sector_of(mesh, corner);
  if (rule == VertexRule::corner) {
    add_spike_tangents(sector, v, star, out);
  } else if (sector) {
    add_crease_tangents(*this, topology, v, *sector, out);
  } else {
    add_curve_tangents(star, out);
  }
}

}  // namespace snug
