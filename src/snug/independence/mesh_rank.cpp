#include <snug/independence/mesh_rank.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <string>

#include <snug/independence/exact_step.h>
#include <snug/independence/exact_surface.h>
#include <snug/independence/flint_memory.h>
#include <snug/independence/surface_rank.h>
#include <snug/independence/zero_proof.h>
#include <snug/run.h>
#include <snug/scheme/rules.h>
#include <support/contract.h>

namespace snug {
namespace {

constexpr std::uint32_t max_order = 1'000'000;  // of roots of unity
constexpr std::size_t max_degree = 64;          // of the field of exact arithmetic
constexpr int max_primes = 48;
constexpr std::uint32_t first_prime_above = std::uint32_t{1} << 30;
constexpr std::uint32_t none = UINT32_MAX;

[[noreturn]] void refuse(const std::string& why) { throw InputError(InputProblem::refused, why); }

void require_size(std::size_t count) {
  if (count <= max_ranked_vertices) return;
  refuse("the rank of a mesh of " + std::to_string(count) + " control points is not computed: " +
         std::to_string(max_ranked_vertices) + " are the most; give a part of it");
}

// Owners without a surface: faces, of dual schemes vertices.
std::vector<bool> owners_without_surface(const ControlMesh& mesh, const RuledMesh& ruled) {
  const Topology& topology = ruled.topology;
  if (!rules_of(ruled.options.scheme).primal) {
    std::vector<bool> without_surface(topology.vertex_count());
    for (std::size_t v = 0; v < without_surface.size(); ++v) {
      without_surface[v] = topology.isolated(VertexId(v)) || topology.on_boundary(VertexId(v));
    }
    return without_surface;
  }
  std::vector<bool> without_surface(topology.face_count());
  for (std::size_t f = 0; f < without_surface.size(); ++f) {
    without_surface[f] =
        ruled.options.boundary == BoundaryRule::none && loses_surface(topology, ruled.sharpness, FaceId(f));
  }
  for (const FaceId f : mesh.tags.holes) without_surface[f.index()] = true;
  return without_surface;
}

std::uint32_t folded(std::uint64_t index, std::uint32_t order) {
  const auto i = static_cast<std::uint32_t>(index % order);
  return std::min(i, order - i);
}

// The same prime with another root: its power `a`.
ModularField conjugate(const ModularField& field, std::uint32_t a) {
  ModularField other = field;
  for (std::uint32_t i = 0; i < other.twice_cosines.size(); ++i) {
    other.twice_cosines[i] = field.twice_cosines[folded(std::uint64_t{a} * i, field.order)];
  }
  return other;
}

std::size_t degree_of(std::uint32_t order) {
  if (order <= 2) return 1;
  std::size_t coprime = 0;
  for (std::uint32_t a = 1; a < order; ++a) coprime += std::gcd(a, order) == 1 ? 1 : 0;
  return coprime / 2;
}

// The kinds that these patches are made of, renumbered, with cosines of the least order that they need.
void keep_kinds_of_patches(ExactSurface& part, const ExactSurface& whole) {
  std::vector<std::uint32_t> names(whole.kinds.size(), none), kept;
  const auto keep = [&](std::uint32_t& kind) {
    std::uint32_t& name = names[kind];
    if (name == none) {
      name = static_cast<std::uint32_t>(kept.size());
      kept.push_back(kind);
    }
    kind = name;
  };
  for (ExactSurface::Patch& patch : part.patches) keep(patch.kind);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    part.kinds.push_back(whole.kinds[kept[k]]);
    for (ExactKind::Child& child : part.kinds[k].children) keep(child.kind);
  }
  const auto for_cosines = [&](const auto& visit) {
    for (ExactKind& kind : part.kinds) {
      for (ExactKind::Child& child : kind.children) {
        for (WeightRow& row : child.rows) {
          for (auto& [i, weight] : row) {
            for (auto& [index, factor] : weight.cosines) visit(index);
          }
        }
      }
    }
  };
  part.order = 1;
  for_cosines([&](std::uint32_t index) {
    part.order = std::lcm(part.order, whole.order / std::gcd(index, whole.order));
  });
  for_cosines([&](std::uint32_t& index) { index /= whole.order / part.order; });
}

// The patches that use these columns, by their new numbers; others are taken as 0.
ExactSurface part_of(const ExactSurface& whole, const std::vector<std::uint32_t>& columns) {
  ExactSurface part{1, {}, {}};
  for (const ExactSurface::Patch& patch : whole.patches) {
    ExactSurface::Patch own{patch.kind, {}};
    bool any = false;
    for (const std::uint32_t c : patch.control) {
      const auto at = std::lower_bound(columns.begin(), columns.end(), c);
      const bool there = at != columns.end() && *at == c;
      own.control.push_back(there ? static_cast<std::uint32_t>(at - columns.begin()) : no_column);
      any = any || there;
    }
    if (any) part.patches.push_back(std::move(own));
  }
  keep_kinds_of_patches(part, whole);
  return part;
}

// Vectors that patches connect, each as the numbers of vectors and all columns they use.
struct Block {
  std::vector<std::size_t> vectors;
  std::vector<std::uint32_t> columns;  // in rising order
};

std::vector<Block> blocks_of(const ExactSurface& surface, const ModularKernel& kernel, std::size_t columns) {
  std::vector<std::uint32_t> parent(columns, none);
  const auto root = [&](std::uint32_t c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  for (const auto& vector : kernel.vectors) {
    for (const auto& [c, x] : vector) parent[c] = c;
  }
  for (const auto& vector : kernel.vectors) {
    for (const auto& [c, x] : vector) parent[root(c)] = root(vector.front().first);
  }
  for (const ExactSurface::Patch& patch : surface.patches) {
    std::uint32_t first = none;
    for (const std::uint32_t c : patch.control) {
      if (parent[c] == none) continue;
      if (first == none) first = c;
      parent[root(c)] = root(first);
    }
  }
  std::map<std::uint32_t, Block> blocks;
  for (std::uint32_t c = 0; c < columns; ++c) {
    if (parent[c] != none) blocks[root(c)].columns.push_back(c);
  }
  for (std::size_t k = 0; k < kernel.vectors.size(); ++k) {
    blocks[root(kernel.free_columns[k])].vectors.push_back(k);
  }
  std::vector<Block> result;
  for (auto& [c, block] : blocks) result.push_back(std::move(block));
  return result;
}

// Numbers known modulo a product of primes: polynomials' coefficients, by vector and column.
class Residues {
 public:
  using Entry = std::vector<std::uint32_t>;
  using Vectors = std::vector<std::map<std::uint32_t, Entry>>;

  void add(const Vectors& vectors, std::uint32_t prime) {
    vectors_.resize(vectors.size());
    const auto inverse = [&] {
      mpz_class result;
      const mpz_class p = prime;
      mpz_invert(result.get_mpz_t(), modulus_.get_mpz_t(), p.get_mpz_t());
      return result;
    }();
    for (std::size_t k = 0; k < vectors.size(); ++k) {
      for (const auto& [c, entry] : vectors[k]) vectors_[k][c].resize(entry.size());
      for (auto& [c, numbers] : vectors_[k]) {
        const auto at = vectors[k].find(c);
        for (std::size_t i = 0; i < numbers.size(); ++i) {
          mpz_class step = ((at == vectors[k].end() ? 0 : at->second[i]) - numbers[i]) * inverse % prime;
          if (step < 0) step += prime;
          numbers[i] += modulus_ * step;
        }
      }
    }
    modulus_ *= prime;
  }

  // The vector of least numerators and denominators; empty where some are not much smaller than the modulus.
  [[nodiscard]] ExactKernelVector::Entries lifted(std::size_t k) const {
    ExactKernelVector::Entries vector;
    for (const auto& [c, numbers] : vectors_[k]) {
      std::vector<mpq_class> value;
      for (const mpz_class& x : numbers) {
        if (!lift(x, value.emplace_back())) return {};
      }
      while (!value.empty() && value.back() == 0) value.pop_back();
      if (!value.empty()) vector.emplace_back(VertexId(c), std::move(value));
    }
    return vector;
  }

 private:
  // By Euclid's algorithm, until the remainder is below the root of the modulus.
  bool lift(const mpz_class& x, mpq_class& out) const {
    mpz_class r0 = modulus_, r1 = x, t0 = 0, t1 = 1;
    while (r1 * r1 > modulus_) {
      const mpz_class q = r0 / r1;
      r0 -= q * r1;
      t0 -= q * t1;
      swap(r0, r1);
      swap(t0, t1);
    }
    if (abs(r1 * t1) * 1024 > modulus_ || gcd(r1, t1) != 1) return false;
    out = mpq_class(t1 < 0 ? mpz_class(-r1) : r1, abs(t1));
    return true;
  }

  mpz_class modulus_ = 1;
  std::vector<std::map<std::uint32_t, std::vector<mpz_class>>> vectors_;
};

// Polynomials of degree < n through values at n points.
class Interpolation {
 public:
  Interpolation(const ModularField& field, std::vector<std::uint32_t> points) : field_(field) {
    const std::size_t n = points.size();
    const auto minus = [&](std::uint32_t x) { return x == 0 ? 0 : field.prime - x; };
    std::vector<std::uint32_t> all{1};  // the product of x - points, the highest power first
    for (const std::uint32_t t : points) {
      all.push_back(0);
      for (std::size_t i = all.size() - 1; i > 0; --i)
        all[i] = field.sum(all[i], field.product(minus(t), all[i - 1]));
    }
    for (const std::uint32_t t : points) {
      std::vector<std::uint32_t> quotient{1};
      for (std::size_t i = 1; i < n; ++i)
        quotient.push_back(field.sum(all[i], field.product(t, quotient.back())));
      std::uint32_t at = 0;
      for (const std::uint32_t x : quotient) at = field.sum(field.product(at, t), x);
      const std::uint32_t scale = field.inverse(at);
      for (std::uint32_t& x : quotient) x = field.product(x, scale);
      std::reverse(quotient.begin(), quotient.end());
      bases_.push_back(std::move(quotient));
    }
  }
  // Adds what a value at a point gives.
  void add(std::size_t point, std::uint32_t value, std::vector<std::uint32_t>& coefficients) const {
    coefficients.resize(bases_.size());
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
      coefficients[i] = field_.sum(coefficients[i], field_.product(value, bases_[point][i]));
    }
  }

 private:
  const ModularField& field_;
  std::vector<std::vector<std::uint32_t>> bases_;
};

// Entries by free column; none: not yet shown to vanish.
using Shown = std::vector<ExactKernelVector::Entries>;

// Lifts vectors, and keeps those that vanish.
void show(const Residues& residues, ZeroProof& proof, const WorkMonitor& monitor, Shown& shown) {
  for (std::size_t k = 0; k < shown.size(); ++k) {
    if (!shown[k].empty()) continue;
    ExactKernelVector::Entries vector = residues.lifted(k);
    ZeroProof::Values values;
    for (const auto& [v, value] : vector) values.emplace_back(v.value(), FieldNumber(value));
    if (!vector.empty() && proof.vanishes(values, monitor)) shown[k] = std::move(vector);
  }
}

bool all_shown(const Shown& shown) {
  return std::none_of(shown.begin(), shown.end(), [](const auto& vector) { return vector.empty(); });
}

Residues::Vectors numbers_of(const ModularKernel& kernel) {
  Residues::Vectors vectors;
  for (const auto& entries : kernel.vectors) {
    auto& vector = vectors.emplace_back();
    for (const auto& [c, x] : entries) vector[c] = {x};
  }
  return vectors;
}

// The kernel of a small part, of as many primes as it takes.
class KernelSearch {
 public:
  KernelSearch(const ExactSurface& surface, std::size_t columns, const WorkMonitor& monitor)
      : surface_(surface),
        columns_(columns),
        monitor_(monitor),
        field_(degree_of(surface.order) <= max_degree ? surface.order : 1),
        proof_(surface, field_) {}

  Shown run() {
    std::uint32_t above = first_prime_above;
    for (int attempt = 0; attempt < max_primes; ++attempt) {
      const ModularField field = modular_field(surface_.order, above);
      above = field.prime;
      const ModularKernel kernel = modular_kernel(surface_, columns_, field, monitor_);
      if (attempt == 0 || kernel.rank > rank_) begin_anew(kernel);
      if (kernel.rank < rank_ || kernel.free_columns != free_columns_) continue;  // an unlucky prime
      numbers_.add(numbers_of(kernel), field.prime);
      show(numbers_, proof_, monitor_, shown_);
      if (all_shown(shown_)) break;
      if (field_.degree() > 1) try_polynomials(kernel.vectors.size(), field);
      if (all_shown(shown_)) break;
    }
    return std::move(shown_);
  }
  [[nodiscard]] std::uint32_t order() const { return field_.order(); }

 private:
  void begin_anew(const ModularKernel& kernel) {
    rank_ = kernel.rank;
    free_columns_ = kernel.free_columns;
    shown_.assign(kernel.vectors.size(), {});
    numbers_ = polynomials_ = {};
  }

  // Each root of unity gives one conjugate of each entry.
  void try_polynomials(std::size_t count, const ModularField& field) {
    std::vector<std::uint32_t> powers, points;
    for (std::uint32_t a = 1; 2 * a < field.order; ++a) {
      if (std::gcd(a, field.order) != 1) continue;
      powers.push_back(a);
      points.push_back(field.twice_cosines[a]);
    }
    const Interpolation interpolation(field, points);
    Residues::Vectors vectors(count);
    for (std::size_t i = 0; i < powers.size(); ++i) {
      const ModularKernel other = modular_kernel(surface_, columns_, conjugate(field, powers[i]), monitor_);
      if (other.free_columns != free_columns_) return;
      for (std::size_t k = 0; k < count; ++k) {
        for (const auto& [c, x] : other.vectors[k]) interpolation.add(i, x, vectors[k][c]);
      }
    }
    polynomials_.add(vectors, field.prime);
    show(polynomials_, proof_, monitor_, shown_);
  }

  const ExactSurface& surface_;
  std::size_t columns_;
  const WorkMonitor& monitor_;
  std::size_t rank_ = 0;
  std::vector<std::uint32_t> free_columns_;
  Shown shown_;
  Residues numbers_, polynomials_;
  RealField field_;
  ZeroProof proof_;
};

// The proved part of a kernel found modulo a prime; nothing if it shows that the prime is unlucky.
std::optional<std::vector<ExactKernelVector>> lifted(const ExactSurface& surface, const ModularKernel& kernel,
                                                     std::uint32_t prime, std::size_t columns,
                                                     const WorkMonitor& monitor) {
  const RealField rational(1);
  ZeroProof proof(surface, rational);
  Shown shown(kernel.vectors.size());
  Residues numbers;
  numbers.add(numbers_of(kernel), prime);
  show(numbers, proof, monitor, shown);
  std::vector<std::uint32_t> orders(shown.size(), 1);
  const std::vector<Block> blocks = blocks_of(surface, kernel, columns);
  std::size_t done = 0;
  for (const Block& block : blocks) {
    monitor.report(0.5 + 0.5 * static_cast<double>(++done) / static_cast<double>(blocks.size()));
    if (std::none_of(block.vectors.begin(), block.vectors.end(),
                     [&](std::size_t k) { return shown[k].empty(); })) {
      continue;
    }
    const ExactSurface part = part_of(surface, block.columns);
    KernelSearch search(part, block.columns.size(), monitor);
    Shown found = search.run();
    if (found.size() < block.vectors.size()) return {};
    // All of them or none: only vectors of one prime are independent by their form.
    if (found.size() > block.vectors.size() || !all_shown(found)) continue;
    for (std::size_t k = 0; k < block.vectors.size(); ++k) {
      for (auto& [v, value] : found[k]) v = VertexId(block.columns[v.index()]);
      shown[block.vectors[k]] = std::move(found[k]);
      orders[block.vectors[k]] = search.order();
    }
  }
  std::vector<ExactKernelVector> result;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    if (shown[k].empty()) continue;
    const bool numbers_alone = std::all_of(shown[k].begin(), shown[k].end(),
                                           [](const auto& entry) { return entry.second.size() == 1; });
    result.push_back({numbers_alone ? 1 : orders[k], std::move(shown[k])});
  }
  return result;
}

MeshRank rank_of(const ExactSurface& surface, std::size_t columns, const WorkMonitor& monitor) {
  MeshRank result;
  result.dimension = columns;
  result.root_order = surface.order;
  std::uint32_t above = first_prime_above;
  for (int attempt = 0; attempt < max_primes; ++attempt) {
    const ModularField field = modular_field(surface.order, above);
    above = field.prime;
    const ModularKernel kernel = modular_kernel(surface, columns, field, monitor);
    if (attempt > 0 && kernel.rank <= result.least) continue;
    result.least = kernel.rank;
    result.prime = field.prime;
    result.root = field.root;
    auto vectors = lifted(surface, kernel, field.prime, columns, monitor);
    if (!vectors) continue;
    result.vectors = std::move(*vectors);
    break;
  }
  result.most = columns - result.vectors.size();
  return result;
}

}  // namespace

MeshRank mesh_rank(const ControlMesh& mesh, const SchemeOptions& options, const WorkMonitor& monitor) {
  const FlintMemory memory;
  const SchemeOptions how = with_tags(options, mesh.tags);
  const SchemeRules& rules = rules_of(how.scheme);
  SNUG_EXPECT(!rules.local);
  require_size(mesh.vertex_count());
  const Topology topology = require_surface(mesh, how);
  const Sharpness sharpness = rules.primal ? sharpness_of(mesh, topology) : Sharpness{};
  const RuledMesh ruled{topology, how, sharpness};
  const std::uint32_t order = order_of_masks(ruled, 1, max_order);
  if (order == 0) {
    refuse(
        "the rank of the mesh is not computed: the least common multiple of its valences exceeds a million; "
        "give a part of it");
  }
  const ExactSurface surface = exact_surface(ruled, owners_without_surface(mesh, ruled), order, monitor);
  return rank_of(surface, mesh.vertex_count(), monitor);
}

}  // namespace snug
