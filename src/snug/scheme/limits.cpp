#include <snug/scheme/limits.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <utility>

#include <snug/base/compact_numbering.h>
#include <snug/base/contract.h>
#include <snug/base/recent_values.h>
#include <snug/geometry/rounding.h>
#include <snug/scheme/catmark_masks.h>
#include <snug/scheme/loop_masks.h>
#include <snug/scheme/refine.h>
#include <snug/scheme/row_builder.h>

namespace snug {
namespace {

bool among_quads(const Topology& topology, const Star& star) {
  return std::all_of(star.faces.begin(), star.faces.end(),
                     [&](HalfEdge h) { return topology.face(topology.face_of(h)).size() == 4; });
}

bool is_dart(const Star& star) {
  return vertex_rule(star.sharpness, star.spokes) == VertexRule::smooth &&
         std::any_of(star.spokes.begin(), star.spokes.end(), [](const Spoke& s) { return s.sharpness > 0; });
}

// Is each vertex around in one place only? In a small mesh two faces may have a second vertex in common.
bool has_distinct_places(const Topology& topology, const Star& star) {
  std::vector<VertexId> places;
  for (const HalfEdge first : star.faces) {
    for (HalfEdge h = topology.next(first); topology.to(h) != topology.from(first); h = topology.next(h)) {
      places.push_back(topology.from(h));
    }
  }
  std::sort(places.begin(), places.end());
  return std::adjacent_find(places.begin(), places.end()) == places.end();
}

// Can the limit be read off the star itself?
bool is_settled(const Topology& topology, const Star& star, Scheme scheme) {
  if (!is_stationary(star)) return false;
  return scheme == Scheme::loop || vertex_rule(star.sharpness, star.spokes) != VertexRule::smooth ||
         (among_quads(topology, star) && (!is_dart(star) || has_distinct_places(topology, star)));
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

void add_settled_row(const Topology& topology, VertexId v, Scheme scheme, const Star& star, Stencils& out) {
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
      if (scheme == Scheme::loop) {
        const loop::RingMask mask = loop::limit_mask(star.spokes.size());
        out.add(v.value(), mask.centre);
        for (const Spoke& spoke : star.spokes) out.add(spoke.end.value(), mask.each);
      } else {
        const catmark::StarMask mask = catmark::limit_mask(star.faces.size());
        out.add(v.value(), mask.centre);
        for (const Spoke& spoke : star.spokes) out.add(spoke.end.value(), mask.edge);
        for (const HalfEdge h : star.faces) out.add(topology.to(topology.next(h)).value(), mask.diagonal);
      }
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
DartRow shared_dart_row(Scheme scheme, const DartStep& step) {
  static std::mutex mutex;
  static RecentValues<std::pair<Scheme, std::size_t>, DartRow, 16> rows;
  const std::lock_guard lock(mutex);
  return rows.get({scheme, step.spokes().size()}, [&] { return make_dart_row(step); });
}

void add_dart_row(Scheme scheme, const DartStep& step, Stencils& out) {
  const std::size_t places = 1 + step.spokes().size() * (scheme == Scheme::loop ? 1 : 2);
  const DartRow row = step.size() == places ? shared_dart_row(scheme, step) : make_dart_row(step);
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

// The middle of a vertex's patch: the mean of the corners of its own new face.
void add_dual_row(const Topology& topology, VertexId v, const SchemeOptions& options, Stencils& out) {
  if (topology.isolated(v) || topology.on_boundary(v)) {
    out.add(v.value(), 1.0);
    out.end_row();
    return;
  }
  std::vector<HalfEdge> firsts;
  topology.walk_fan(topology.leaving(v), [&](HalfEdge h) { firsts.push_back(h); });
  const PartOfMesh part = part_of(topology, {}, options.boundary, firsts);
  const RefinedTopology refined = refine(part.topology, options);
  RowBuilder row;
  const Interval each = Interval(1) / Interval(static_cast<double>(firsts.size()));
  for (std::size_t f = 0; f < firsts.size(); ++f) {
    row.add(each, refined.stencils.row(part.topology.first_of(FaceId(f))));
  }
  Stencils one;
  row.end_row(one);
  std::vector<std::uint32_t> names;
  for (const VertexId name : part.names) names.push_back(name.value());
  out.append(one.row(0), names);
}

// Left eigenvectors of the subdominant eigenvalue at a smooth vertex: first Fourier modes. The diagonal after spoke i
// lies between spokes i and i + 1.
void add_smooth_tangents(const Topology& topology, Scheme scheme, const Star& star, Stencils& out) {
  const std::size_t n = star.spokes.size();
  if (scheme == Scheme::catmark && n == 2) {  // the row of the cosine vanishes: no plane
    out.end_row();
    out.end_row();
    return;
  }
  const auto cosine = [&](std::size_t quarters) {
    return cos_of_turn(static_cast<unsigned>(quarters % (4 * n)), static_cast<unsigned>(4 * n));
  };
  double spoke_weight = 1;
  if (scheme == Scheme::catmark) {
    const double lambda = catmark::subdominant(n);
    // derivations/catmark_limits.md:  diagonal (c_i + c_{i+1}),  spoke (16 lambda - 4) c_i
    spoke_weight = 16 * lambda - 4;
  }
  for (const std::size_t turn : {std::size_t{0}, 3 * n}) {  // sin x = cos(x - pi/2), in quarters of a step
    for (std::size_t i = 0; i < n; ++i) {
      const Interval c = cosine(4 * i + turn);
      out.add(star.spokes[i].end.value(), scheme == Scheme::loop ? c : Interval(spoke_weight) * c);
      if (scheme == Scheme::catmark) {
        out.add(topology.to(topology.next(star.faces[i])).value(), c + cosine(4 * (i + 1) + turn));
      }
    }
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
// which fixes the rest.
void add_crease_tangents(const Topology& topology, VertexId v, Scheme scheme, const Sector& sector,
                         Stencils& out) {
  const VertexId first = sector.spokes.front(), last = sector.spokes.back();
  out.add(first.value(), 1.0);
  out.add(last.value(), -1.0);
  out.end_row();
  const std::size_t faces = sector.faces.size();
  double end = 1, inner_sum = 0;
  if (faces > 1) {
    const double step = std::numbers::pi / static_cast<double>(faces);
    const double first_sine = std::sin(step);
    double eigenvalue = loop::subdominant_across_boundary(faces), spoke_weight = 1, diagonal = 0;
    if (scheme == Scheme::catmark) {
      eigenvalue = catmark::subdominant(2 * faces);
      spoke_weight = 16 * eigenvalue - 4;
      for (std::size_t i = 0; i < faces; ++i) {
        const double w =
            std::sin(static_cast<double>(i) * step) + std::sin(static_cast<double>(i + 1) * step);
        inner_sum += w;
        out.add(topology.to(topology.next(sector.faces[i])).value(), w);
      }
      diagonal = first_sine;
    }
    for (std::size_t i = 1; i < faces; ++i) {
      const double w = spoke_weight * std::sin(static_cast<double>(i) * step);
      inner_sum += w;
      out.add(sector.spokes[i].value(), w);
    }
    // Columns of an end and of v, and the sum of all weights being 0; derivations/loop_limits.md, catmark_limits.md.
    end = scheme == Scheme::loop
              ? (first_sine - inner_sum) / (8 * eigenvalue - 2)
              : (spoke_weight * first_sine / 16 + diagonal / 4 - inner_sum / 8) / (eigenvalue - 0.25);
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
void add_corner_tangents(const Topology& topology, const Sharpness& sharpness, VertexId v, const Star& star,
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

}  // namespace

void vertices_of(const Topology& topology, std::span<const HalfEdge> firsts, std::vector<VertexId>& names,
                 std::vector<VertexId>* corners) {
  thread_local CompactNumbering met;
  met.begin(topology.vertex_count());
  names.clear();
  for (const HalfEdge first : firsts) {
    HalfEdge h = first;
    do {
      const VertexId v = topology.from(h), own(met.number(v.index()));
      if (own.index() == names.size()) names.push_back(v);
      if (corners) corners->push_back(own);
      h = topology.next(h);
    } while (h != first);
  }
}

PartOfMesh part_of(const Topology& topology, const Sharpness& sharpness, BoundaryRule boundary,
                   std::span<const HalfEdge> firsts) {
  PartOfMesh part;
  std::vector<std::uint32_t> offsets{0};
  std::vector<VertexId> corners;
  vertices_of(topology, firsts, part.names, &corners);
  for (const HalfEdge first : firsts) {
    const FaceId f = topology.face_of(first);
    part.faces.push_back(f);
    offsets.push_back(offsets.back() + static_cast<std::uint32_t>(topology.face(f).size()));
  }
  part.topology = Topology(std::move(offsets), std::move(corners), part.names.size());

  const auto keep = [](std::vector<double>& all, std::size_t count, std::size_t i, double s) {
    if (s == 0) return;
    if (all.empty()) all.assign(count, 0.0);
    all[i] = s;
  };
  for (std::size_t i = 0; i < part.names.size(); ++i) {
    keep(part.sharpness.vertices, part.names.size(), i,
         vertex_sharpness(topology, sharpness, part.names[i], boundary));
  }
  part.sharpness.vertices_complete = true;
  HalfEdge own = 0;
  for (const HalfEdge first : firsts) {
    HalfEdge h = first;
    do {
      keep(part.sharpness.edges, part.topology.edge_count(), part.topology.edge_of(own).index(),
           edge_sharpness(topology, sharpness, topology.edge_of(h)));
      h = topology.next(h);
      ++own;
    } while (h != first);
  }
  return part;
}

bool add_settled_limit_row(const Topology& topology, VertexId v, const SchemeOptions& options,
                           const Sharpness& sharpness, Stencils& out) {
  Star star;
  gather_star(topology, sharpness, v, options.boundary, star);
  if (!is_settled(topology, star, options.scheme)) return false;
  if (is_dart(star)) {
    add_dart_row(options.scheme, DartStep(topology, sharpness, options, star), out);
  } else {
    add_settled_row(topology, v, options.scheme, star, out);
  }
  return true;
}

void add_limit_row(const Topology& topology, VertexId v, const SchemeOptions& options,
                   const Sharpness& sharpness, Stencils& out) {
  if (!is_primal(options.scheme)) {
    add_dual_row(topology, v, options, out);
    return;
  }
  if (topology.isolated(v)) {
    out.add(v.value(), 1.0);
    out.end_row();
    return;
  }
  if (add_settled_limit_row(topology, v, options, sharpness, out)) return;
  Star star;
  gather_star(topology, sharpness, v, options.boundary, star);
  const NextStar next = next_star(topology, sharpness, options, star);
  SchemeOptions inside = options;
  inside.boundary = BoundaryRule::edge_only;
  Stencils limit;
  add_limit_row(next.refined.topology, VertexId(0), inside, next.refined.sharpness, limit);
  add_product(limit.row(0), next.refined.stencils, next.part.names, out);
}

Stencils limit_stencils(const Topology& topology, const SchemeOptions& options, const Sharpness& sharpness,
                        const WorkMonitor& monitor) {
  Stencils out;
  out.reserve(topology.vertex_count(), 7 * topology.vertex_count());
  for (std::size_t v = 0; v < topology.vertex_count(); ++v) {
    monitor.checkpoint();
    add_limit_row(topology, VertexId(v), options, sharpness, out);
  }
  return out;
}

TangentRows tangent_rows(const Topology& topology, VertexId v, const SchemeOptions& options,
                         const Sharpness& sharpness, HalfEdge side) {
  SNUG_EXPECT(is_primal(options.scheme) && !topology.isolated(v));
  if (side == no_half_edge) side = topology.leaving(v);
  TangentRows result;
  Star star;
  gather_star(topology, sharpness, v, options.boundary, star);
  if (!is_settled(topology, star, options.scheme)) {
    const NextStar next = next_star(topology, sharpness, options, star);
    const auto place = static_cast<std::size_t>(
        std::find(next.part.faces.begin(), next.part.faces.end(), topology.face_of(side)) -
        next.part.faces.begin());
    SNUG_EXPECT(place < next.part.faces.size());
    const HalfEdge first = next.part.topology.first_of(FaceId(place));
    SchemeOptions inside = options;
    inside.boundary = BoundaryRule::edge_only;
    const TangentRows limit =
        tangent_rows(next.refined.topology, VertexId(0), inside, next.refined.sharpness, 4 * first);
    for (std::size_t t = 0; t < 2; ++t) {
      add_product(limit.rows.row(t), next.refined.stencils, next.part.names, result.rows);
    }
    return result;
  }
  switch (vertex_rule(star.sharpness, star.spokes)) {
    case VertexRule::smooth:
      if (is_dart(star)) {
        add_dart_tangents(DartStep(topology, sharpness, options, star), result.rows);
      } else {
        add_smooth_tangents(topology, options.scheme, star, result.rows);
      }
      break;
    case VertexRule::crease:
      if (has_sector(topology, sharpness, side)) {
        add_crease_tangents(topology, v, options.scheme, sector_of(topology, sharpness, side), result.rows);
      } else {  // a closed fan whose curve runs through other sheets: no plane of its own
        for (int row = 0; row < 2; ++row) {
          double sign = 1;
          for (const Spoke& spoke : star.spokes) {
            if (spoke.sharpness > 0) result.rows.add(spoke.end.value(), std::exchange(sign, -1.0));
          }
          result.rows.end_row();
        }
      }
      break;
    case VertexRule::corner:
      add_corner_tangents(topology, sharpness, v, star, side, result.rows);
      break;
  }
  return result;
}

}  // namespace snug
