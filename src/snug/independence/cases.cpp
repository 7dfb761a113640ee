#include <snug/independence/cases.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include <snug/base/contract.h>
#include <snug/base/names.h>
#include <snug/independence/modular.h>
#include <snug/independence/null_space.h>
#include <snug/independence/piece_step.h>

namespace snug {
namespace {

using Kind = IndependenceDomain::Kind;
using ModularRow = std::vector<std::uint32_t>;
using ExactVector = std::vector<mpq_class>;

constexpr auto kind_names = std::to_array<Named<Kind>>({
    {"piece", Kind::piece},
    {"pieces", Kind::pieces},
    {"ring", Kind::ring},
    {"rings", Kind::rings},
    {"omega", Kind::omega},
    {"annulus", Kind::annulus},
    {"global", Kind::global},
});

// A function of the domain: a functional of the regular pieces after so many steps, from 0.
struct Function {
  std::uint32_t steps;
  Functional functional;
};

// A row of weights times a vector, where no irrational part is left.
std::optional<mpq_class> rational_product(const WeightRow& row, const ExactVector& v) {
  mpq_class result;
  std::map<std::uint32_t, mpq_class> cosines;
  for (const auto& [point, w] : row) {
    if (v[point] == 0) continue;
    result += w.rational * v[point];
    for (const auto& [index, factor] : w.cosines) cosines[index] += factor * v[point];
  }
  if (std::any_of(cosines.begin(), cosines.end(), [](const auto& c) { return c.second != 0; }))
    return std::nullopt;
  return result;
}

std::optional<ExactVector> rational_product(const std::vector<WeightRow>& rows, std::size_t count,
                                            const ExactVector& v) {
  ExactVector result(count);
  for (std::size_t r = 0; r < count; ++r) {
    const auto value = rational_product(rows[r], v);
    if (!value) return std::nullopt;
    result[r] = *value;
  }
  return result;
}

bool is_rational(const WeightRow& row) {
  return std::all_of(row.begin(), row.end(), [](const auto& entry) { return entry.second.is_rational(); });
}

PolynomialVector sparse(const ExactVector& v) {
  PolynomialVector result;
  for (std::uint32_t i = 0; i < v.size(); ++i) {
    if (v[i] != 0) result[i] = {v[i]};
  }
  return result;
}

// Powers of a step, modulo a prime and exactly.
class Steps {
 public:
  Steps(const ExactScheme& scheme, const PieceStep& step, const ModularField& field)
      : scheme_(scheme), step_(step), field_(field) {
    for (const WeightRow& row : step.rows) {
      images_.emplace_back();
      for (const auto& [point, w] : row) images_.back().emplace_back(point, field.image(w));
    }
    powers_.emplace_back();
    for (std::uint32_t i = 0; i < step.dimension; ++i) {
      powers_[0].emplace_back(step.dimension);
      powers_[0][i][i] = 1;
    }
    rational_ = std::all_of(step.rows.begin(), step.rows.end(), is_rational);
  }

  [[nodiscard]] const PieceStep& step() const { return step_; }
  [[nodiscard]] const ModularField& field() const { return field_; }
  [[nodiscard]] std::uint32_t dimension() const { return step_.dimension; }
  [[nodiscard]] bool rational() const { return rational_; }

  [[nodiscard]] ModularRow image(const Function& f) {
    while (powers_.size() <= f.steps) {
      std::vector<ModularRow> next;
      for (std::uint32_t r = 0; r < step_.kept; ++r) next.push_back(times(images_[r], powers_.back()));
      powers_.push_back(std::move(next));
    }
    ModularRow result(dimension());
    for (const auto& [row, sign] : f.functional) {
      const ModularRow part = times(images_[row], powers_[f.steps]);
      for (std::size_t c = 0; c < result.size(); ++c) {
        result[c] = field_.sum(result[c], sign > 0 || part[c] == 0 ? part[c] : field_.prime - part[c]);
      }
    }
    return result;
  }

  // The row of a function, rational parts of weights alone: right for vectors that have no irrational ones.
  [[nodiscard]] ExactVector exact(const Function& f) const {
    ExactVector row(dimension());
    for (const auto& [r, sign] : f.functional) {
      for (const auto& [point, w] : step_.rows[r]) row[point] += sign * w.rational;
    }
    for (std::uint32_t i = 0; i < f.steps; ++i) {
      ExactVector before(dimension());
      for (std::uint32_t r = 0; r < step_.kept; ++r) {
        if (row[r] == 0) continue;
        for (const auto& [point, w] : step_.rows[r]) before[point] += row[r] * w.rational;
      }
      row = std::move(before);
    }
    return row;
  }

  // Is the vector's function zero in all of these? Exact; false also where irrational parts are left.
  [[nodiscard]] bool vanishes(ExactVector v, const std::vector<Function>& functions) const {
    std::uint32_t steps = 0;
    std::optional<ExactVector> fine;
    for (const Function& f : functions) {  // in the order of steps
      for (; steps < f.steps; ++steps, fine.reset()) {
        auto next = rational_product(step_.rows, step_.kept, v);
        if (!next) return false;
        v = std::move(*next);
      }
      mpq_class value;
      for (const auto& [row, sign] : f.functional) {
        const auto product = rational_product(step_.rows[row], v);
        if (!product) return false;
        value += sign * *product;
      }
      if (value != 0) return false;
    }
    return true;
  }

  // The number that a step multiplies the vector by, if there is one.
  [[nodiscard]] std::optional<mpq_class> factor(const ExactVector& v) const {
    const auto image = rational_product(step_.rows, step_.kept, v);
    if (!image) return std::nullopt;
    std::optional<mpq_class> result;
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (v[i] == 0) {
        if ((*image)[i] != 0) return std::nullopt;
        continue;
      }
      const mpq_class ratio = (*image)[i] / v[i];
      if (result && *result != ratio) return std::nullopt;
      result = ratio;
    }
    return result;
  }

  // What makes Loop's irrational mask vanish: the vertex, and the sum of its neighbours.
  [[nodiscard]] std::vector<ExactVector> gauges() const {
    std::vector<ExactVector> rows;
    if (scheme_.scheme != Scheme::loop) return rows;
    for (const WeightRow& row : step_.rows) {
      if (is_rational(row)) continue;
      ExactVector own(dimension()), others(dimension());
      own[row.front().first] = 1;
      for (std::size_t i = 1; i < row.size(); ++i) others[row[i].first] = 1;
      rows.push_back(std::move(own));
      rows.push_back(std::move(others));
    }
    return rows;
  }

 private:
  using ImageRow = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  [[nodiscard]] ModularRow times(const ImageRow& row, const std::vector<ModularRow>& matrix) const {
    ModularRow result(dimension());
    for (const auto& [r, w] : row) {
      for (std::size_t c = 0; c < result.size(); ++c) {
        result[c] = static_cast<std::uint32_t>((result[c] + std::uint64_t{w} * matrix[r][c]) % field_.prime);
      }
    }
    return result;
  }

  const ExactScheme& scheme_;
  const PieceStep& step_;
  const ModularField& field_;
  std::vector<ImageRow> images_;
  std::vector<std::vector<ModularRow>> powers_;  // of the rows that are kept
  bool rational_ = false;
};

// The rank on a domain as functions are added.
class DomainRank {
 public:
  explicit DomainRank(Steps& steps) : steps_(steps), rank_(steps.field(), steps.dimension()) {}

  void add(const std::vector<Functional>& functionals, std::uint32_t after) {
    for (const Functional& functional : functionals) {
      functions_.push_back({after, functional});
      // Common points of two pieces.
      if (!known_.emplace(after, functional).second) continue;
      if (rank_.add(steps_.image(functions_.back()))) independent_.push_back(functions_.back());
    }
  }
  void add_ring(std::uint32_t after) {
    for (const auto& piece : steps_.step().pieces) add(piece, after);
  }

  [[nodiscard]] std::uint32_t rank() const { return rank_.rank(); }
  [[nodiscard]] std::size_t count() const { return known_.size(); }
  [[nodiscard]] const std::vector<Function>& functions() const { return functions_; }
  [[nodiscard]] const std::vector<Function>& independent() const { return independent_; }

 private:
  Steps& steps_;
  ModularRank rank_;
  std::vector<Function> functions_, independent_;
  std::set<std::pair<std::uint32_t, Functional>> known_;
};

std::vector<ExactVector> exact_kernel(const Steps& steps, const std::vector<Function>& functions,
                                      std::vector<ExactVector> rows) {
  for (const Function& f : functions) rows.push_back(steps.exact(f));
  return null_space(rows, steps.dimension());
}

// Doo-Sabin: the vertices of the face that the piece does not see, in combinations that have no mean and no first
// harmonic: those of (z - 1)(z^2 - t z + 1), t = 2 cos(2 pi / n). A step multiplies them by 1/4.
std::vector<PolynomialVector> unseen_combinations(std::uint32_t n) {
  std::vector<PolynomialVector> kernel;
  for (std::uint32_t j = 2; j + 5 <= n; ++j) {
    kernel.push_back({{j, {-1}}, {j + 1, {1, 1}}, {j + 2, {-1, -1}}, {j + 3, {1}}});
  }
  return kernel;
}

class PieceCases {
 public:
  PieceCases(const ExactScheme& scheme, std::uint32_t n, WorkMonitor monitor)
      : scheme_(scheme),
        n_(n),
        monitor_(std::move(monitor)),
        field_(modular_field(n)),
        step_(piece_step(scheme, n)),
        steps_(scheme_, step_, field_),
        rings_(steps_) {}

  IndependenceCase answer(const IndependenceRequest& request) {
    monitor_.checkpoint();
    IndependenceCase found;
    found.valence = n_;
    found.domain = request.domain;
    found.statement = request.statement;
    found.text = request.text;
    found.certificate.prime = field_.prime;
    found.certificate.root = field_.root;
    switch (request.domain.kind) {
      case Kind::omega:
        whole(found);
        break;
      case Kind::rings:
        first_rings(found);
        break;
      case Kind::annulus:
        around(found);
        break;
      case Kind::global:
        closed(found);
        break;
      default: {
        DomainRank domain(steps_);
        const auto [kind, first, second] = request.domain;
        if (kind == Kind::ring) {
          domain.add_ring(first - 1);
        } else {
          domain.add(step_.pieces[first - 1], 0);
          if (kind == Kind::pieces) domain.add(step_.pieces[second - 1], 0);
        }
        conclude(found, steps_, domain);
      }
    }
    return found;
  }

  // The rank on rings 1 to k; of a number that adds nothing no more are looked at.
  std::uint32_t rank_of_rings(std::uint32_t k) {
    while (ranks_.size() < k && !(ranks_.size() > 1 && ranks_.back() == ranks_[ranks_.size() - 2])) {
      monitor_.checkpoint();
      rings_.add_ring(static_cast<std::uint32_t>(ranks_.size()));
      ranks_.push_back(rings_.rank());
    }
    return k <= ranks_.size() ? ranks_[k - 1] : ranks_.back();
  }

 private:
  // Fewer functions, as many as the dimension, or a kernel.
  void conclude(IndependenceCase& found, const Steps& steps, const DomainRank& domain) {
    found.dimension = steps.dimension();
    found.rank = domain.rank();
    RankCertificate& why = found.certificate;
    if (found.independent()) return;
    const std::size_t count = scheme_.scheme == Scheme::midedge ? domain.functions().size() : domain.count();
    if (found.rank == count) {
      why.bound = RankCertificate::Bound::count;
      return;
    }
    why.bound = RankCertificate::Bound::kernel;
    const std::size_t nullity = found.dimension - found.rank;
    const auto accept = [&](const std::vector<ExactVector>& vectors, const std::vector<Function>& functions,
                            std::uint32_t left_out) {
      if (vectors.size() != nullity + left_out) return false;
      for (const ExactVector& v : vectors) {
        monitor_.checkpoint();
        if (!steps.vanishes(v, functions)) return false;
      }
      why.left_out = left_out;
      for (const ExactVector& v : vectors) why.kernel.push_back(sparse(v));
      return true;
    };
    if (accept(exact_kernel(steps, domain.independent(), steps.gauges()), domain.functions(), 0)) return;
    // Without the rows that are irrational, where all are of the first step.
    std::vector<Function> rational;
    std::set<Functional> others;
    for (const Function& f : domain.functions()) {
      const bool exact = std::all_of(f.functional.begin(), f.functional.end(), [&](const auto& part) {
        return is_rational(steps.step().rows[part.first]);
      });
      if (exact && f.steps == 0) {
        rational.push_back(f);
      } else {
        others.insert(f.functional);
      }
    }
    const bool first_only = domain.functions().back().steps == 0;
    if (first_only &&
        accept(exact_kernel(steps, rational, {}), rational, static_cast<std::uint32_t>(others.size()))) {
      return;
    }
    why.kernel = unseen_combinations(n_);
    SNUG_EXPECT(scheme_.scheme == Scheme::doo_sabin && why.kernel.size() == nullity);
  }

  void first_rings(IndependenceCase& found) {
    DomainRank domain(steps_);
    std::uint32_t k = 0;
    // A ring that adds nothing is followed by none that does.
    for (std::uint32_t before = 0; k < found.domain.first; ++k) {
      if (rank_of_rings(k + 1) == before) break;
      before = rank_of_rings(k + 1);
      domain.add_ring(k);
    }
    for (; k < found.domain.first; ++k) domain.add_ring(k);
    conclude(found, steps_, domain);
  }

  void whole(IndependenceCase& found) {
    DomainRank domain(steps_);
    std::uint32_t k = 0, before = 0;
    for (;; ++k) {
      if (rank_of_rings(k + 1) == before) break;
      before = rank_of_rings(k + 1);
      domain.add_ring(k);
    }
    conclude(found, steps_, domain);
    RankCertificate& why = found.certificate;
    why.rings = k;
    if (found.independent()) return;
    if (scheme_.scheme == Scheme::doo_sabin) {
      why.bound = RankCertificate::Bound::kernel;
      why.left_out = 0;
      why.kernel = unseen_combinations(n_);
      why.factor = mpq_class(1, 4);
      return;
    }
    SNUG_EXPECT(why.kernel.size() == 1);
    ExactVector v(found.dimension);
    for (const auto& [point, value] : why.kernel[0]) v[point] = value[0];
    why.factor = steps_.factor(v);
    SNUG_EXPECT(why.factor);
  }

  void around(IndependenceCase& found) {
    const PieceStep step = annulus_step(scheme_, n_);
    Steps steps(scheme_, step, field_);
    DomainRank domain(steps);
    domain.add_ring(0);
    conclude(found, steps, domain);
  }

  void closed(IndependenceCase& found) {
    const ControlNet net = closed_net(scheme_, n_);
    const RefinedNet once = refine(net, scheme_, n_), twice = refine(once.net, scheme_, n_);
    const PieceStep first = mesh_step(once, net.points);
    Steps steps(scheme_, first, field_);
    // Points of the second step as combinations of the first one's.
    ModularRank rank(field_, net.points);
    std::vector<ModularRow> fine;
    for (std::uint32_t p = 0; p < once.net.points; ++p) fine.push_back(steps.image({0, {{p, 1}}}));
    for (const WeightRow& row : twice.rows) {
      ModularRow image(net.points);
      for (const auto& [p, w] : row) {
        const std::uint32_t weight = field_.image(w);
        for (std::size_t c = 0; c < image.size(); ++c)
          image[c] = field_.sum(image[c], field_.product(weight, fine[p][c]));
      }
      rank.add(std::move(image));
    }
    found.dimension = net.points;
    found.rank = rank.rank();
    RankCertificate& why = found.certificate;
    why.steps = 2;
    if (found.independent()) return;
    why.bound = RankCertificate::Bound::kernel;
    std::vector<ExactVector> rows;
    for (std::uint32_t p = 0; p < once.net.points; ++p) rows.push_back(steps.exact({0, {{p, 1}}}));
    for (const ExactVector& v : null_space(rows, net.points)) why.kernel.push_back(sparse(v));
    SNUG_EXPECT(steps.rational() && why.kernel.size() == found.dimension - found.rank);
  }

  ExactScheme scheme_;
  std::uint32_t n_;
  WorkMonitor monitor_;
  ModularField field_;
  PieceStep step_;
  Steps steps_;
  DomainRank rings_;
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

std::vector<IndependenceRequest> conjecture_requests(const ExactScheme& scheme, std::uint32_t n) {
  std::vector<IndependenceRequest> requests;
  if (scheme.older_vertices) return requests;
  const auto halves = [&](std::uint32_t k, const char* name) {
    requests.push_back({{Kind::rings, k - 1}, name, false});
    requests.push_back({{Kind::rings, k}, name, true});
  };
  if (scheme.scheme == Scheme::loop && n >= 8) halves((n - 6) / 2 + 1, "conjecture 1");
  if (scheme.scheme == Scheme::catmark && n >= 6) halves(n - 4, "conjecture 2");
  return requests;
}

std::vector<IndependenceRequest> chapter_requests(const ExactScheme& scheme, std::uint32_t n) {
  const bool loop = scheme.scheme == Scheme::loop;
  const bool catmark = scheme.scheme == Scheme::catmark && !scheme.older_vertices;
  const bool older = scheme.older_vertices;
  std::vector<IndependenceRequest> all;
  const auto say = [&](Kind kind, std::uint32_t first, std::uint32_t second, const char* statement,
                       std::optional<bool> text) {
    all.push_back({{kind, first, second}, statement, text});
  };

  for (std::uint32_t i = 1; i <= 3; ++i) {
    if (loop && n <= 6)
      say(Kind::piece, i, 0, "lemma 3", true);
    else if (loop && n == 7)
      say(Kind::piece, i, 0, "p. 24", false);
    else if (catmark && n == 4)
      say(Kind::piece, i, 0, "lemma 8", true);
    else if (catmark && n == 5)
      say(Kind::piece, i, 0, "lemma 8", false);
    else if (older && n == 3)
      say(Kind::piece, i, 0, "p. 33", true);
    else
      say(Kind::piece, i, 0, "", std::nullopt);
  }
  for (const auto& [i, j] : {std::pair{1U, 2U}, {1U, 3U}, {2U, 3U}}) {
    if (loop && n == 7)
      say(Kind::pieces, i, j, "p. 24", false);
    else if (catmark && n == 5)
      say(Kind::pieces, i, j, "lemma 8", true);
    else
      say(Kind::pieces, i, j, "", std::nullopt);
  }
  if (catmark && n == 3) say(Kind::ring, 2, 0, "lemma 8", false);
  if (older && n == 3) say(Kind::ring, 2, 0, "p. 33", true);

  const std::vector<IndependenceRequest> conjecture = conjecture_requests(scheme, n);
  PieceCases ranks(scheme, n, {});
  for (std::uint32_t k = 1, before = 0;; ++k) {
    const std::uint32_t rank = ranks.rank_of_rings(k);
    if (rank == before) break;
    before = rank;
    IndependenceRequest request{{Kind::rings, k}, "", std::nullopt};
    if (k == 1 && loop && n <= 7) request = {request.domain, n == 7 ? "p. 24" : "lemma 3", true};
    if (k == 1 && loop && n > 7) request = {request.domain, "lemma 2", false};
    if (k == 1 && catmark) request = {request.domain, "lemma 8", n <= 5};
    if (k == 1 && older && n == 3) request = {request.domain, "p. 33", true};
    for (const IndependenceRequest& half : conjecture) {
      if (half.domain.first == k) request = half;
    }
    all.push_back(request);
  }
  say(Kind::omega, 0, 0,
      loop      ? "theorem 1"
      : catmark ? "theorem 2"
                : "",
      loop || catmark ? std::optional(true) : std::nullopt);
  say(Kind::annulus, 0, 0,
      loop      ? "lemma 1"
      : catmark ? "lemma 7"
                : "",
      loop || catmark ? std::optional(true) : std::nullopt);
  say(Kind::global, 0, 0,
      loop      ? "corollary 1"
      : catmark ? (n == 3 ? "lemma 6" : "p. 32")
                : "",
      loop || catmark ? std::optional(!(catmark && n == 3)) : std::nullopt);
  return all;
}

std::vector<IndependenceCase> independence_cases(const ExactScheme& scheme, std::uint32_t valence,
                                                 const std::vector<IndependenceRequest>& requests,
                                                 const WorkMonitor& monitor) {
  SNUG_EXPECT(valence >= 3);
  PieceCases all(scheme, valence, monitor);
  std::vector<IndependenceCase> cases;
  cases.reserve(requests.size());
  for (const IndependenceRequest& request : requests) cases.push_back(all.answer(request));
  return cases;
}

}  // namespace snug
