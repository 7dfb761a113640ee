#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>
#include <tuple>

#include <oracle/dual_twin.h>
#include <oracle/polygon_twin.h>
#include <oracle/tagged_shapes.h>
#include <snug/distance.h>
#include <testing/counts.h>
#include <testing/ground_trials.h>
#include <testing/surfaces.h>
#include <testing/tagged.h>

namespace snug::testing {

namespace {

using oracle::Point;
using oracle::TaggedMesh;
namespace meshes = oracle::meshes;
using Id = std::uint32_t;

constexpr std::array<std::size_t, factor_count> counts{4, 2, 3, 6, 2, 2, 4, 2};

template <class Value>
Value choice(const Choices& choices, Factor factor) {
  return static_cast<Value>(choices[static_cast<std::size_t>(factor)]);
}
Scheme scheme_of(const Choices& choices) { return choice<Scheme>(choices, Factor::scheme); }

struct Dice {
  std::mt19937_64& random;
  double unit() { return static_cast<double>(random() >> 11) * 0x1p-53; }
  double between(double a, double b) { return a + (b - a) * unit(); }
  bool one_in(std::uint64_t n) { return random() % n == 0; }
  Id below(std::size_t n) { return static_cast<Id>(random() % n); }
  double size(double least, double most) { return least * std::pow(most / least, unit()); }
  Point point(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
};

// ---- rows

void for_each_choices(const std::function<void(const Choices&)>& visit) {
  Choices choices{};
  for (;;) {
    if (is_possible(choices)) visit(choices);
    std::size_t f = 0;
    while (f < factor_count && ++choices[f] == counts[f]) choices[f++] = 0;
    if (f == factor_count) return;
  }
}

/// High valences take long, and with tables and tags very long: one in `rare`, and never both.
Choices random_choices(Dice& dice, std::uint64_t rare, bool covering) {
  for (;;) {
    Choices choices{};
    for (std::size_t f = 0; f < factor_count; ++f)
      choices[f] = static_cast<std::uint8_t>(dice.below(counts[f]));
    std::uint8_t& valence = choices[static_cast<std::size_t>(Factor::valence)];
    if (!dice.one_in(rare)) valence = 0;
    if (!covering && choice<BoundMethod>(choices, Factor::sets) != BoundMethod::rows) valence = 0;
    if (is_possible(choices)) return choices;
  }
}

/// solids: nothing if the row is one to cover pairs.
PairChoices random_row(Dice& dice, std::optional<bool> solids) {
  PairChoices row{};
  for (std::size_t side = 0; side < 2; ++side) {
    Choices choices = random_choices(dice, solids ? 150 : 8, !solids);
    if (solids && *solids) {
      for (const Factor factor : {Factor::border, Factor::holes})
        choices[static_cast<std::size_t>(factor)] = 0;
      std::uint8_t& connection = choices[static_cast<std::size_t>(Factor::connection)];
      if (connection == static_cast<std::uint8_t>(Connection::edge)) connection = 0;
    }
    std::copy(choices.begin(), choices.end(), row.begin() + static_cast<std::ptrdiff_t>(side * factor_count));
  }
  return row;
}

// ---- shapes

TaggedMesh triangulated(const TaggedMesh& mesh) { return meshes::triangulated(mesh); }

/// Rings of n vertices around vertex 0; a sector of them if it is open.
TaggedMesh disc(Id n, Id rings, bool open) {
  TaggedMesh mesh;
  mesh.points = {{0, 0, 0.3}};
  const Id around = open ? n + 1 : n;
  for (Id r = 1; r <= rings; ++r)
    for (Id i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / (open ? n + n / 3 : n),
                   radius = static_cast<double>(r) / rings;
      mesh.points.push_back({radius * std::cos(angle), radius * std::sin(angle),
                             0.3 * (1 - radius) + 0.15 * radius * std::sin(3 * angle)});
    }
  for (Id i = 0; i < n; ++i) {
    const Id next = (i + 1) % around;
    mesh.polygons.push_back({0, 1 + i, 1 + next});
    for (Id r = 0; r + 1 < rings; ++r)
      mesh.polygons.push_back(
          {1 + r * around + i, 1 + (r + 1) * around + i, 1 + (r + 1) * around + next, 1 + r * around + next});
  }
  return mesh;
}

/// n triangles around vertex 0, as many around the last one, and perhaps quads between.
TaggedMesh spindle(Id n, bool quads) {
  TaggedMesh mesh = disc(n, 1, false);
  mesh.points[0] = {0, 0, 0.8};
  if (quads) {
    for (Id i = 0; i < n; ++i) {
      const Point p = mesh.points[1 + i];
      mesh.points.push_back({0.8 * p[0], 0.8 * p[1], p[2] - 0.5});
      mesh.polygons.push_back({1 + i, 1 + n + i, 1 + n + (i + 1) % n, 1 + (i + 1) % n});
    }
  }
  const Id last = static_cast<Id>(mesh.points.size());
  mesh.points.push_back({0, 0, -0.9});
  for (Id i = 0; i < n; ++i) mesh.polygons.push_back({last, last - n + (i + 1) % n, last - n + i});
  return mesh;
}

TaggedMesh centred(TaggedMesh mesh) {
  Point lower{1e9, 1e9, 1e9}, upper{-1e9, -1e9, -1e9};
  for (const Point& p : mesh.points)
    for (std::size_t x = 0; x < 3; ++x)
      lower[x] = std::min(lower[x], p[x]), upper[x] = std::max(upper[x], p[x]);
  double size = 0;
  for (std::size_t x = 0; x < 3; ++x) size = std::max(size, upper[x] - lower[x]);
  for (Point& p : mesh.points)
    for (std::size_t x = 0; x < 3; ++x) p[x] = 2 * (p[x] - (lower[x] + upper[x]) / 2) / size;
  return mesh;
}

/// Each face around a vertex of hundreds with tags is of a kind of its own, and tables of these take long.
struct Valence {
  bool many;
  Id most;
};
Valence valence_of(const Choices& choices, Dice& dice) {
  const bool plain = choice<Tags>(choices, Factor::tags) == Tags::none,
             rows = choice<BoundMethod>(choices, Factor::sets) == BoundMethod::rows;
  const bool primal = !traits_of(scheme_of(choices)).dual;
  return {choice<std::uint8_t>(choices, Factor::valence) == 1, !rows                       ? 100U
                                                               : !plain                    ? 230U
                                                               : dice.one_in(30) && primal ? 512U
                                                                                           : 360U};
}
Id high_valence(const Valence& valence, Dice& dice) {
  return valence.most == 512 || valence.most == 100 ? valence.most : 200 + dice.below(valence.most - 199);
}

/// Some faces cut into triangles, so that triangles, quads and others meet.
void cut_some(TaggedMesh& mesh, Dice& dice) {
  for (std::size_t f = mesh.polygons.size(); f-- > 0;) {
    const auto face = mesh.polygons[f];
    if (face.size() != 4 || !dice.one_in(5)) continue;
    mesh.polygons[f] = {face[0], face[1], face[2]};
    mesh.polygons.push_back({face[0], face[2], face[3]});
  }
}

TaggedMesh closed_shape(const Valence& valence, Dice& dice) {
  if (valence.many) {
    const Id n = high_valence(valence, dice);
    return dice.one_in(3) ? meshes::pyramid(n) : spindle(n, dice.one_in(2));
  }
  switch (dice.below(6)) {
    case 0:
      return meshes::cube();
    case 1:
      return meshes::prism(3 + dice.below(5));
    case 2:
      return meshes::pyramid(3 + dice.below(6));
    case 3:
      return spindle(3 + dice.below(7), false);
    case 4:
      return spindle(4 + dice.below(4), true);
    default: {
      TaggedMesh mesh = meshes::cube();
      cut_some(mesh, dice);
      return mesh;
    }
  }
}

TaggedMesh open_shape(const Valence& valence, bool wedge, Dice& dice) {
  if (valence.many) return disc(high_valence(valence, dice), 2, wedge);
  switch (dice.below(4)) {
    case 0:
      return disc(3 + dice.below(7), 2 + dice.below(2), false);
    case 1:
      return disc(3 + dice.below(7), 3, true);
    default: {
      TaggedMesh mesh = meshes::quad_grid(4, 4);
      cut_some(mesh, dice);
      return mesh;
    }
  }
}

/// Adds a mesh, whose vertices of the second list become those of the first.
void join(TaggedMesh& mesh, const TaggedMesh& other, const std::vector<Id>& at, const std::vector<Id>& of) {
  std::vector<Id> names;
  for (Id v = 0; v < other.points.size(); ++v) {
    const auto found = std::find(of.begin(), of.end(), v);
    if (found != of.end()) {
      names.push_back(at[static_cast<std::size_t>(found - of.begin())]);
    } else {
      names.push_back(static_cast<Id>(mesh.points.size()));
      mesh.points.push_back(other.points[v]);
    }
  }
  for (auto face : other.polygons) {
    for (Id& v : face) v = names[v];
    mesh.polygons.push_back(std::move(face));
  }
}

/// A small copy of a mesh, its vertex `v` near `at`, away from the middle of where it goes.
TaggedMesh beside(TaggedMesh mesh, Id v, const Point& at) {
  const Point from = mesh.points[v];
  const double size =
      std::max(0.1, std::hypot(at[0], at[1], at[2])) * std::max(0.1, std::hypot(from[0], from[1], from[2]));
  const double side = from[0] * at[0] + from[1] * at[1] + from[2] * at[2] > 0.3 * size ? -0.5 : 0.5;
  for (Point& p : mesh.points)
    for (std::size_t x = 0; x < 3; ++x)
      p[x] = at[x] + side * (p[x] - from[x]) * (side < 0 && x == 2 ? -1 : 1);
  return mesh;
}

void make_non_manifold(TaggedMesh& mesh, Connection connection, bool closed, Dice& dice) {
  const auto side_of = [&](const TaggedMesh& m) {
    const auto& face = m.polygons[dice.below(m.polygons.size())];
    const std::size_t k = dice.below(face.size());
    return std::pair{face[k], face[(k + 1) % face.size()]};
  };
  if (connection == Connection::edge && !closed && dice.one_in(2)) {  // a fin on an edge of two faces
    const TaggedMesh before = mesh;
    std::map<std::pair<Id, Id>, int> uses;
    for (const auto& face : before.polygons)
      for (std::size_t k = 0; k < face.size(); ++k) ++uses[std::minmax(face[k], face[(k + 1) % face.size()])];
    for (;;) {
      auto [a, b] = side_of(before);
      if (uses[std::minmax(a, b)] != 2) continue;
      if (dice.one_in(2)) std::swap(a, b);
      const Id next = static_cast<Id>(mesh.points.size());
      const Point &p = before.points[a], &q = before.points[b];
      mesh.points.push_back({p[0] + 0.1, p[1], p[2] + 0.6});
      mesh.points.push_back({q[0] + 0.1, q[1], q[2] + 0.6});
      mesh.polygons.push_back({a, b, next + 1, next});
      return;
    }
  }
  const TaggedMesh other = centred(closed ? closed_shape({}, dice) : open_shape({}, false, dice));
  const auto [a, b] = side_of(mesh);
  const auto [c, d] = side_of(other);
  const Id at = dice.one_in(3) ? 0 : a;
  if (connection == Connection::vertex)
    join(mesh, beside(other, c, mesh.points[at]), {at}, {c});
  else
    join(mesh, beside(other, c, mesh.points[a]), {a, b}, {c, d});
}

/// Edges from vertex to vertex, no vertex twice.
std::vector<Id> random_path(const TaggedMesh& mesh, Id start, std::size_t longest, Dice& dice) {
  std::vector<Id> path{start};
  while (path.size() <= longest) {
    std::vector<Id> next;
    for (const auto& face : mesh.polygons)
      for (std::size_t k = 0; k < face.size(); ++k) {
        const Id a = face[k], b = face[(k + 1) % face.size()];
        for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}})
          if (from == path.back() && std::find(path.begin(), path.end(), to) == path.end())
            next.push_back(to);
      }
    if (next.empty()) break;
    path.push_back(next[dice.below(next.size())]);
  }
  return path;
}

std::vector<char> on_border(const TaggedMesh& mesh) {
  std::map<std::pair<Id, Id>, int> uses;
  for (const auto& face : mesh.polygons)
    for (std::size_t k = 0; k < face.size(); ++k) ++uses[std::minmax(face[k], face[(k + 1) % face.size()])];
  std::vector<char> border(mesh.points.size(), 0);
  for (const auto& [ends, n] : uses)
    if (n == 1) border[ends.first] = border[ends.second] = 1;
  return border;
}

/// Sharp edges at vertices, those at the border and tags taken together.
std::vector<int> sharp_edges(const TaggedMesh& mesh) {
  std::map<std::pair<Id, Id>, int> uses;
  for (const auto& face : mesh.polygons)
    for (std::size_t k = 0; k < face.size(); ++k) ++uses[std::minmax(face[k], face[(k + 1) % face.size()])];
  for (const auto& crease : mesh.creases)
    if (const auto at = uses.find(std::minmax(crease.a, crease.b)); at != uses.end() && crease.sharpness > 0)
      at->second = 1;
  std::vector<int> count(mesh.points.size(), 0);
  for (const auto& [ends, n] : uses)
    if (n != 2) ++count[ends.first], ++count[ends.second];
  return count;
}

void tag(TaggedMesh& mesh, Tags tags, Dice& dice) {
  constexpr double semi[] = {0.3, 0.5, 1, 1.7, 2.5, 3.2};
  const auto vertex = [&] {
    if (dice.one_in(3)) return Id{0};
    const auto& face = mesh.polygons[dice.below(mesh.polygons.size())];
    return face[dice.below(face.size())];
  };
  const auto crease = [&](const std::vector<Id>& path, const std::function<double()>& sharpness) {
    const double all = sharpness();
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      mesh.creases.push_back(
          {path[i], path[i + 1], tags == Tags::chaikin || dice.one_in(4) ? sharpness() : all});
  };
  const auto semi_sharp = [&] { return semi[dice.below(6)]; };
  const auto infinite = [&] { return dice.one_in(2) ? 10.0 : 12.5; };
  switch (tags) {
    case Tags::none:
      return;
    case Tags::sharp:
      for (int i = 0; i < 2; ++i) crease(random_path(mesh, vertex(), 2 + dice.below(4), dice), infinite);
      return;
    case Tags::semi_sharp:
      for (int i = 0; i < 2; ++i) crease(random_path(mesh, vertex(), 1 + dice.below(4), dice), semi_sharp);
      return;
    case Tags::chaikin:
      for (int i = 0; i < 2; ++i)
        crease(random_path(mesh, vertex(), 2 + dice.below(4), dice),
               [&] { return dice.one_in(5) ? infinite() : semi_sharp(); });
      return;
    case Tags::dart: {
      const std::vector<char> border = on_border(mesh);
      for (int attempt = 0; attempt < 200; ++attempt) {
        const Id start = vertex();
        if (border[start]) continue;
        const std::vector<Id> path = random_path(mesh, start, 1 + dice.below(2), dice);
        const TaggedMesh before = mesh;
        crease(path, infinite);
        if (sharp_edges(mesh)[start] == 1 && (mesh.creases.size() > 2 || dice.one_in(2))) return;
        if (sharp_edges(mesh)[start] != 1) mesh = before;
      }
      return;
    }
    case Tags::corner:
      for (Id i = 1 + dice.below(3); i > 0; --i)
        mesh.corners.push_back({vertex(), dice.one_in(2) ? infinite() : semi_sharp()});
      return;
  }
}

double size_of(const TaggedMesh& mesh) {
  Point lower = mesh.points[mesh.polygons[0][0]], upper = lower;
  for (const auto& face : mesh.polygons)
    for (const Id v : face)
      for (std::size_t x = 0; x < 3; ++x) {
        lower[x] = std::min(lower[x], mesh.points[v][x]);
        upper[x] = std::max(upper[x], mesh.points[v][x]);
      }
  return std::max({upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]});
}

bool has_surface(const GroundMesh& made) {
  if (!traits_of(made.scheme).dual)
    return oracle::refine(made.mesh, made.rules, 0).holes.size() < made.mesh.polygons.size();
  return !oracle::sample_dual(made.mesh, oracle::DualScheme::midedge, 0).empty();
}

void make_holes(GroundMesh& made, Dice& dice) {
  for (int attempt = 0; attempt < 50; ++attempt) {
    made.mesh.holes = {dice.below(made.mesh.polygons.size())};
    if (dice.one_in(2)) made.mesh.holes.push_back(dice.below(made.mesh.polygons.size()));
    std::sort(made.mesh.holes.begin(), made.mesh.holes.end());
    made.mesh.holes.erase(std::unique(made.mesh.holes.begin(), made.mesh.holes.end()), made.mesh.holes.end());
    if (has_surface(made)) return;
  }
}

oracle::Placement turned(Dice& dice, const Point& t) {
  if (dice.one_in(6)) return {1, 0, 0, t[0], 0, 1, 0, t[1], 0, 0, 1, t[2]};
  std::normal_distribution<double> normal;
  double w = normal(dice.random), x = normal(dice.random), y = normal(dice.random), z = normal(dice.random);
  const double s = 1 / std::sqrt(w * w + x * x + y * y + z * z);
  w *= s, x *= s, y *= s, z *= s;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),     t[0],
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),     t[1],
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y), t[2]};
}

/// Where this test meets the library's own sort of motion.
Motion motion(const oracle::Placement& place) { return Motion::from_3x4(place); }

}  // namespace

std::size_t value_count(std::size_t factor) { return counts[factor]; }

std::string name_of_value(std::size_t factor, std::size_t value) {
  static const std::array<std::vector<std::string>, factor_count> names{{
      {"closed", "none", "edge only", "edge and corner"},
      {"no holes", "holes"},
      {"manifold", "non-manifold edge", "non-manifold vertex"},
      {"no tags", "sharp", "semi-sharp", "chaikin", "dart", "corner"},
      {"plain triangles", "smooth triangles"},
      {"small valence", "valence 100+"},
      {"loop", "catmark", "doo-sabin", "midedge"},
      {"rows", "tables"},
  }};
  return names[factor][value];
}

bool is_possible(const Choices& choices) {
  const Scheme scheme = scheme_of(choices);
  if (traits_of(scheme).dual && choice<Connection>(choices, Factor::connection) != Connection::manifold)
    return false;
  return scheme == Scheme::catmark || choice<std::uint8_t>(choices, Factor::triangles) == 0;
}

std::set<ValuePair> pairs_of(const PairChoices& row) {
  std::set<ValuePair> pairs;
  for (std::uint8_t i = 0; i < row.size(); ++i)
    for (std::uint8_t j = static_cast<std::uint8_t>(i + 1); j < row.size(); ++j)
      pairs.insert({i, row[i], j, row[j]});
  return pairs;
}

const std::set<ValuePair>& all_pairs() {
  static const std::set<ValuePair> all = [] {
    std::set<ValuePair> pairs;
    for_each_choices([&](const Choices& choices) {
      for (std::uint8_t i = 0; i < factor_count; ++i)
        for (std::uint8_t j = static_cast<std::uint8_t>(i + 1); j < factor_count; ++j)
          for (const std::uint8_t side : {std::uint8_t{0}, static_cast<std::uint8_t>(factor_count)})
            pairs.insert({static_cast<std::uint8_t>(side + i), choices[i],
                          static_cast<std::uint8_t>(side + j), choices[j]});
    });
    for (std::uint8_t i = 0; i < factor_count; ++i)
      for (std::uint8_t j = 0; j < factor_count; ++j)
        for (std::uint8_t x = 0; x < counts[i]; ++x)
          for (std::uint8_t y = 0; y < counts[j]; ++y)
            pairs.insert({i, x, static_cast<std::uint8_t>(factor_count + j), y});
    return pairs;
  }();
  return all;
}

const std::vector<PairChoices>& covering_rows() {
  static const std::vector<PairChoices> rows = [] {
    std::set<ValuePair> left = all_pairs();
    std::vector<PairChoices> list;
    std::mt19937_64 random(11);
    Dice dice{random};
    while (!left.empty()) {
      PairChoices best{};
      std::size_t most = 0;
      for (int attempt = 0; attempt < 200; ++attempt) {
        const PairChoices row = random_row(dice, {});
        const std::set<ValuePair> pairs = pairs_of(row);
        const auto found = static_cast<std::size_t>(std::count_if(
            pairs.begin(), pairs.end(), [&](const ValuePair& pair) { return left.contains(pair); }));
        if (found > most) most = found, best = row;
      }
      if (most == 0) continue;
      for (const ValuePair& pair : pairs_of(best)) left.erase(pair);
      list.push_back(best);
    }
    return list;
  }();
  return rows;
}

std::uint64_t row_count() { return covering_rows().size() + 12; }

GroundMesh make_mesh(const Choices& choices, std::mt19937_64& random) {
  Dice dice{random};
  const auto border = choice<Border>(choices, Factor::border);
  const auto tags = choice<Tags>(choices, Factor::tags);
  const Valence valence = valence_of(choices, dice);
  GroundMesh made;
  made.scheme = scheme_of(choices);
  made.rules.scheme =
      made.scheme == Scheme::loop ? oracle::PrimalScheme::loop : oracle::PrimalScheme::catmull_clark;
  made.rules.boundary = border == Border::none        ? oracle::Boundary::none
                        : border == Border::edge_only ? oracle::Boundary::edge_only
                                                      : oracle::Boundary::edge_and_corner;
  made.rules.chaikin = tags == Tags::chaikin;
  made.rules.smooth_triangles = choice<std::uint8_t>(choices, Factor::triangles) == 1;
  made.rules.clamp_dart_edges = true;
  do {
    const bool wedge = border != Border::none && !traits_of(made.scheme).dual && dice.one_in(3);
    made.mesh =
        centred(border == Border::closed ? closed_shape(valence, dice) : open_shape(valence, wedge, dice));
    if (made.rules.smooth_triangles && made.mesh.polygons[0].size() != 3)
      made.mesh = centred(spindle(5, true));
    if (made.rules.smooth_triangles && border != Border::closed &&
        on_border(made.mesh) == std::vector<char>(made.mesh.points.size(), 0))
      made.mesh = centred(disc(5, 2, false));
    const auto connection = choice<Connection>(choices, Factor::connection);
    if (connection != Connection::manifold)
      make_non_manifold(made.mesh, connection, border == Border::closed, dice);
    if (made.scheme == Scheme::loop) made.mesh = triangulated(made.mesh);
    made.mesh = meshes::shaken(made.mesh, valence.many ? 0.03 : dice.between(0.02, 0.25), random);
    tag(made.mesh, tags, dice);
    if (choice<std::uint8_t>(choices, Factor::holes) == 1) make_holes(made, dice);
  } while (!missing(made, choices).empty());
  const double factor = dice.one_in(3) ? 0.3 : 1;
  for (Point& p : made.mesh.points)
    for (double& x : p) x *= factor;
  return made;
}

std::string missing(const GroundMesh& made, const Choices& choices) {
  const TaggedMesh& mesh = made.mesh;
  std::map<std::pair<Id, Id>, int> uses;
  std::vector<Id> faces(mesh.points.size(), 0);
  bool triangle = false;
  for (const auto& face : mesh.polygons) {
    triangle = triangle || face.size() == 3;
    for (std::size_t k = 0; k < face.size(); ++k) {
      ++uses[std::minmax(face[k], face[(k + 1) % face.size()])];
      ++faces[face[k]];
    }
  }
  const auto count = [&](auto test) { return std::count_if(uses.begin(), uses.end(), test); };
  const bool open = count([](const auto&use) { return use.second == 1; }) > 0,
             odd = count([](const auto&use) { return use.second > 2; }) > 0;
  const bool many = *std::max_element(faces.begin(), faces.end()) >= 100;
  const auto connection = choice<Connection>(choices, Factor::connection);
  const auto tags = choice<Tags>(choices, Factor::tags);
  if (open != (choice<Border>(choices, Factor::border) != Border::closed)) return "border";
  if (mesh.holes.empty() != (choice<std::uint8_t>(choices, Factor::holes) == 0)) return "holes";
  if (odd != (connection == Connection::edge)) return "connection";
  if (many != (choice<std::uint8_t>(choices, Factor::valence) == 1)) return "valence";
  if (made.rules.smooth_triangles && !triangle) return "triangles";
  const auto creases = [&](auto test) {
    return std::any_of(mesh.creases.begin(), mesh.creases.end(), [&](const auto& c) {
      return uses.contains(std::minmax(c.a, c.b)) && test(c.sharpness);
    });
  };
  const auto infinite = [](double s) { return s >= oracle::kInfinitelySharp; };
  const auto finite = [](double s) { return s > 0 && s < oracle::kInfinitelySharp; };
  if (tags == Tags::sharp && !creases(infinite)) return "sharp";
  if ((tags == Tags::semi_sharp || tags == Tags::chaikin) && !creases(finite)) return "semi-sharp";
  if (tags == Tags::corner && mesh.corners.empty()) return "corner";
  if (tags == Tags::dart) {
    const std::vector<int> sharp = sharp_edges(mesh);
    if (std::none_of(sharp.begin(), sharp.end(), [](int n) { return n == 1; })) return "dart";
  }
  return has_surface(made) ? "" : "surface";
}

bool GroundSide::has_many() const { return choices[static_cast<std::size_t>(Factor::valence)] == 1; }

bool GroundSide::is_solid() const {
  return choice<Border>(choices, Factor::border) == Border::closed &&
         choice<Connection>(choices, Factor::connection) != Connection::edge &&
         (choices[static_cast<std::size_t>(Factor::holes)] == 0 || traits_of(made.scheme).dual);
}

BoundMethod GroundSide::bounds() const { return choice<BoundMethod>(choices, Factor::sets); }

PlacedSurface GroundTrial::placed(std::size_t side) const {
  return (*sides)[side].surface->at(motion(places[side]));
}

/// Data shared by the surfaces of some rows.
struct GroundTrials::Shared {
  static constexpr std::uint64_t rows = 30;
  std::uint64_t block = UINT64_MAX;
  std::map<std::tuple<Scheme, int, bool, bool>, std::shared_ptr<oracle::LimitRules>> rules;

  std::shared_ptr<oracle::LimitRules> rules_of(const GroundMesh& made) {
    const oracle::Rules& r = made.rules;
    auto& found = rules[{made.scheme, static_cast<int>(r.boundary), r.chaikin, r.smooth_triangles}];
    if (!found)
      found = !traits_of(made.scheme).dual
                  ? std::make_shared<oracle::LimitRules>(r)
                  : std::make_shared<oracle::LimitRules>(made.scheme == Scheme::midedge
                                                             ? oracle::DualScheme::midedge
                                                             : oracle::DualScheme::doo_sabin);
    return found;
  }
};

GroundTrials::GroundTrials(std::uint64_t of_each_row, bool moving)
    : of_each_row_(of_each_row), moving_(moving), shared_(std::make_unique<Shared>()) {}
GroundTrials::~GroundTrials() = default;

namespace {

// Refits the tree of the first frame in place: the third one has its memory.
void make_moved(GroundSide& side, std::uint64_t row, std::mt19937_64& random) {
  const std::vector<Point3> here = side.surface->mesh().points;
  side.journey = static_cast<Journey>(row % journey_count);
  const std::vector<Point3> start = start_of(*side.journey, here, random);
  MovingSurface moving(*side.surface);
  static_cast<void>(closest_point(moving.move(start), start[0], {.relative = 1e-2}, {.max_splits = 30}));
  moving.move(start);
  side.surface = moving.move(here);
}

}  // namespace

void GroundTrials::make_sides(std::uint64_t row) {
  if (row == made_) return;
  made_ = row;
  if (row / Shared::rows != shared_->block) {
    shared_->block = row / Shared::rows;
    for (GroundSide& side : sides_) side.surface.reset();  // and with them the bounds that they share
    shared_->rules.clear();
  }
  std::mt19937_64 random(0x960d + 7919 * row);
  Dice dice{random};
  const auto& rows = covering_rows();
  const bool solids = row >= rows.size() && (row < row_count() || dice.one_in(6));
  row_ = row < rows.size() ? rows[row] : random_row(dice, solids);
  for (std::size_t side = 0; side < 2; ++side) {
    GroundSide& s = sides_[side];
    std::copy_n(row_.begin() + static_cast<std::ptrdiff_t>(side * factor_count), factor_count,
                s.choices.begin());
    s.made = make_mesh(s.choices, random);
    if (solids && side == 1)
      for (Point& p : s.made.mesh.points)
        for (double& x : p) x *= 0.4;
    s.size = size_of(s.made.mesh);
    SchemeOptions options = options_of(s.made.rules);
    options.scheme = s.made.scheme;
    s.surface = public_surface(control_mesh(s.made.mesh), options, {.bounds = s.bounds()});
    if (moving_) make_moved(s, row + side * (row / journey_count + 1), random);
    s.twin = std::make_unique<oracle::LimitTwin>(s.made.mesh, shared_->rules_of(s.made));
  }
}

GroundTrial GroundTrials::make(std::uint64_t number) {
  make_sides(number / of_each_row_);
  GroundTrial trial;
  trial.number = number;
  trial.sides = &sides_;
  trial.random.seed(0x7a1 + 104729 * number);
  Dice dice{trial.random};
  const double size = trial.size(), reach = (sides_[0].size + sides_[1].size) / 2;
  trial.tolerance = dice.one_in(4) ? 0 : size * dice.size(1e-5, 3e-2);
  trial.margin = dice.one_in(4) ? size * dice.size(1e-5, 3e-2) : 0;
  trial.places[0] = dice.one_in(2) ? oracle::kUnmoved : turned(dice, dice.point(size));
  const auto near = [&](double half) {
    Point p = dice.point(half);
    for (std::size_t x = 0; x < 3; ++x) p[x] += trial.places[0][4 * x + 3];
    return p;
  };
  const std::uint64_t family =
      sides_[0].is_solid() && sides_[1].is_solid() && dice.one_in(2) ? 6 : dice.below(8);
  trial.family = family < 4 ? "grazing" : family < 6 ? "crossing" : family == 6 ? "nested" : "far";
  trial.places[1] = turned(dice, near(family < 4    ? reach
                                      : family < 6  ? 0.5 * reach
                                      : family == 6 ? 0.1 * size
                                                    : 100 * reach));
  oracle::ContactGoal goal;
  goal.effort = long_check() ? 800 : 300;
  goal.precision = {std::max(0.1 * trial.tolerance, 1e-5 * size), 1e-2};
  const auto bounds = [&] {
    return contact_bounds(*sides_[0].twin, trial.places[0], *sides_[1].twin, trial.places[1], goal);
  };
  if (family < 4) {
    // Together, or apart, until they are as far from each other as the tolerance, or a third or three times
    // that.
    const double target = std::max(trial.tolerance, 1e-5 * size) * dice.size(0.3, 3);
    for (int step = 0; step < 6; ++step) {
      oracle::ContactGoal rough = goal;
      rough.effort = long_check() ? 400 : 100;
      rough.precision = {0.1 * target, 0.03};
      const oracle::ContactBounds found =
          contact_bounds(*sides_[0].twin, trial.places[0], *sides_[1].twin, trial.places[1], rough);
      if (found.upper > 0.3 * target && found.upper < 3 * target && found.lower > 0) break;
      const bool apart = found.lower > 0;
      Point way{};
      double length = 0;
      for (std::size_t x = 0; x < 3; ++x) {
        way[x] =
            apart ? found.on_b[x] - found.on_a[x] : trial.places[1][4 * x + 3] - trial.places[0][4 * x + 3];
        length += way[x] * way[x];
      }
      length = std::sqrt(length);
      if (!(length > 0)) break;
      const double move = apart ? target - length : 0.4 * size;
      for (std::size_t x = 0; x < 3; ++x) trial.places[1][4 * x + 3] += move * way[x] / length;
    }
  }
  trial.truth = bounds();
  return trial;
}

std::string describe(const GroundTrial& trial) {
  if (const char* folder = std::getenv("SNUG_DUMP")) {
    for (std::size_t side = 0; side < 2; ++side) {
      const GroundMesh& made = (*trial.sides)[side].made;
      std::ofstream out(std::string(folder) + (side == 0 ? "/a.obj" : "/b.obj"));
      out.precision(17);
      for (const Point& p : made.mesh.points) out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
      for (const auto& face : made.mesh.polygons) {
        out << 'f';
        for (const Id v : face) out << ' ' << v + 1;
        out << '\n';
      }
      for (const auto& c : made.mesh.creases)
        out << "t crease 2/1/0 " << c.a << ' ' << c.b << ' ' << c.sharpness << '\n';
      for (const auto& c : made.mesh.corners)
        out << "t corner 1/1/0 " << c.vertex << ' ' << c.sharpness << '\n';
      for (const Id f : made.mesh.holes) out << "t hole 1/0/0 " << f << '\n';
      if (made.rules.chaikin) out << "t creasemethod 0/0/1 chaikin\n";
      if (made.rules.smooth_triangles) out << "t smoothtriangles 0/0/1 smooth\n";
    }
  }
  std::string text = "trial " + std::to_string(trial.number) + " (" + trial.family + ")";
  for (std::size_t side = 0; side < 2; ++side) {
    text += side == 0 ? "; A:" : "; B:";
    for (std::size_t f = 0; f < factor_count; ++f)
      text += (f == 0 ? " " : ", ") + name_of_value(f, (*trial.sides)[side].choices[f]);
    if (const auto journey = (*trial.sides)[side].journey) text += ", " + name_of(*journey);
    text += ", placed \"";
    for (std::size_t i = 0; i < 12; ++i) {
      char number[40];
      std::snprintf(number, sizeof number, i == 0 ? "%.17g" : " %.17g", trial.places[side][i]);
      text += number;
    }
    text += '"';
  }
  char numbers[160];
  std::snprintf(numbers, sizeof numbers, "; tolerance %.17g, margin %.17g, twin [%.17g, %.17g]",
                trial.tolerance, trial.margin, trial.truth.lower, trial.truth.upper);
  return text + numbers;
}

}  // namespace snug::testing
