#include <snug/certificate/certify.h>

#include <map>
#include <set>
#include <tuple>
#include <type_traits>

#include <snug/certificate/certificate.h>
#include <support/error.h>
#include <support/point.h>
#include <support/run.h>

namespace snug {
namespace {

// What a certificate lacks, as the rest of "does not prove ..."; the first reason is kept.
class Gaps {
 public:
  Gaps(Certificate& out, std::size_t count) : out_(out), count_(count) { out_ = {}; }
  void add(std::size_t answer, const std::string& what) {
    if (!out_.missing.empty()) return;
    out_.missing = count_ == 1 ? what : "of answer " + std::to_string(answer) + ", counted from 0: " + what;
  }
  // The proof that was looked for in vain.
  void add(std::size_t answer, const std::string& what, Found found) {
    if (found == Found::proof) return;
    add(answer, what + (found == Found::too_many_leaves ? ": that would take more than 100,000 leaves"
                                                        : ": it is too tight for doubles"));
  }

 private:
  Certificate& out_;
  std::size_t count_;
};

const Place* place_of(const LimitPoint& point) { return point.at ? &*point.at : nullptr; }

// Proofs of the two ends of a distance, or of a common point.
class Proofs {
 public:
  Proofs(CertificateWriter& writer, Gaps& gaps, std::size_t answer)
      : writer_(writer), gaps_(gaps), answer_(answer) {}

  void more_than(double margin, bool of_solids) {
    const Found found = writer_.apart(margin);
    gaps_.add(answer_, "that the surfaces are separated", found);
    if (of_solids && found == Found::proof) neither_inside();
  }
  // Of surfaces that are proved to be apart.
  void neither_inside() {
    if (!writer_.solids_apart()) gaps_.add(answer_, "that neither solid lies inside the other");
  }
  void below(double lower, bool of_solids) {
    if (lower > 0) gaps_.add(answer_, "all of the lower end of the distance", writer_.at_least(lower));
    if (of_solids && lower > 0) neither_inside();
  }
  void nothing_of(const std::string& what) { gaps_.add(answer_, what); }
  void above(double upper, const std::optional<WitnessPoints>& witness) {
    if (!(upper < INFINITY)) return;
    const Place* const a = witness ? place_of((*witness)[0]) : nullptr;
    const Place* const b = witness ? place_of((*witness)[1]) : nullptr;
    if (a == nullptr || b == nullptr) {
      gaps_.add(answer_,
                "the upper end of the distance: the answer has no witnesses at places of both surfaces");
    } else {
      writer_.near(upper, *a, b);
    }
  }
  // `inner`: whose witness is said to lie in the other solid.
  void meeting(const std::optional<WitnessPoints>& witness, std::optional<std::size_t> inner,
               bool of_solids) {
    const Place* const a = witness ? place_of((*witness)[0]) : nullptr;
    const Place* const b = witness ? place_of((*witness)[1]) : nullptr;
    const Place* const inside = !inner ? nullptr : *inner == 0 ? a : b;
    if (inside != nullptr && writer_.solids_meet(*inner, *inside)) return;
    if (a != nullptr && b != nullptr && writer_.meet(*a, b)) return;
    gaps_.add(answer_, of_solids ? "that the solids have a point in common"
                                 : "that the surfaces have a point in common");
    if (a != nullptr && b != nullptr) writer_.near(0, *a, b);
  }

 private:
  CertificateWriter& writer_;
  Gaps& gaps_;
  std::size_t answer_;
};

void add(Proofs proofs, const CollideOptions& options, const Collision& answer) {
  switch (answer.verdict) {
    case Verdict::separated:
      proofs.more_than(options.margin, options.solid);
      if (answer.witness) proofs.above(answer.distance.upper, answer.witness);
      return;
    case Verdict::within:
      proofs.above(answer.distance.upper, answer.witness);
      return;
    case Verdict::intersecting:
      proofs.meeting(answer.witness, answer.contained, options.solid);
      return;
    case Verdict::undecided:
      proofs.nothing_of("the verdict, which is undecided");
      return;
  }
}

void add(Proofs proofs, const DistanceOptions& options, const Distance& answer) {
  if (answer.distance.upper == 0) {
    proofs.meeting(answer.witness, answer.contained, options.solid);
    return;
  }
  proofs.below(answer.distance.lower, options.solid);
  proofs.above(answer.distance.upper, answer.witness);
}

// Calls add(writer, gaps, i) for each answer.
template <class Add>
void write(const Run& run, std::initializer_list<const Surface*> surfaces, std::size_t count,
           const Add& add) {
  if (run.certificate == nullptr) return;
  for (const Surface* surface : surfaces) {
    *run.certificate = {{}, CertifiedSurface::refusal(*surface)};
    if (!run.certificate->missing.empty()) return;
  }
  CertificateWriter writer(monitor_of(run));
  Gaps gaps(*run.certificate, count);
  for (std::size_t i = 0; i < count; ++i) add(writer, gaps, i);
  run.certificate->text = writer.finished();
}

template <class Options, class Answer>
void write_pair(const Run& run, const PlacedSurface& a, const PlacedSurface& b, const Options& options,
                const Answer& answer) {
  write(run, {&a.surface(), &b.surface()}, 1, [&](CertificateWriter& writer, Gaps& gaps, std::size_t i) {
    writer.ask(a, b);
    add({writer, gaps, i}, options, answer);
  });
}

template <class Options, class Answer>
void write_poses(const Run& run, const Surface& a, const Surface& b, std::span<const PosePair> poses,
                 const Options& options, std::span<const Answer> answers) {
  write(run, {&a, &b}, answers.size(), [&](CertificateWriter& writer, Gaps& gaps, std::size_t i) {
    writer.ask(a.at(poses[i].a), b.at(poses[i].b));
    add({writer, gaps, i}, options, answers[i]);
  });
}

}  // namespace

void certify(const Run& run, const PlacedSurface& a, const PlacedSurface& b, const CollideOptions& options,
             const Collision& answer) {
  write_pair(run, a, b, options, answer);
}

void certify(const Run& run, const Surface& a, const Surface& b, std::span<const PosePair> poses,
             const CollideOptions& options, std::span<const Collision> answers) {
  write_poses(run, a, b, poses, options, answers);
}

void certify(const Run& run, const PlacedSurface& a, const PlacedSurface& b, const DistanceOptions& options,
             const Distance& answer) {
  write_pair(run, a, b, options, answer);
}

void certify(const Run& run, const Surface& a, const Surface& b, std::span<const PosePair> poses,
             const DistanceOptions& options, std::span<const Distance> answers) {
  write_poses(run, a, b, poses, options, answers);
}

namespace {

void add_closest(CertificateWriter& writer, Gaps& gaps, std::size_t i, const ClosestPoint& answer) {
  if (answer.distance.lower > 0) {
    gaps.add(i, "all of the lower end of the distance", writer.at_least(answer.distance.lower));
  }
  writer.near(answer.distance.upper, *answer.at, nullptr);
}

void add_side(CertificateWriter& writer, Gaps& gaps, std::size_t i, bool inside) {
  const std::optional<int> number = writer.winding(1, nullptr);
  if (!number || (*number != 0) != inside)
    gaps.add(i, inside ? "that the point is inside" : "that the point is outside");
}

}  // namespace

void certify(const Run& run, const Surface& surface, std::span<const Point3> points,
             std::span<const ClosestPoint> answers) {
  write(run, {&surface}, answers.size(), [&](CertificateWriter& writer, Gaps& gaps, std::size_t i) {
    writer.ask(surface, points[i]);
    add_closest(writer, gaps, i, answers[i]);
  });
}

void certify(const Run& run, const Surface& surface, std::span<const Point3> points,
             std::span<const SignedDistance> answers) {
  write(run, {&surface}, answers.size(), [&](CertificateWriter& writer, Gaps& gaps, std::size_t i) {
    const SignedDistance& answer = answers[i];
    writer.ask(surface, points[i]);
    add_closest(writer, gaps, i, answer.nearest);
    if (answer.distance.lower > 0 || answer.distance.upper < 0) {
      add_side(writer, gaps, i, answer.distance.upper < 0);
    } else {
      gaps.add(i, "a sign of the distance, which the answer leaves open");
    }
  });
}

void certify(const Run& run, const Surface& surface, std::span<const Point3> points,
             std::span<const std::optional<bool>> answers) {
  write(run, {&surface}, answers.size(), [&](CertificateWriter& writer, Gaps& gaps, std::size_t i) {
    writer.ask(surface, points[i]);
    if (answers[i]) {
      add_side(writer, gaps, i, *answers[i]);
    } else {
      gaps.add(i, "whether the point is inside, which is undecided");
    }
  });
}

namespace {

// All that the claims about two parts follow from, but for the answer.
struct PartsInPlace {
  std::array<const SurfaceData*, 2> surfaces;
  std::array<std::array<double, 12>, 2> poses;
  friend bool operator<(const PartsInPlace& x, const PartsInPlace& y) {
    return std::tie(x.surfaces, x.poses) < std::tie(y.surfaces, y.poses);
  }
};

PartsInPlace in_place(const PlacedSurface& a, const PlacedSurface& b) {
  return {{a.surface().data().get(), b.surface().data().get()}, {a.pose().numbers(), b.pose().numbers()}};
}

void require_parts(const PartPair& pair, std::size_t parts) {
  if (pair.a == pair.b || std::max(pair.a, pair.b) >= parts)
    refuse_value("certify: an answer is about two different parts of the scene");
}

// Each pair with a question of its own, but for those whose parts lie in hulls that are apart.
template <class Options, class PairAnswer>
void write_scene(const Run& run, const Scene& scene, double margin, const Options& options,
                 std::span<const PairAnswer> answers) {
  for (const PairAnswer& answer : answers) require_parts(answer.parts, scene.parts.size());
  if (run.certificate == nullptr) return;
  *run.certificate = {};
  for (const PlacedSurface& part : scene.parts) {
    run.certificate->missing = CertifiedSurface::refusal(part.surface());
    if (!run.certificate->missing.empty()) return;
  }
  const auto sorted = [](const PartPair& pair) { return PartNumbers(std::minmax(pair.a, pair.b)); };
  // A list of pairs may name two parts in both orders.
  const auto key = [&](const PartPair& pair) {
    return scene.pairs ? PartNumbers(pair.a, pair.b) : sorted(pair);
  };
  std::map<PartNumbers, double> margins;
  for (const PairMargin& own : scene.margins) margins[sorted(own.parts)] = own.margin;
  std::map<PartNumbers, const PairAnswer*> answered;
  for (const PairAnswer& answer : answers) answered[key(answer.parts)] = &answer;

  CertificateWriter writer(monitor_of(run));
  writer.ask(scene.parts);
  std::vector<PartPair> pairs;
  if (scene.pairs) {
    pairs = *scene.pairs;
  } else {
    std::set<PartNumbers> except;
    for (const auto& [pair, own] : margins) except.insert(pair);
    for (const auto& [pair, answer] : answered) except.insert(pair);
    writer.hulls(margin, except);
    for (const PartNumbers& pair : except) {
      const auto answer = answered.find(pair);
      pairs.push_back(answer == answered.end() ? PartPair{pair.first, pair.second} : answer->second->parts);
    }
  }
  // Copies of parts in one place differ in nothing but names.
  std::map<std::pair<PartsInPlace, double>, Certificate> known;
  std::string missing;
  for (const PartPair& pair : pairs) {
    const auto own = margins.find(sorted(pair));
    const double wanted = own == margins.end() ? margin : own->second;
    const auto [of_pair, is_new] =
        known.try_emplace({in_place(scene.parts[pair.a], scene.parts[pair.b]), wanted});
    writer.pair(pair.a, pair.b);
    if (is_new) {
      Gaps gaps(of_pair->second, 1);
      Proofs proofs(writer, gaps, 0);
      if (const auto found = answered.find(key(pair)); found != answered.end()) {
        Options of_this = options;
        if constexpr (std::is_same_v<Options, CollideOptions>) of_this.margin = wanted;
        add(proofs, of_this, found->second->answer);
      } else {
        proofs.more_than(wanted, options.solid);
      }
      of_pair->second.text = writer.claims();
    } else {
      writer.add_claims(of_pair->second.text);
    }
    if (missing.empty() && !of_pair->second.missing.empty()) {
      missing = "of parts " + std::to_string(pair.a) + " and " + std::to_string(pair.b) + ": " +
                of_pair->second.missing;
    }
  }
  *run.certificate = {writer.finished(), missing};
}

}  // namespace

void certify(const Scene& scene, const CollideOptions& options, std::span<const PairCollision> answers,
             const Run& run) {
  write_scene(run, scene, options.margin, options, answers);
}

void certify(const Scene& scene, double limit, const DistanceOptions& options,
             std::span<const PairDistance> answers, const Run& run) {
  write_scene(run, Scene{scene.parts, scene.pairs, {}}, limit, options, answers);
}

void certify(const Run& run, const Surface& surface, std::span<const Ray> rays, RayQuery query,
             std::span<const RayHits> answers) {
  write(run, {&surface}, answers.size(), [&](CertificateWriter& writer, Gaps& gaps, std::size_t i) {
    const Ray& ray = rays[i];
    // The ends of hits may be as tight as doubles allow.
    const double slack = 0x1p-34 * surface.size() / length(ray.direction);
    bool nothing_between = answers[i].outcome != Outcome::budget_spent && query != RayQuery::any;
    if (answers[i].certain_miss()) nothing_between = true;
    const auto require_miss = [&](double from, double to) {
      if (!nothing_between || from > to) return;
      writer.ask(surface, Ray{ray.origin, ray.direction, from, to});
      gaps.add(i, "that the ray meets nothing elsewhere", writer.apart(0));
    };
    double from = ray.from;
    for (const RayHit& hit : answers[i].hits) {
      const Ray cut{ray.origin, ray.direction, std::max(hit.t.lower - slack, ray.from),
                    std::min(hit.t.upper + slack, ray.to)};
      require_miss(from, cut.from);
      from = std::max(from, cut.to);
      if (!hit.certified) {
        gaps.add(i, "what there is in a hit without certainty");
        continue;
      }
      writer.ask(surface, cut);
      if (!writer.meet(*hit.at, nullptr)) gaps.add(i, "that the ray meets the surface in a certified hit");
    }
    if (!(query == RayQuery::nearest && answers[i].certain_hit())) require_miss(from, ray.to);
    if (answers[i].outcome == Outcome::budget_spent)
      gaps.add(i, "that there is no other hit: the budget was spent");
  });
}

}  // namespace snug
