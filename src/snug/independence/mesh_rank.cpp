#include <snug/independence/mesh_rank.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <string>

#include <snug/base/contract.h>
#include <snug/error.h>
#include <snug/independence/exact_step.h>
#include <snug/independence/exact_surface.h>
#include <snug/independence/flint_memory.h>
#include <snug/independence/surface_rank.h>
#include <snug/independence/zero_proof.h>
#include <snug/scheme/rules.h>

namespace snug {
namespace {

constexpr std::uint32_t max_order = 1'000'000;  // of roots of unity
constexpr std::size_t max_degree = 48;          // of the field of exact arithmetic
constexpr int max_primes = 48;

[[noreturn]] void refuse(const std::string& why) { throw InputError(InputProblem::refused, why); }

void require_size(std::size_t count) {
  if (count <= max_ranked_vertices) return;
  refuse("the rank of a mesh of " + std::to_string(count) + " control points is not computed: " +
         std::to_string(max_ranked_vertices) + " are the most; give a part of it");
}

// Owners without a surface: faces, of dual schemes vertices.
std::vector<bool> bare_owners(const ControlMesh& mesh, const RuledMesh& ruled) {
  const Topology& topology = ruled.topology;
  if (!rules_of(ruled.options.scheme).primal) {
    std::vector<bool> bare(topology.vertex_count());
    for (std::size_t v = 0; v < bare.size(); ++v) {
      bare[v] = topology.isolated(VertexId(v)) || topology.on_boundary(VertexId(v));
    }
    return bare;
  }
  std::vector<bool> bare(topology.face_count());
  for (std::size_t f = 0; f < bare.size(); ++f) {
    bare[f] = ruled.options.boundary == BoundaryRule::none && loses_surface(topology, ruled.sharpness, FaceId(f));
  }
  for (const FaceId f : mesh.tags.holes) bare[f.index()] = true;
  return bare;
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

// The order of the cosines that these kernel vectors meet.
std::uint32_t order_met(const ExactSurface& surface, const ModularKernel& kernel, std::size_t columns) {
  std::vector<bool> met(columns, false), reached(surface.kinds.size(), false);
  for (const auto& vector : kernel.vectors) {
    for (const auto& [c, x] : vector) met[c] = true;
  }
  std::vector<std::uint32_t> waiting;
  const auto reach = [&](std::uint32_t kind) {
    if (!reached[kind]) waiting.push_back(kind);
    reached[kind] = true;
  };
  for (const ExactSurface::Patch& patch : surface.patches) {
    if (std::any_of(patch.control.begin(), patch.control.end(), [&](std::uint32_t c) { return met[c]; })) {
      reach(patch.kind);
    }
  }
  std::uint32_t order = 1;
  while (!waiting.empty()) {
    const ExactKind& kind = surface.kinds[waiting.back()];
    waiting.pop_back();
    for (const ExactKind::Child& child : kind.children) {
      reach(child.kind);
      for (const WeightRow& row : child.rows) {
        for (const auto& [i, weight] : row) {
          for (const auto& [index, factor] : weight.cosines) {
            order = std::lcm(order, surface.order / std::gcd(index, surface.order));
          }
        }
      }
    }
  }
  return order;
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
  [[nodiscard]] ExactKernelVector lifted(std::size_t k) const {
    ExactKernelVector vector;
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
      for (std::size_t i = all.size() - 1; i > 0; --i) all[i] = field.sum(all[i], field.product(minus(t), all[i - 1]));
    }
    for (const std::uint32_t t : points) {
      std::vector<std::uint32_t> quotient{1};
      for (std::size_t i = 1; i < n; ++i) quotient.push_back(field.sum(all[i], field.product(t, quotient.back())));
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

class Search {
 public:
  Search(const ExactSurface& surface, std::size_t columns, const WorkMonitor& monitor)
      : surface_(surface), monitor_(monitor) {
    result_.dimension = columns;
    result_.root_order = surface.order;
  }

  MeshRank run() {
    std::uint32_t above = std::uint32_t{1} << 30;
    for (int attempt = 0; attempt < max_primes; ++attempt) {
      const ModularField field = modular_field(surface_.order, above);
      above = field.prime;
      const ModularKernel kernel = modular_kernel(surface_, result_.dimension, field, monitor_);
      if (attempt == 0 || kernel.rank > result_.least) begin_anew(kernel, field);
      if (kernel.rank < result_.least || kernel.free_columns != free_columns_) continue;  // an unlucky prime
      if (all_shown() || try_numbers(kernel, field) || try_polynomials(kernel, field)) break;
      monitor_.report(static_cast<double>(attempt + 1) / max_primes);
    }
    for (ExactKernelVector& vector : shown_) {
      if (!vector.empty()) result_.vectors.push_back(std::move(vector));
    }
    result_.most = result_.dimension - result_.vectors.size();
    const bool rational = std::all_of(result_.vectors.begin(), result_.vectors.end(), [](const auto& vector) {
      return std::all_of(vector.begin(), vector.end(), [](const auto& entry) { return entry.second.size() == 1; });
    });
    if (!rational) result_.order = exact_->order();
    return std::move(result_);
  }

 private:
  void begin_anew(const ModularKernel& kernel, const ModularField& field) {
    result_.least = kernel.rank;
    result_.prime = field.prime;
    result_.root = field.root;
    free_columns_ = kernel.free_columns;
    shown_.assign(kernel.vectors.size(), {});
    numbers_ = polynomials_ = {};
    const std::uint32_t order = order_met(surface_, kernel, result_.dimension);
    proof_.reset();
    exact_.emplace(degree_of(order) <= max_degree ? order : 1);
    proof_.emplace(surface_, *exact_);
  }
  [[nodiscard]] bool all_shown() const {
    return std::none_of(shown_.begin(), shown_.end(), [](const auto& vector) { return vector.empty(); });
  }

  // Are all vectors shown to vanish, with these?
  bool show(const Residues& residues) {
    for (std::size_t k = 0; k < shown_.size(); ++k) {
      if (!shown_[k].empty()) continue;
      ExactKernelVector vector = residues.lifted(k);
      ZeroProof::Values values;
      for (const auto& [v, value] : vector) values.emplace_back(v.value(), FieldNumber(value));
      if (!vector.empty() && proof_->vanishes(values, monitor_)) shown_[k] = std::move(vector);
    }
    return all_shown();
  }

  bool try_numbers(const ModularKernel& kernel, const ModularField& field) {
    Residues::Vectors vectors;
    for (const auto& entries : kernel.vectors) {
      auto& vector = vectors.emplace_back();
      for (const auto& [c, x] : entries) vector[c] = {x};
    }
    numbers_.add(vectors, field.prime);
    return show(numbers_);
  }

  // Each root of unity gives one conjugate of each entry.
  bool try_polynomials(const ModularKernel& kernel, const ModularField& field) {
    const std::uint32_t own = exact_->order(), all = surface_.order;
    const std::size_t degree = exact_->degree();
    if (degree == 1) return false;
    std::vector<std::uint32_t> powers, points, met;
    for (std::uint32_t a = 1; points.size() < degree; ++a) {
      const std::uint32_t name = folded(a, own);
      if (std::gcd(a, all) != 1 || std::find(met.begin(), met.end(), name) != met.end()) continue;
      met.push_back(name);
      powers.push_back(a);
      points.push_back(field.twice_cosines[folded(std::uint64_t{a} * (all / own), all)]);
    }
    const Interpolation interpolation(field, points);
    Residues::Vectors vectors(kernel.vectors.size());
    for (std::size_t i = 0; i < degree; ++i) {
      const ModularKernel other = modular_kernel(surface_, result_.dimension, conjugate(field, powers[i]), monitor_);
      if (other.free_columns != free_columns_) return false;
      for (std::size_t k = 0; k < other.vectors.size(); ++k) {
        for (const auto& [c, x] : other.vectors[k]) interpolation.add(i, x, vectors[k][c]);
      }
    }
    polynomials_.add(vectors, field.prime);
    return show(polynomials_);
  }

  const ExactSurface& surface_;
  const WorkMonitor& monitor_;
  MeshRank result_;
  std::vector<std::uint32_t> free_columns_;
  std::vector<ExactKernelVector> shown_;  // by free column; empty: not yet
  Residues numbers_, polynomials_;
  std::optional<RealField> exact_;
  std::optional<ZeroProof> proof_;
};

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
    refuse("the rank of the mesh is not computed: the least common multiple of its valences exceeds a million; give a part of it");
  }
  const ExactSurface surface = exact_surface(ruled, bare_owners(mesh, ruled), order, monitor);
  return Search(surface, mesh.vertex_count(), monitor).run();
}

}  // namespace snug
