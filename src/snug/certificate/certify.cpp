#include <snug/certificate/certify.h>

#include <snug/certificate/certificate.h>
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
    out_.missing = count_ == 1 ? what : "of answer " + std::to_string(answer) + ": " + what;
  }
  // What was looked for in vain.
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

  void more_than(double margin) {
    gaps_.add(answer_, "that the surfaces are separated", writer_.apart(margin));
  }
  void below(double lower) {
    if (lower > 0) gaps_.add(answer_, "all of the lower end of the distance", writer_.at_least(lower));
  }
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
  void meeting(const std::optional<WitnessPoints>& witness, bool of_solids) {
    const Place* const a = witness ? place_of((*witness)[0]) : nullptr;
    const Place* const b = witness ? place_of((*witness)[1]) : nullptr;
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

void add(CertificateWriter& writer, Gaps& gaps, std::size_t i, const PlacedSurface& a, const PlacedSurface& b,
         const CollideOptions& options, const Collision& answer) {
  writer.ask(a, b);
  Proofs proofs(writer, gaps, i);
  switch (answer.verdict) {
    case Verdict::separated:
      proofs.more_than(options.margin);
      if (answer.witness) proofs.above(answer.distance.upper, answer.witness);
      if (options.solid) gaps.add(i, "that neither solid lies inside the other");
      return;
    case Verdict::within:
      proofs.above(answer.distance.upper, answer.witness);
      return;
    case Verdict::intersecting:
      proofs.meeting(answer.witness, options.solid);
      return;
    case Verdict::undecided:
      gaps.add(i, "the verdict, which is undecided");
      return;
  }
}

void add(CertificateWriter& writer, Gaps& gaps, std::size_t i, const PlacedSurface& a, const PlacedSurface& b,
         const DistanceOptions& options, const Distance& answer) {
  writer.ask(a, b);
  Proofs proofs(writer, gaps, i);
  if (answer.distance.upper == 0) {
    proofs.meeting(answer.witness, options.solid);
    return;
  }
  proofs.below(answer.distance.lower);
  proofs.above(answer.distance.upper, answer.witness);
  if (options.solid) gaps.add(i, "that neither solid lies inside the other");
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
    add(writer, gaps, i, a, b, options, answer);
  });
}

template <class Options, class Answer>
void write_poses(const Run& run, const Surface& a, const Surface& b, std::span<const PosePair> poses,
                 const Options& options, std::span<const Answer> answers) {
  write(run, {&a, &b}, answers.size(), [&](CertificateWriter& writer, Gaps& gaps, std::size_t i) {
    add(writer, gaps, i, a.at(poses[i].a), b.at(poses[i].b), options, answers[i]);
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

void certify(const Run& run, const Surface& surface, std::span<const Point3> points,
             std::span<const ClosestPoint> answers) {
  write(run, {&surface}, answers.size(), [&](CertificateWriter& writer, Gaps& gaps, std::size_t i) {
    const ClosestPoint& answer = answers[i];
    writer.ask(surface, points[i]);
    if (answer.distance.lower > 0) {
      gaps.add(i, "all of the lower end of the distance", writer.at_least(answer.distance.lower));
    }
    writer.near(answer.distance.upper, *answer.at, nullptr);
  });
}

namespace {

// From there on a plane across the ray lies between it and the surface.
double behind(const Surface& surface, const Ray& ray) {
  double farthest = ray.from;
  for (const Point3& p : surface.mesh().points) {
    farthest = std::max(farthest, dot(p - ray.origin, ray.direction) / length_sq(ray.direction));
  }
  return farthest;
}

}  // namespace

void certify(const Run& run, const Surface& surface, std::span<const Ray> rays, RayQuery query,
             std::span<const RayHits> answers) {
  write(run, {&surface}, answers.size(), [&](CertificateWriter& writer, Gaps& gaps, std::size_t i) {
    const Ray& ray = rays[i];
    // The ends of hits may be as tight as doubles allow.
    const double slack = 0x1p-34 * surface.size() / length(ray.direction);
    bool nothing_between = answers[i].outcome != Outcome::budget_spent && query != RayQuery::any;
    if (answers[i].certain_miss()) nothing_between = true;
    const double beyond = behind(surface, ray) + 0x1p-6 * surface.size() / length(ray.direction);
    const auto require_miss = [&](double from, double to) {
      if (!nothing_between || from > to) return;
      // A half-line is cut where a plane across it separates what follows from the surface.
      const double cut = to < INFINITY ? to : std::max(from, beyond);
      for (const auto& [begin, end] : {std::pair{from, cut}, {cut, to}}) {
        if (begin == end) continue;
        writer.ask(surface, Ray{ray.origin, ray.direction, begin, end});
        gaps.add(i, "that the ray meets nothing elsewhere", writer.apart(0));
      }
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
