#include <snug/independence/cases.h>

#include <algorithm>
#include <charconv>
#include <deque>
#include <numeric>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include <snug/independence/flint_memory.h>
#include <snug/independence/null_space.h>
#include <snug/independence/steps.h>
#include <support/contract.h>
#include <support/error.h>
#include <support/names.h>

namespace snug {
namespace {

using Kind = IndependenceDomain::Kind;
constexpr auto kind_names = std::to_array<Named<Kind>>({
    {"piece", Kind::piece},
    {"pieces", Kind::pieces},
    {"ring", Kind::ring},
    {"rings", Kind::rings},
    {"omega", Kind::omega},
    {"annulus", Kind::annulus},
    {"global", Kind::global},
});

PolynomialVector sparse(const ExactVector& v) {
  PolynomialVector result;
  for (std::uint32_t i = 0; i < v.size(); ++i) {
    if (v[i] != 0) result[i] = {v[i]};
  }
  return result;
}

// The rank on a domain as functions are added.
class DomainRank {
 public:
  DomainRank(const ModularField& field, std::uint32_t columns) : rank_(field, columns) {}

  void add(Steps& part, const std::vector<Functional>& functionals, std::uint32_t before) {
    for (const Functional& functional : functionals) {
      functions_.push_back({&part, before, functional});
      // Common points of two pieces.
      if (!known_.emplace(&part, before, functional).second) continue;
      if (rank_.add(part.image(functional, before))) independent_.push_back(functions_.back());
    }
  }
  void add_ring(Steps& part, std::uint32_t before) {
    for (const auto& piece : part.step().pieces) add(part, piece, before);
  }

  [[nodiscard]] std::uint32_t rank() const { return rank_.rank(); }
  [[nodiscard]] std::size_t count() const { return known_.size(); }
  [[nodiscard]] const std::vector<DomainFunction>& functions() const { return functions_; }
  [[nodiscard]] const std::vector<DomainFunction>& independent() const { return independent_; }

 private:
  ModularRank rank_;
  std::vector<DomainFunction> functions_, independent_;
  std::set<std::tuple<const Steps*, std::uint32_t, Functional>> known_;
};

std::vector<ExactVector> exact_kernel(const std::vector<DomainFunction>& functions,
                                      std::vector<ExactVector> rows, std::size_t columns) {
  for (const DomainFunction& f : functions) rows.push_back(f.part->exact(f.functional, f.before));
  return null_space(rows, columns);
}

// 2 cos(2 pi j / n) as a polynomial in t = 2 cos(2 pi / n): Dickson's.
std::vector<mpq_class> cosine_polynomial(std::uint32_t j) {
  std::vector<mpq_class> before{2}, now{0, 1};
  if (j == 0) return before;
  for (std::uint32_t i = 1; i < j; ++i) {
    std::vector<mpq_class> next(now.size() + 1);
    for (std::size_t k = 0; k < now.size(); ++k) next[k + 1] = now[k];
    for (std::size_t k = 0; k < before.size(); ++k) next[k] -= before[k];
    before = std::exchange(now, std::move(next));
  }
  return now;
}

// Doo-Sabin: vertices of a face that the piece does not see, in combinations that have no mean and no first harmonic:
// those of (z - 1)(z^2 - t z + 1), t = 2 cos(2 pi / n). A step multiplies them by 1/4.
void add_unseen_combinations(const std::vector<std::uint32_t>& unseen, const std::vector<mpq_class>& t,
                             std::vector<PolynomialVector>& kernel) {
  std::vector<mpq_class> one_and_t = t, opposite;
  one_and_t[0] += 1;
  for (const mpq_class& x : one_and_t) opposite.push_back(-x);
  for (std::size_t i = 0; i + 3 < unseen.size(); ++i) {
    kernel.push_back(
        {{unseen[i], {-1}}, {unseen[i + 1], one_and_t}, {unseen[i + 2], opposite}, {unseen[i + 3], {1}}});
  }
}

std::vector<std::uint32_t> range(std::uint32_t begin, std::uint32_t end) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = begin; i < end; ++i) numbers.push_back(i);
  return numbers;
}

// At a boundary all weights are rational.
std::uint32_t order_of(const PieceCorners& corners) {
  if (corners.boundary) return 1;
  return corners.second ? std::lcm(corners.valence, *corners.second) : corners.valence;
}

std::vector<IndependenceDomain> domains_of_ring_1() {
  return {{Kind::piece, 1},     {Kind::piece, 2},     {Kind::piece, 3},
          {Kind::pieces, 1, 2}, {Kind::pieces, 1, 3}, {Kind::pieces, 2, 3}};
}

// All domains of a piece with these corners.
class PieceCases {
 public:
  PieceCases(const ExactScheme& scheme, const PieceCorners& corners, ModularField field, WorkMonitor monitor)
      : scheme_(scheme), corners_(corners), monitor_(std::move(monitor)), field_(std::move(field)) {
    if (corners_.boundary) {
      parts_.emplace_back(boundary_step(scheme_, corners_.valence, *corners_.boundary), field_);
    } else if (!corners_.second) {
      parts_.emplace_back(piece_step(scheme_, corners_.valence), field_);
    } else {
      TwoCornerStep split = two_corner_step(scheme_, corners_, field_.order);
      const std::uint32_t columns = split.step.dimension;
      parts_.emplace_back(std::move(split.step), field_);
      for (TwoCornerStep::Part& part : split.parts) {
        parts_.emplace_back(piece_step(scheme_, part.valence, field_.order), field_, std::move(part.net),
                            columns);
      }
    }
    rings_.emplace(field_, columns());
  }

  // Nothing where no kernel meets the rank: modulo an unlucky prime that is too low.
  std::optional<IndependenceCase> answer(const IndependenceRequest& request) {
    monitor_.checkpoint();
    IndependenceCase found;
    found.corners = corners_;
    found.domain = request.domain;
    found.statement = request.statement;
    found.text = request.text;
    found.certificate.prime = field_.prime;
    if (!corners_.boundary) found.certificate.root = field_.root;
    if (!conclude_on(request.domain, found)) return std::nullopt;
    return found;
  }

  // So many rings have the rank of all. With one corner: once the next adds nothing, no more does. With two: no more than
  // distinguish both parts, each alone.
  std::uint32_t rings_that_count() {
    std::uint32_t k = 1;
    if (!corners_.second) {
      while (rank_of_rings(k + 1) != rank_of_rings(k)) ++k;
      return k;
    }
    std::uint32_t last = 1;
    for (const std::uint32_t n : {corners_.valence, *corners_.second}) {
      last = std::max(last, 1 + PieceCases(scheme_, {n}, modular_field(n), monitor_).rings_that_count());
    }
    while (rank_of_rings(k) != rank_of_rings(last)) ++k;
    return k;
  }

 private:
  [[nodiscard]] std::uint32_t columns() const { return parts_[0].columns(); }

  bool conclude_on(const IndependenceDomain& asked, IndependenceCase& found) {
    if (asked.kind == Kind::annulus) return around(found);
    if (asked.kind == Kind::global) return closed(found);
    DomainRank domain(field_, columns());
    switch (asked.kind) {
      case Kind::omega: {
        const std::uint32_t k = rings_that_count();
        for (std::uint32_t ring = 1; ring <= k; ++ring) add_ring(domain, ring);
        return conclude(found, domain) && conclude_for_all_rings(found, k);
      }
      case Kind::rings:
        for (std::uint32_t ring = 1; ring <= asked.first && domain.rank() < columns(); ++ring)
          add_ring(domain, ring);
        break;
      case Kind::ring:
        add_ring(domain, asked.first);
        break;
      default:
        domain.add(parts_[0], parts_[0].step().pieces[asked.first - 1], 0);
        if (asked.kind == Kind::pieces) domain.add(parts_[0], parts_[0].step().pieces[asked.second - 1], 0);
    }
    return conclude(found, domain);
  }

  // Of two corners ring 1 is that of the piece, ring k + 1 is ring k of both parts.
  void add_ring(DomainRank& domain, std::uint32_t k) {
    if (!corners_.second) {
      domain.add_ring(parts_[0], k - 1);
    } else if (k == 1) {
      domain.add_ring(parts_[0], 0);
    } else {
      domain.add_ring(parts_[1], k - 2);
      domain.add_ring(parts_[2], k - 2);
    }
  }
  std::uint32_t rank_of_rings(std::uint32_t k) {
    while (ranks_.size() < k) {
      monitor_.checkpoint();
      add_ring(*rings_, static_cast<std::uint32_t>(ranks_.size()) + 1);
      ranks_.push_back(rings_->rank());
    }
    return ranks_[k - 1];
  }

  // Vectors that are as many as is missing, and whose functions vanish. Those of one part together, by steps.
  bool accept(IndependenceCase& found, const std::vector<ExactVector>& vectors,
              std::vector<DomainFunction> functions, std::uint32_t left_out) {
    if (vectors.size() != found.dimension - found.rank + left_out) return false;
    std::stable_sort(functions.begin(), functions.end(),
                     [](const DomainFunction& a, const DomainFunction& b) {
                       return std::pair(a.part, a.before) < std::pair(b.part, b.before);
                     });
    for (const ExactVector& v : vectors) {
      monitor_.checkpoint();
      if (!vanishes(v, functions)) return false;
    }
    found.certificate.left_out = left_out;
    for (const ExactVector& v : vectors) found.certificate.kernel.push_back(sparse(v));
    return true;
  }

  // Why the rank is no greater: it is full, there are no more functions, or there is a kernel.
  bool conclude(IndependenceCase& found, const DomainRank& domain) {
    found.dimension = domain.functions().front().part->columns();
    found.rank = domain.rank();
    RankCertificate& why = found.certificate;
    if (found.independent()) return true;
    const std::size_t count = scheme_.scheme == Scheme::midedge ? domain.functions().size() : domain.count();
    if (found.rank == count && !corners_.second) {
      why.bound = RankCertificate::Bound::count;
      return true;
    }
    why.bound = RankCertificate::Bound::kernel;
    std::vector<ExactVector> conditions;
    if (scheme_.scheme == Scheme::loop) conditions = domain.functions().front().part->corner_conditions();
    if (accept(found, exact_kernel(domain.independent(), conditions, found.dimension), domain.functions(), 0))
      return true;
    // Without the rows that are irrational, where all are of the first step.
    std::vector<DomainFunction> rational;
    std::set<Functional> others;
    for (const DomainFunction& f : domain.functions()) {
      const auto& rows = f.part->step().rows;
      if (std::all_of(f.functional.begin(), f.functional.end(),
                      [&](const auto& x) { return is_rational(rows[x.first]); })) {
        rational.push_back(f);
      } else {
        others.insert(f.functional);
      }
    }
    const DomainFunction& last = domain.functions().back();
    if (last.before == 0 && last.part == domain.functions().front().part &&
        accept(found, exact_kernel(rational, {}, found.dimension), rational,
               static_cast<std::uint32_t>(others.size()))) {
      return true;
    }
    return scheme_.scheme == Scheme::doo_sabin && add_unseen(found);
  }
  // Doo-Sabin's kernel on all rings; false where more than it vanishes.
  bool add_unseen(IndependenceCase& found) const {
    std::vector<PolynomialVector>& kernel = found.certificate.kernel;
    kernel.clear();
    const std::uint32_t n = corners_.valence;
    if (!corners_.second) {
      add_unseen_combinations(range(2, n - 1), cosine_polynomial(1), kernel);
    } else {
      // After the vertex and its neighbours, face by face; regular faces have one point each.
      const std::uint32_t m = *corners_.second, first = 5,
                          second = first + n - 3 + (corners_.opposite ? 1 : 0);
      add_unseen_combinations(range(first, first + n - 3), cosine_polynomial(field_.order / n), kernel);
      add_unseen_combinations(range(second, second + m - 3), cosine_polynomial(field_.order / m), kernel);
    }
    found.certificate.left_out = 0;
    return kernel.size() == found.dimension - found.rank;
  }

  // Functions that vanish on all rings: each vector is multiplied by a number at each step, of each part.
  bool conclude_for_all_rings(IndependenceCase& found, std::uint32_t rings) {
    RankCertificate& why = found.certificate;
    why.rings = rings;
    if (found.independent()) return true;
    why.bound = RankCertificate::Bound::kernel;
    if (scheme_.scheme == Scheme::doo_sabin) {
      why.factor = mpq_class(1, 4);
      return add_unseen(found);
    }
    for (const PolynomialVector& sparse_vector : why.kernel) {
      ExactVector v(found.dimension);
      for (const auto& [point, value] : sparse_vector) v[point] = value[0];
      for (std::size_t part = corners_.second ? 1 : 0; part < parts_.size(); ++part) {
        const auto values = parts_[part].at_base(v);
        if (!values) return false;
        if (std::all_of(values->begin(), values->end(), [](const mpq_class& x) { return x == 0; })) continue;
        const auto factor = parts_[part].factor(*values);
        if (!factor || (why.factor && why.factor != factor)) return false;
        why.factor = factor;
      }
    }
    if (!why.factor) why.factor = 0;
    return !why.kernel.empty();
  }

  bool around(IndependenceCase& found) {
    Steps steps(annulus_step(scheme_, corners_.valence), field_);
    DomainRank domain(field_, steps.columns());
    domain.add_ring(steps, 0);
    return conclude(found, domain);
  }

  // All control points after two steps.
  bool closed(IndependenceCase& found) {
    const std::uint32_t n = corners_.valence;
    const NetPart net = closed_net(scheme_, n);
    RefinedNet once = refine(net, scheme_, n);
    Steps steps(mesh_step(refine(once.net, scheme_, n), once.net.points), field_, std::move(once.rows),
                net.points);
    std::vector<Functional> points;
    for (std::uint32_t p = 0; p < steps.step().rows.size(); ++p) points.push_back({{p, 1}});
    DomainRank domain(field_, net.points);
    domain.add(steps, points, 0);
    found.certificate.steps = 2;
    return conclude(found, domain);
  }

  ExactScheme scheme_;
  PieceCorners corners_;
  WorkMonitor monitor_;
  ModularField field_;
  std::deque<Steps> parts_;  // the piece; with two corners also what the first step leaves at each
  std::optional<DomainRank> rings_;
  std::vector<std::uint32_t> ranks_;  // on rings 1 to k + 1
};

std::optional<std::uint32_t> parse_count(const std::string& text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number == 0) return std::nullopt;
  return number;
}

}  // namespace

std::string name_of(const IndependenceDomain& domain) {
  std::string name = name_in(kind_names, domain.kind);
  if (domain.kind >= Kind::omega) return name;
  name += ":" + std::to_string(domain.first);
  if (domain.kind == Kind::pieces) name += "," + std::to_string(domain.second);
  return name;
}

std::optional<IndependenceDomain> parse_domain(const std::string& text) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto kind = value_in(kind_names, text.substr(0, colon));
  if (!kind) return std::nullopt;
  if (*kind >= Kind::omega)
    return colon == text.size() ? std::optional(IndependenceDomain{*kind}) : std::nullopt;
  if (colon == text.size()) return std::nullopt;
  const std::string numbers = text.substr(colon + 1);
  const std::size_t comma = std::min(numbers.find(','), numbers.size());
  const auto first = parse_count(numbers.substr(0, comma));
  if (!first || (*kind == Kind::pieces) != (comma < numbers.size())) return std::nullopt;
  IndependenceDomain domain{*kind, *first};
  if (*kind == Kind::pieces) {
    const auto second = parse_count(numbers.substr(comma + 1));
    if (!second || *second > 3 || *first >= *second) return std::nullopt;
    domain.second = *second;
  }
  if (*kind == Kind::piece && *first > 3) return std::nullopt;
  return domain;
}

IndependenceRequest chapter_request(const ExactScheme& scheme, std::uint32_t n,
                                    const IndependenceDomain& domain) {
  // n from `from` to `to`; first, second: of the domain, 0 for any.
  struct Statement {
    Kind kind;
    std::uint32_t first, from, to;
    const char* name;
    bool independent;
  };
  constexpr std::uint32_t any = UINT32_MAX;
  static constexpr auto of_loop = std::to_array<Statement>({
      {Kind::piece, 0, 3, 6, "lemma 3", true},
      {Kind::piece, 0, 7, 7, "p. 24", false},
      {Kind::pieces, 0, 7, 7, "p. 24", false},
      {Kind::rings, 1, 3, 6, "lemma 3", true},
      {Kind::rings, 1, 7, 7, "p. 24", true},
      {Kind::rings, 1, 8, any, "lemma 2", false},
      {Kind::omega, 0, 3, any, "theorem 1", true},
      {Kind::annulus, 0, 3, any, "lemma 1", true},
      {Kind::global, 0, 3, any, "corollary 1", true},
  });
  static constexpr auto of_catmark = std::to_array<Statement>({
      {Kind::piece, 0, 4, 4, "lemma 8", true},
      {Kind::piece, 0, 5, 5, "lemma 8", false},
      {Kind::pieces, 0, 5, 5, "lemma 8", true},
      {Kind::ring, 2, 3, 3, "lemma 8", false},
      {Kind::rings, 1, 3, 5, "lemma 8", true},
      {Kind::rings, 1, 6, any, "lemma 8", false},
      {Kind::omega, 0, 3, any, "theorem 2", true},
      {Kind::annulus, 0, 3, any, "lemma 7", true},
      {Kind::global, 0, 3, 3, "lemma 6", false},
      {Kind::global, 0, 4, any, "p. 32", true},
  });
  static constexpr auto of_older = std::to_array<Statement>({
      {Kind::piece, 0, 3, 3, "p. 33", true},
      {Kind::ring, 2, 3, 3, "p. 33", true},
      {Kind::rings, 1, 3, 3, "p. 33", true},
  });
  std::span<const Statement> statements;
  if (scheme.scheme == Scheme::loop) statements = of_loop;
  if (scheme.scheme == Scheme::catmark) statements = of_catmark;
  if (scheme.older_vertices) statements = of_older;

  IndependenceRequest request{domain, "", std::nullopt};
  const auto add = [&](const char* name, bool independent) {
    if (!request.statement.empty()) request.statement += ", ";
    request.statement += name;
    request.text = independent;
  };
  for (const Statement& each : statements) {
    if (each.kind == domain.kind && (each.first == 0 || each.first == domain.first) && each.from <= n &&
        n <= each.to) {
      add(each.name, each.independent);
    }
  }
  if (const std::uint32_t k = conjectured_rings(scheme, n); k > 0 && domain.kind == Kind::rings) {
    const char* name = scheme.scheme == Scheme::loop ? "conjecture 1" : "conjecture 2";
    if (domain.first == k - 1) add(name, false);
    if (domain.first == k) add(name, true);
  }
  return request;
}

std::uint32_t conjectured_rings(const ExactScheme& scheme, std::uint32_t n) {
  if (scheme.scheme == Scheme::loop && n >= 8) return (n - 6) / 2 + 1;
  return scheme.scheme == Scheme::catmark && !scheme.older_vertices && n >= 6 ? n - 4 : 0;
}

std::vector<IndependenceDomain> chapter_domains(const ExactScheme& scheme, std::uint32_t n) {
  std::vector<IndependenceDomain> all = domains_of_ring_1();
  if (scheme.scheme == Scheme::catmark && n == 3) all.push_back({Kind::ring, 2});
  const std::uint32_t rings = PieceCases(scheme, {n}, modular_field(n), {}).rings_that_count();
  for (std::uint32_t k = 1; k <= rings; ++k) all.push_back({Kind::rings, k});
  all.insert(all.end(), {{Kind::omega}, {Kind::annulus}, {Kind::global}});
  return all;
}

std::vector<IndependenceDomain> boundary_domains(const ExactScheme& scheme, const PieceCorners& corners) {
  std::vector<IndependenceDomain> all = domains_of_ring_1();
  const std::uint32_t rings = PieceCases(scheme, corners, modular_field(1), {}).rings_that_count();
  for (std::uint32_t k = 1; k <= rings; ++k) all.push_back({Kind::rings, k});
  all.push_back({Kind::omega});
  return all;
}

std::vector<IndependenceDomain> two_corner_domains(const ExactScheme& scheme, const PieceCorners& corners) {
  std::vector<IndependenceDomain> all;
  const std::uint32_t rings =
      PieceCases(scheme, corners, modular_field(order_of(corners)), {}).rings_that_count();
  for (std::uint32_t k = 1; k <= rings; ++k) all.push_back({Kind::rings, k});
  all.push_back({Kind::omega});
  return all;
}

std::vector<IndependenceCase> independence_cases(const ExactScheme& scheme, const PieceCorners& corners,
                                                 const std::vector<IndependenceRequest>& requests,
                                                 const WorkMonitor& monitor, std::uint32_t min_prime) {
  SNUG_EXPECT(corners.boundary || corners.valence >= 3);
  const FlintMemory memory;
  constexpr int max_primes = 20;
  std::uint32_t above = min_prime;
  std::optional<PieceCases> all;
  std::vector<IndependenceCase> cases;
  cases.reserve(requests.size());
  for (const IndependenceRequest& request : requests) {
    std::optional<IndependenceCase> found;
    for (int primes = 0; !found; ++primes) {
      if (primes == max_primes) {
        throw InputError(InputProblem::refused,
                         "independence: no certificate was found for " + name_of(request.domain) +
                             " at valence " + std::to_string(corners.valence) + "; ask about another domain");
      }
      if (primes > 0 || !all) {
        ModularField field = modular_field(order_of(corners), above);
        above = field.prime;
        all.emplace(scheme, corners, std::move(field), monitor);
      }
      found = all->answer(request);
    }
    cases.push_back(std::move(*found));
  }
  return cases;
}

}  // namespace snug
