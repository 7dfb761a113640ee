#include <snug/bound.h>
#include <snug/contacts.h>
#include <snug/hull.h>
#include <snug/measure.h>
#include <snug/tessellate.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include <fmt/core.h>

#include "common.h"
#include "hulls_of_mesh.h"
#include "mesh_reading.h"
#include "mesh_summary.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

constexpr double share_of_size = 0.01;  // errors and precisions of the questions
constexpr std::size_t many_faces = 32;  // at a vertex: questions about what is near it take longer
constexpr std::size_t max_findings = 12;
constexpr std::chrono::milliseconds look_again{20};
constexpr const char* envelope_mends = "snug envelope makes a closed mesh around the surface, whatever it is";

struct Options : CommonOptions {
  std::string mesh;
  int seconds = 10;
};

// A monitor that stops at an interrupt and some time after it was made.
class TimeLimit {
 public:
  explicit TimeLimit(int seconds)
      : monitor_(stopped_by_interrupts()), watch_([this, seconds] { wait(seconds); }) {
    monitor_.stop = &stop_;
  }
  ~TimeLimit() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    ended_.notify_all();
    watch_.join();
  }
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  [[nodiscard]] const WorkMonitor& monitor() const { return monitor_; }

 private:
  void wait(int seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    std::unique_lock lock(mutex_);
    while (!ended_.wait_for(lock, look_again, [&] { return done_; })) {
      if (stop_requested || std::chrono::steady_clock::now() >= end) stop_ = true;
    }
  }

  WorkMonitor monitor_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  bool done_ = false;
  std::thread watch_;
};

// An interval in four digits: one number where they tell no more.
std::string digits(const Interval& interval) {
  const std::string lower = fmt::format("{:.4g}", interval.lower),
                    upper = fmt::format("{:.4g}", interval.upper);
  return lower == upper ? lower : fmt::format("{} to {}", lower, upper);
}

// The answer to a question: a word, and a line for people.
struct Answer {
  const char* question;
  std::string word{}, text{};
  double seconds = 0;
};

class Judge {
 public:
  Judge(const Options& options, const Surface& surface, std::vector<Finding>& findings)
      : options_(options), surface_(surface), findings_(findings) {}

  [[nodiscard]] std::vector<Answer> run() {
    ask("self-contact", [&](const Run& run, Answer& answer) { look_at_itself(run, answer); });
    ask("measure", [&](const Run& run, Answer& answer) { take_measures(run, answer); });
    ask("bound", [&](const Run& run, Answer& answer) {
      const BoundSummary found = bound(
          surface_, {.error = error()}, [](const PatchEnclosure&) {}, run);
      answer.word = name_of(found.outcome);
      answer.text = fmt::format("{} enclosures", found.count);
    });
    ask("tessellate", [&](const Run& run, Answer& answer) {
      const Tessellation found = tessellate(surface_, {.error = error()}, run);
      answer.word = name_of(found.outcome);
      answer.text = fmt::format("{} triangles", found.triangles.size());
    });
    ask("hull", [&](const Run& run, Answer& answer) {
      const Hulls found = hull(surface_, {.error = error()}, run);
      answer.word = name_of(found.outcome);
      // Where the surface goes through itself a note says so already.
      if (found.outcome != Outcome::complete && found.problems[0].fault != HullFault::through_itself) {
        findings_.push_back(
            {"no-hull", sentence(found.problems[0], surface_.traits().owner()), envelope_mends});
      }
      answer.text = found.outcome != Outcome::complete
                        ? fmt::format("none, {}", name_of(found.problems[0].fault))
                        : fmt::format("{} triangles {} and {} {}", found.inner->triangles.size(),
                                      found.closed ? "inside" : "behind", found.outer->triangles.size(),
                                      found.closed ? "outside" : "in front");
    });
    ask("envelope", [&](const Run& run, Answer& answer) {
      const Envelope found = envelope(surface_, {.error = error()}, run);
      answer.word = name_of(found.outcome);
      answer.text = found.outcome != Outcome::complete
                        ? fmt::format("none, {}", name_of(found.problems[0].fault))
                        : fmt::format("{} triangles", found.triangles.size());
    });
    return std::move(answers_);
  }

 private:
  [[nodiscard]] double error() const { return share_of_size * surface_.size(); }

  // Refusals are answers, too.
  template <class Question>
  void ask(const char* name, const Question& question) {
    Answer answer{name};
    const auto start = std::chrono::steady_clock::now();
    ProgressBar bar("asking " + std::string(name), options_.quiet);
    try {
      const TimeLimit limit(options_.seconds);
      question(Run{.threads = options_.threads, .monitor = &limit.monitor()}, answer);
    } catch (const Interrupted&) {
      if (stop_requested) throw;
      answer.word = "out-of-time";
      answer.text = "no answer; --seconds N allows more";
    } catch (const InputError& refusal) {
      answer.word = "refused";
      answer.text = refusal.what();
      if (const std::string head = std::string(name) + ": "; answer.text.starts_with(head))
        answer.text.erase(0, head.size());
      answer.text.insert(0, "refused: ");
    }
    answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    answers_.push_back(std::move(answer));
  }

  void look_at_itself(const Run& run, Answer& answer) {
    const SelfContact found = self_contact(surface_, {}, run);
    answer.word = answer.text = name_of(found.verdict);
    if (found.verdict == SelfVerdict::clear) return;
    const char* const owner = surface_.traits().owner();
    const auto place = [&](const SelfContactPair& pair) {
      const Point3& p = pair.points[0].point;
      const std::uint32_t a = pair.points[0].at->owner, b = pair.points[1].at->owner;
      return fmt::format("{} {} {}, at {:.6g} {:.6g} {:.6g}", owner, a,
                         a == b ? "with itself" : fmt::format("and {}", b), p.x, p.y, p.z);
    };
    const bool meets = found.verdict == SelfVerdict::intersecting;
    const SelfContactPair& first = found.pairs[0];
    std::string text = !meets           ? "not proved clear of itself: "
                       : first.touching ? "the surface touches itself: "
                                        : "the surface goes through itself: ";
    text += place(first);
    const std::string vertex = meets ? "" : vertex_at(surface_, *first.points[0].at);
    if (!vertex.empty()) text += " (" + vertex + ")";
    if (found.pairs.size() > 1) {
      text += fmt::format(", and in {}{} more places",
                          found.pairs.size() == SelfContact::max_pairs ? "at least " : "",
                          found.pairs.size() - 1);
    }
    // Flat polygons with a corner that points inwards turn over there.
    const bool turns_over = meets && !first.touching && surface_.scheme() == Scheme::catmark &&
                            first.points[0].at->owner == first.points[1].at->owner &&
                            surface_.mesh().face(FaceId(first.points[0].at->owner)).size() > 4;
    findings_.push_back({meets ? "meets-itself" : "self-contact-undecided", text,
                         !meets       ? ""
                         : turns_over ? "--sharp auto splits flat faces that are not convex"
                                      : envelope_mends});
  }

  void take_measures(const Run& run, Answer& answer) {
    const Measures found = measure(surface_, {.relative = share_of_size}, run);
    answer.word = name_of(found.outcome);
    answer.text = "area " + digits(found.area);
    if (!found.volume) return;
    answer.text += ", volume " + digits(*found.volume);
    if (found.volume->upper < 0) {
      findings_.push_back({"inside-out", "the volume is negative: faces look clockwise from outside", ""});
    }
  }

  const Options& options_;
  const Surface& surface_;
  std::vector<Finding>& findings_;
  std::vector<Answer> answers_;
};

void find_in_mesh(const ControlMesh& mesh, const MeshSummary& summary, const Options& options,
                  std::vector<Finding>& findings) {
  const MeshCounts& counts = summary.counts;
  const SchemeTraits& traits = traits_of(summary.scheme);
  // They are in order, kind by kind.
  for (std::size_t i = 0, end; i < summary.defects.size(); i = end) {
    const Defect& defect = summary.defects[i];
    end = i + 1;
    while (end < summary.defects.size() && summary.defects[end].kind == defect.kind) ++end;
    const std::size_t more = end - i - 1;
    findings.push_back({name_of(defect.kind),
                        defect.text + (more > 0 ? fmt::format(", and {} more like it", more) : ""),
                        more > 0 ? "snug info lists them" : ""});
  }
  if (summary.surface && options.scheme == "auto" && options.sharp.empty() && !traits.local) {
    const std::string line =
        smoothing_note(*summary.surface, "--scheme", summary.apart, {.threads = options.threads});
    if (const std::size_t end = line.find("; "); !line.empty()) {
      findings.push_back(
          {"smoothed-triangles", line.substr(0, end), end == std::string::npos ? "" : line.substr(end + 2)});
    }
  }
  for (Finding& found : coincidences_found(mesh)) findings.push_back(std::move(found));
  if (counts.boundary_edges > 0) {
    findings.push_back({"open",
                        fmt::format("open: {} boundary edges in {} border{}, so that there is no inside",
                                    counts.boundary_edges, counts.borders, counts.borders == 1 ? "" : "s"),
                        envelope_mends});
  }
  if (summary.twice) findings.push_back({"overlapping-shell", overlap_sentence(summary), ""});
  if (counts.needles > 0) {
    findings.push_back(
        {"needles",
         fmt::format("{} a hundred times as long as wide or more",
                     counts.needles == 1 ? "a face is" : fmt::format("{} faces are", counts.needles)),
         ""});
  }
  if (counts.max_valence > many_faces) {
    findings.push_back(
        {"valence", fmt::format("a vertex has {} edges: what is near it takes longer", counts.max_valence),
         ""});
  }
}

void write_json(JsonWriter& json, const MeshSummary& summary, const ControlMesh& mesh,
                const std::vector<Answer>& answers, const std::vector<Finding>& findings) {
  const MeshCounts& counts = summary.counts;
  json.field("vertices", mesh.vertex_count())
      .field("faces", mesh.face_count())
      .field("closed", counts.closed);
  json.field("components", counts.components).field("boundary_edges", counts.boundary_edges);
  json.field("borders", counts.borders).key("limit_to_faces");
  summary.apart ? json.value(*summary.apart) : json.null();
  json.key("answers").begin_array();
  for (const Answer& answer : answers) {
    json.begin_object()
        .field("question", answer.question)
        .field("answer", answer.word)
        .field("text", answer.text);
    json.field("seconds", answer.seconds).end_object();
  }
  json.end_array().key("findings").begin_array();
  for (const Finding& found : findings) {
    json.begin_object().field("kind", found.kind).field("text", found.text).key("mends");
    found.mends.empty() ? json.null() : json.value(found.mends);
    json.end_object();
  }
  json.end_array();
}

ExitStatus run(const Options& options) {
  std::vector<Finding> findings;
  const std::optional<double> angle = sharp_angle(options);
  ReadOptions reading{
      weld_distance(options), [&](const std::string& line) {
        const std::string head = options.mesh + ": ";
        findings.push_back({"file", line.starts_with(head) ? line.substr(head.size()) : line, ""});
      }};
  const WorkMonitor monitor = stopped_by_interrupts();
  ControlMesh mesh = read_mesh(options.mesh, reading, {.monitor = &monitor});
  set_units(mesh, options.mesh, options);
  if (angle) sharpen_mesh(mesh, options.mesh, *angle, options);
  Report report("judge", options);
  const MeshSummary summary = summary_of(mesh, options.mesh, options);
  if (!summary.surface) findings.push_back({"refused", summary.refusal, ""});
  find_in_mesh(mesh, summary, options, findings);
  std::vector<Answer> answers;
  if (summary.surface) answers = Judge(options, *summary.surface, findings).run();

  report.heads({options.mesh}, {name_of(summary.scheme)});
  if (report.json()) write_json(report.write(), summary, mesh, answers, findings);
  const std::vector<std::string> lines = lines_of(summary, mesh, options.mesh, options);
  for (const std::string& line : lines) report.text(line);
  for (const Answer& answer : answers) {
    report.text(fmt::format("{:12}  {}, {} {:.{}f} s", answer.question, answer.text,
                            answer.word == "out-of-time" ? "after" : "in", answer.seconds,
                            answer.seconds < 1 ? 2 : 1));
  }
  // The lines say already why it is refused.
  std::erase_if(findings, [](const Finding& found) { return found.kind == std::string_view("refused"); });
  std::set<std::string> said;  // what mends is said once
  for (std::size_t i = 0; i < std::min(findings.size(), max_findings); ++i) {
    const Finding& found = findings[i];
    const bool is_new = !found.mends.empty() && said.insert(found.mends).second;
    report.text("note: " + found.text + (is_new ? "; " + found.mends : ""));
  }
  if (findings.size() > max_findings) {
    report.text(fmt::format("and {} more; --json lists all", findings.size() - max_findings));
  }
  return report.finish();
}

}  // namespace

Command judge_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_or_input_help);
  list.add(Group::effort, "--seconds N", &options->seconds, "Longest time for one question")
      .between(1, 86'400);
  add_common_options(list, *options);
  return {"judge",
          Topic::files,
          "Ask a mesh every question, and tell what it is and what may be wrong with it",
          {"snug judge pawn.obj", "snug judge part.stl --sharp auto --json"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
