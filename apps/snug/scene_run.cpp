#include "scene_run.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <future>
#include <mutex>
#include <span>
#include <thread>
#include <utility>

#include <fmt/core.h>
#include <support/in_order.h>
#include <support/parallel.h>
#include <support/read_file.h>

#include "journal.h"
#include "progress_bar.h"
#include "version.h"

namespace snug::command {
namespace {

constexpr std::size_t pairs_of_a_batch = 16384;

// Pairs that a rank is given at once, at most.
constexpr std::size_t max_pairs = 2048;
// A rank sends its answers that often, or once there are so many bytes of them.
constexpr std::chrono::milliseconds between_messages{100};
constexpr std::size_t max_bytes = std::size_t{1} << 26;
// How long rank 0 waits before it looks for messages again, at first and at most: a look takes some microseconds from a core
// that works.
constexpr std::chrono::microseconds shortest_wait{50}, longest_wait{1000};

// About how many patches of both parts lie where their boxes overlap: what an answer costs, up to a factor.
double cost_of(const SceneBroadPhase& boxes, const Scene& scene, const ScenePair& pair) {
  const Box3 &a = boxes.box(pair.parts.a), &b = boxes.box(pair.parts.b);
  double share_a = 1, share_b = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double common = std::min(a.upper[axis], b.upper[axis]) - std::max(a.lower[axis], b.lower[axis]);
    const double overlap = std::max(common, 0.0) + pair.margin;
    const auto share = [&](const Box3& box) {
      const double side = box.upper[axis] - box.lower[axis];
      return side > overlap && side < INFINITY ? overlap / side : 1.0;
    };
    share_a *= share(a);
    share_b *= share(b);
  }
  const auto owners = [&](std::uint32_t part) {
    return static_cast<double>(scene.parts[part].surface().owner_count());
  };
  return 8 + share_a * owners(pair.parts.a) + share_b * owners(pair.parts.b);
}

// Pairs that are answered before further ones are.
struct PairBatch {
  std::vector<ScenePair> pairs;
  std::vector<double> costs;  // of each that boxes do not separate
  double share;               // of all pairs, with these
};

PairBatch next_batch(SceneBroadPhase& broad, const Scene& scene, std::size_t count) {
  PairBatch batch{broad.next(count), {}, 0};
  batch.costs.reserve(batch.pairs.size());
  for (const ScenePair& pair : batch.pairs) {
    batch.costs.push_back(pair.separated_by_boxes() ? 0 : cost_of(broad, scene, pair));
  }
  batch.share = broad.share();
  return batch;
}

// Pairs of a batch in their order, dealt out in parts of about the same cost, smaller ones towards the end.
class PairQueue {
 public:
  PairQueue(std::vector<double> costs, std::size_t takers)
      : costs_(std::move(costs)), takers_(static_cast<double>(takers)) {
    for (const double cost : costs_) left_ += cost;
  }
  struct Range {
    std::size_t begin, end;
  };
  // Empty at the end.
  Range take() {
    const std::lock_guard lock(mutex_);
    Range range{next_, next_};
    const double wanted = left_ / (8 * takers_);
    double cost = 0;
    while (range.end < costs_.size() && range.end - range.begin < max_pairs && (cost == 0 || cost < wanted)) {
      cost += costs_[range.end++];
    }
    left_ -= cost;
    next_ = range.end;
    return range;
  }
  // No more for anybody, and what was taken is to be left.
  void end() {
    const std::lock_guard lock(mutex_);
    next_ = costs_.size();
    ended_ = true;
  }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  std::mutex mutex_;
  std::atomic<bool> ended_{false};
  std::vector<double> costs_;
  double takers_, left_ = 0;
  std::size_t next_ = 0;
};

std::string bytes_of(const std::vector<ScenePair>& pairs) {
  return {reinterpret_cast<const char*>(pairs.data()), pairs.size() * sizeof(ScenePair)};
}

std::vector<ScenePair> pairs_of(const std::string& bytes) {
  std::vector<ScenePair> pairs(bytes.size() / sizeof(ScenePair));
  if (!pairs.empty()) std::memcpy(pairs.data(), bytes.data(), pairs.size() * sizeof(ScenePair));
  return pairs;
}

// Messages of a rank: after the first letter come answers, or why it has ended.
constexpr char answers_follow = 'A', failure_follows = 'F', interruption_follows = 'I';

void throw_failure(const Ranks::Message& message) {
  const std::string_view text = std::string_view(message.bytes).substr(1);
  if (message.bytes.front() == interruption_follows) throw Interrupted();
  if (message.bytes.front() == failure_follows) {
    throw InputError(static_cast<InputProblem>(text.front() - '0'),
                     fmt::format("rank {}: {}", message.from, text.substr(1)));
  }
}

std::size_t count_of_answers(const Ranks::Message& message) {
  return static_cast<std::size_t>(std::count(message.bytes.begin(), message.bytes.end(), '\n'));
}

// Answers to `pairs`.
std::vector<SceneAnswer> answers_of(const Ranks::Message& message, std::span<const ScenePair> pairs) {
  std::string_view text = std::string_view(message.bytes).substr(1);
  std::vector<SceneAnswer> answers;
  answers.reserve(pairs.size());
  while (!text.empty()) {
    const auto end = text.find('\n');
    PartPair parts;
    SceneAnswer answer;
    if (end == std::string_view::npos || answers.size() == pairs.size() ||
        !parse_line(text.substr(0, end), parts, answer) || parts != pairs[answers.size()].parts) {
      throw InputError(
          InputProblem::unreadable,
          fmt::format("rank {} sent an invalid answer; run the same version on all ranks", message.from));
    }
    answers.push_back(std::move(answer));
    text.remove_prefix(end + 1);
  }
  return answers;
}

// Runs one batch on this process, and on other ranks if there are any.
class Batch {
 public:
  using Ask = std::function<SceneAnswer(const ScenePair&, Workspace&)>;
  using Put = std::function<void(std::size_t, SceneAnswer)>;
  Batch(const std::vector<ScenePair>& pairs, std::vector<double> costs, const Ranks* ranks,
        Workers<Workspace>& workers, const WorkMonitor& monitor, const Ask& ask, const Put& put)
      : pairs_(pairs),
        queue_(std::move(costs), workers.threads() * (ranks ? static_cast<std::size_t>(ranks->size()) : 1)),
        ranks_(ranks),
        workers_(workers),
        monitor_(monitor),
        ask_(ask),
        put_(put) {}

  // `idle`: ranks that wait for work; kept from one batch to the next.
  void run(std::vector<int>& idle) {
    if (ranks_ == nullptr) return work();
    std::exception_ptr failure;
    std::atomic<bool> ended{false};
    std::thread own([&] {
      try {
        work();
      } catch (...) {
        failure = std::current_exception();
        queue_.end();
      }
      ended = true;
    });
    try {
      serve_ranks(idle, ended);
    } catch (...) {
      queue_.end();
      own.join();
      throw;
    }
    own.join();
    if (failure) std::rethrow_exception(failure);
  }

 private:
  void work() {
    workers_.run([&](Workspace& workspace) {
      try {
        for (auto range = queue_.take(); range.begin < range.end; range = queue_.take()) {
          for (std::size_t i = range.begin; i < range.end && !queue_.ended(); ++i) {
            put_(i, ask_(pairs_[i], workspace));
          }
        }
      } catch (...) {
        queue_.end();
        throw;
      }
    });
  }

  // MPI knows this thread only. While it looks for messages the processor is left to the others.
  void serve_ranks(std::vector<int>& idle, const std::atomic<bool>& ended) {
    std::vector<PairQueue::Range> given(static_cast<std::size_t>(ranks_->size()), {0, 0});
    std::size_t working = 0;
    const auto give = [&](int rank) {
      const PairQueue::Range range = queue_.take();
      if (range.begin == range.end) return false;
      given[static_cast<std::size_t>(rank)] = range;
      ranks_->send(rank, bytes_of({pairs_.begin() + static_cast<std::ptrdiff_t>(range.begin),
                                   pairs_.begin() + static_cast<std::ptrdiff_t>(range.end)}));
      ++working;
      return true;
    };
    const auto give_all = [&] { std::erase_if(idle, give); };
    give_all();
    auto wait = shortest_wait;
    while ((working > 0 || !ended) && !queue_.ended()) {
      monitor_.checkpoint();
      const auto message = ranks_->receive(false);
      if (!message) {
        std::this_thread::sleep_for(wait);
        wait = std::min(2 * wait, longest_wait);
        continue;
      }
      wait = shortest_wait;
      throw_failure(*message);
      PairQueue::Range& left = given[static_cast<std::size_t>(message->from)];
      const std::size_t begin = left.begin, end = std::min(begin + count_of_answers(*message), left.end);
      left.begin = end;
      if (left.begin == left.end) {
        if (begin < end) --working;  // else it has just arrived
        // More work first: what it sent is read meanwhile.
        idle.push_back(message->from);
        give_all();
      }
      std::vector<SceneAnswer> answers = answers_of(*message, std::span(pairs_).subspan(begin, end - begin));
      for (std::size_t i = begin; i < end; ++i) put_(i, std::move(answers[i - begin]));
    }
  }

  const std::vector<ScenePair>& pairs_;
  PairQueue queue_;
  const Ranks* ranks_;
  Workers<Workspace>& workers_;
  const WorkMonitor& monitor_;
  const Ask& ask_;
  const Put& put_;
};

// Writes answers in their order, and counts them.
class Results {
 public:
  Results(const LoadedScene& loaded, Report& report) : loaded_(loaded), report_(report) {}

  void begin(const SceneQuestion& question, const std::string& file) {
    report_.text("# a b " + question.header);
    if (!report_.json()) return;
    JsonWriter& json = report_.write();
    json.field("scene", file);
    json.key("mesh").begin_array();
    for (const SceneMesh& mesh : loaded_.text.meshes) json.value(mesh.path);
    json.end_array().key("scheme").begin_array();
    for (const Surface& surface : loaded_.surfaces) json.value(name_of(surface.scheme()));
    json.end_array().field("parts", loaded_.scene.parts.size());
    question.head(json);
    json.key("results").begin_array();
  }

  void add(const ScenePair& pair, const SceneAnswer& answer, bool by_boxes) {
    if (by_boxes) {
      ++boxes_;
    } else {
      ++verdicts_[static_cast<std::size_t>(answer.verdict)];
    }
    reached_ = reached_ && answer.reached;
    if (answer.row.empty()) return;
    ++count_;
    if (report_.json()) report_.write().spliced(answer.json);
    report_.text(fmt::format("{} {} {}", name(pair.parts.a), name(pair.parts.b), answer.row));
    // Whoever reads along sees answers soon.
    const auto now = std::chrono::steady_clock::now();
    if (now < flushed_ + between_messages) return;
    report_.flush();
    flushed_ = now;
  }

  ExitStatus finish(const SceneQuestion& question, std::uint64_t pairs, bool exit_code) {
    std::uint64_t answered = 0;
    for (const std::uint64_t count : verdicts_) answered += count;
    const std::uint64_t boxes = pairs - answered;
    std::string sentence = fmt::format("{} pairs: {} separated by boxes", pairs, boxes);
    if (report_.json()) {
      JsonWriter& json = report_.write();
      json.end_array().field("count", count_).field("pairs", pairs).field("separated_by_boxes", boxes);
    }
    for (std::size_t i = 0; i < verdicts_.size(); ++i) {
      const char* const verdict = name_of(static_cast<Verdict>(i));
      if (report_.json()) report_.write().field(verdict, verdicts_[i]);
      if (verdicts_[i] > 0) sentence += fmt::format(", {} {}", verdicts_[i], verdict);
    }
    report_.text(sentence);
    std::vector<AtomicFile*> files;
    if (question.prove) question.prove(report_, files);
    const ExitStatus status = report_.finish(reached_, files);
    if (!exit_code) return status;
    const auto some = [&](Verdict verdict) { return verdicts_[static_cast<std::size_t>(verdict)] > 0; };
    return some(Verdict::intersecting) ? ExitStatus::intersecting
           : some(Verdict::undecided)  ? ExitStatus::undecided
           : some(Verdict::within)     ? ExitStatus::within
                                       : ExitStatus::answered;
  }
  void flush() { report_.flush(); }

 private:
  [[nodiscard]] const std::string& name(std::uint32_t part) const { return loaded_.text.parts[part].name; }

  const LoadedScene& loaded_;
  Report& report_;
  std::array<std::uint64_t, 4> verdicts_{};
  std::uint64_t boxes_ = 0, count_ = 0;
  bool reached_ = true;
  std::chrono::steady_clock::time_point flushed_{};
};

// Options for one of several ranks on a machine: its share of the cores, and --quiet but for rank 0.
PairOptions for_rank(PairOptions options, const Ranks* ranks) {
  if (ranks == nullptr) return options;
  if (options.threads == 0) options.threads = std::max(1, hardware_threads() / ranks->size_of_node());
  options.quiet = options.quiet || ranks->rank() > 0;
  return options;
}

}  // namespace

SceneRun::SceneRun(const PairOptions& options, const WorkMonitor& monitor)
    : monitor_(monitor), ranks_(Ranks::join(options.rank_timeout)) {
  options_ = for_rank(options, ranks_.get());
  if (ranks_ && ranks_->rank() > 0) leave_interruption_to_others();
  const ReadBytes read = [&](const std::string& path) {
    if (!ranks_) return read_file(path, monitor_);
    return ranks_->broadcast(ranks_->rank() == 0 ? read_file(path, monitor_) : std::string());
  };
  reported_once([&] {
    loaded_ = load_scene(options_.scene, options_, options_.nearest_rigid, read, monitor_);
    std::vector<std::string> files;
    for (const SceneMesh& mesh : loaded_.text.meshes) files.push_back(mesh.file);
    units_ = common_units(loaded_.surfaces, files);
  });
}

// All ranks refuse the same bytes: rank 0 tells, and ends all.
void SceneRun::reported_once(const std::function<void()>& work) const {
  try {
    work();
  } catch (const InputError& error) {
    if (!ranks_ || ranks_->rank() == 0) throw;
    report_to_rank_0(error.problem(), error.what());
  }
}

void SceneRun::report_to_rank_0(InputProblem problem, const char* reason) const {
  ranks_->send(0, failure_follows + std::to_string(static_cast<int>(problem)) + reason);
  while (true) static_cast<void>(ranks_->receive(true));
}

void SceneRun::require_closed() const {
  reported_once([&] {
    for (std::size_t i = 0; i < loaded_.surfaces.size(); ++i) {
      naming(loaded_.text.meshes[i].file, [&] { command::require_closed(loaded_.surfaces[i]); });
    }
  });
}

void SceneRun::require_alone() const {
  reported_once([&] {
    if (ranks_) throw InputError(InputProblem::refused, "--certificate does not work with mpirun");
  });
}

double SceneRun::size_of(const PartPair& parts) const {
  return std::max(scene().parts[parts.a].surface().size(), scene().parts[parts.b].surface().size());
}

Sides SceneRun::sides_of(const PartPair& parts) const {
  return {scene().parts[parts.a], scene().parts[parts.b]};
}

SceneAnswer SceneRun::answer_pair(const SceneQuestion& question, const ScenePair& pair, Workspace* workspace,
                                  bool wants_json) const {
  SceneAnswer answer;
  std::string text;
  JsonWriter json([&](std::string_view part) { text += part; }, JsonWriter::Lines::one);
  json.begin_object();
  json.field("a", loaded_.text.parts[pair.parts.a].name).field("b", loaded_.text.parts[pair.parts.b].name);
  JsonWriter* const writer = wants_json ? &json : nullptr;
  workspace ? question.ask(pair, *workspace, answer, writer) : question.separated(pair, answer, writer);
  json.end_object().finish();
  if (wants_json && !answer.row.empty()) answer.json = std::move(text);
  return answer;
}

// Answers some pairs, which go to rank 0 a few times a second: what is lost with a rank is no more than that.
void SceneRun::serve(const SceneQuestion& question, const std::vector<ScenePair>& pairs,
                     Workers<Workspace>& workers) const {
  const bool json = options_.json || !options_.output.empty() || !options_.journal.empty();
  std::vector<std::string> lines(pairs.size());
  std::size_t sent = 0;
  const auto send = [&] {
    std::string bytes(1, answers_follow);
    for (; sent < lines.size() && !lines[sent].empty(); ++sent) bytes += std::exchange(lines[sent], {});
    if (bytes.size() > 1) ranks_->send(0, bytes);
  };
  while (sent < pairs.size()) {
    const auto until = std::chrono::steady_clock::now() + between_messages;
    std::atomic<std::size_t> next{sent}, bytes{0};
    try {
      workers.run([&](Workspace& workspace) {
        do {
          const std::size_t i = next++;
          if (i >= pairs.size()) break;
          monitor_.checkpoint();
          lines[i] = line_of(pairs[i].parts, answer_pair(question, pairs[i], &workspace, json));
          bytes += lines[i].size();
        } while (bytes < max_bytes && std::chrono::steady_clock::now() < until);
      });
    } catch (...) {
      send();
      throw;
    }
    send();
  }
}

// Answers what rank 0 sends, until that is nothing.
void SceneRun::serve(const SceneQuestion& question) {
  try {
    Workers<Workspace> workers(Workspace::of_this_thread(), options_.threads);
    ranks_->send(0, std::string(1, answers_follow));
    while (true) {
      const std::vector<ScenePair> pairs = pairs_of(ranks_->receive(true)->bytes);
      if (pairs.empty()) return;
      serve(question, pairs, workers);
    }
  } catch (const Interrupted&) {
    ranks_->send(0, std::string(1, interruption_follows));
    while (true) static_cast<void>(ranks_->receive(true));
  } catch (const InputError& error) {
    report_to_rank_0(error.problem(), error.what());
  } catch (const std::exception& error) {
    report_to_rank_0(InputProblem::refused, error.what());
  }
}

ExitStatus SceneRun::answer(const SceneQuestion& question, const char* command, bool exit_code) {
  if (ranks_ && ranks_->rank() > 0) {
    serve(question);
    ranks_->leave();
    return ExitStatus::answered;
  }
  Scene scene = loaded_.scene;
  if (!question.margins) scene.margins.clear();
  std::optional<Journal> journal;
  if (!options_.journal.empty()) {
    std::string key = fmt::format("{} {} {} {}", version_number, command, question.margin, question.key);
    for (const SceneMesh& mesh : loaded_.text.meshes) {
      const CommonOptions& own = mesh.options;
      key += fmt::format("\n{}\t{}\t{}\t{}\t{}\t{}", own.scheme, own.boundary, own.sharp, own.weld,
                         own.bounds, own.scale);
    }
    journal.emplace(options_.journal, fingerprint(key, loaded_.fingerprint));
    std::error_code none;
    if (std::filesystem::equivalent(options_.journal, options_.output, none)) {
      throw UsageError("--resume and -o name the same file; the document would replace the journal");
    }
    const Notes notes = notes_for(options_);
    if (notes && journal->found() > 0) {
      notes(fmt::format("{}: {} pairs were answered before", options_.journal, journal->found()));
    }
  }
  Report report(command, options_);
  Results results(loaded_, report);
  results.begin(question, options_.scene);
  const bool json = report.json() || journal.has_value();
  SceneBroadPhase broad(scene, question.margin, question.all_pairs, run_of(options_, monitor_));
  Workers<Workspace> workers(Workspace::of_this_thread(), options_.threads);
  std::vector<int> idle;
  const std::size_t wanted = pairs_of_a_batch * static_cast<std::size_t>(ranks_ ? ranks_->size() : 1);
  // Other ranks would wait for rank 0 between two batches.
  const auto policy = ranks_ ? std::launch::async : std::launch::deferred;
  const auto deal = [&] { return next_batch(broad, scene, wanted); };
  std::future<PairBatch> coming = std::async(policy, deal);
  for (double before = 0;;) {
    const PairBatch now = coming.get();
    const std::vector<ScenePair>& batch = now.pairs;
    if (batch.empty()) break;
    coming = std::async(policy, deal);
    InOrder<SceneAnswer> answers(batch.size(), [&](std::size_t i, SceneAnswer& answer) {
      results.add(batch[i], answer, batch[i].separated_by_boxes());
    });
    std::vector<ScenePair> todo;
    std::vector<std::size_t> places;
    std::vector<double> costs;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (batch[i].separated_by_boxes()) {
        answers.put(i, answer_pair(question, batch[i], nullptr, json));
        continue;
      }
      std::optional<SceneAnswer> known;
      if (journal) known = journal->find(batch[i].parts);
      if (known) {
        answers.put(i, std::move(*known));
      } else {
        todo.push_back(batch[i]);
        places.push_back(i);
        costs.push_back(now.costs[i]);
      }
    }
    std::atomic<std::size_t> done{0};
    const Batch::Ask ask = [&](const ScenePair& pair, Workspace& workspace) {
      monitor_.checkpoint();
      return answer_pair(question, pair, &workspace, json);
    };
    const Batch::Put put = [&](std::size_t i, SceneAnswer answer) {
      if (const std::size_t before_it = done++; before_it % 64 == 0) {
        monitor_.report(before + (now.share - before) * static_cast<double>(before_it) /
                                     static_cast<double>(todo.size()));
      }
      if (journal) journal->add(todo[i].parts, answer);
      answers.put(places[i], std::move(answer));
    };
    Batch(todo, std::move(costs), ranks_.get(), workers, monitor_, ask, put).run(idle);
    results.flush();
    before = now.share;
  }
  const ExitStatus status = results.finish(question, broad.pair_count(), exit_code);
  if (ranks_) {
    // Ranks that have not yet reported are waited for.
    while (idle.size() + 1 < static_cast<std::size_t>(ranks_->size())) {
      const Ranks::Message message = *ranks_->receive(true);
      throw_failure(message);
      static_cast<void>(answers_of(message, {}));
      idle.push_back(message.from);
    }
    for (const int rank : idle) ranks_->send(rank, {});
    ranks_->leave();
  }
  return status;
}

}  // namespace snug::command
