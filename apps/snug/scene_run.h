#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <support/workers.h>

#include "placed_pair.h"
#include "ranks.h"
#include "scene_answer.h"
#include "scene_file.h"
#include "witness.h"

namespace snug::command {

/// The question that a command asks about every pair of a scene.
struct SceneQuestion {
  std::string key;         ///< all options that answers depend on, but those of meshes; for journals
  double margin = 0;       ///< of pairs without their own
  bool margins = true;     ///< do the scene's own margins count?
  bool all_pairs = false;  ///< list pairs that are separated by their boxes too
  std::string header;      ///< of rows for people
  /// Fills the answer of a pair; its row, and its fields if `json` is not null. Called by several threads.
  std::function<void(const ScenePair&, Workspace&, SceneAnswer&, JsonWriter* json)> ask;
  /// The same for a pair that is separated by its boxes; with all_pairs.
  std::function<void(const ScenePair&, SceneAnswer&, JsonWriter* json)> separated;
  std::function<void(JsonWriter&)> head;  ///< writes what stands in front of the results
  /// Proves the answers, if they are to be proved, and adds the file of the proof.
  std::function<void(Report&, std::vector<AtomicFile*>&)> prove;
};

/// Answers that are to be proved, of all threads.
template <class PairAnswer>
class KeptAnswers {
 public:
  void add(PairAnswer answer) {
    const std::lock_guard lock(mutex_);
    answers_.push_back(std::move(answer));
  }
  /// When all threads are done.
  [[nodiscard]] const std::vector<PairAnswer>& all() const { return answers_; }

 private:
  std::mutex mutex_;
  std::vector<PairAnswer> answers_;
};

/// A command about a scene: on this process's threads, or on all that mpirun started, of which rank 0 reads files, deals out
/// pairs by their estimated cost, answers its share, and writes.
///
/// Guarantee: the same document for any number of threads and ranks, and for a run that goes on from a journal; only `seconds`
///            differs.
class SceneRun {
 public:
  /// Reads the scene and its meshes.
  /// Errors:    those of load_scene(); InputError for MPI that does not work.
  SceneRun(const PairOptions& options, const WorkMonitor& monitor);

  [[nodiscard]] const LoadedScene& loaded() const { return loaded_; }
  [[nodiscard]] const Scene& scene() const { return loaded_.scene; }
  /// For --solid.
  /// Errors:    InputError (refused) that names the mesh which is not closed.
  void require_closed() const;
  /// For --certificate.
  /// Errors:    InputError (refused) under mpirun, whose ranks do not send what proofs need.
  void require_alone() const;
  /// Metres of a unit, if all meshes have the same one.
  [[nodiscard]] std::optional<double> units() const { return units_; }
  /// The larger size of both parts.
  [[nodiscard]] double size_of(const PartPair& parts) const;
  [[nodiscard]] Sides sides_of(const PartPair& parts) const;

  /// Answers all pairs, to the end of the report.
  /// Returns:   with `exit_code` the status of the gravest verdict: intersecting, undecided, within, separated.
  /// Errors:    InputError, of whichever rank; Interrupted. What a journal holds stays.
  [[nodiscard]] ExitStatus answer(const SceneQuestion& question, const char* command, bool exit_code);

 private:
  void reported_once(const std::function<void()>& work) const;
  [[noreturn]] void report_to_rank_0(InputProblem problem, const char* reason) const;
  void serve(const SceneQuestion& question);
  void serve(const SceneQuestion& question, const std::vector<ScenePair>& pairs,
             Workers<Workspace>& workers) const;
  [[nodiscard]] SceneAnswer answer_pair(const SceneQuestion& question, const ScenePair& pair,
                                        Workspace* workspace, bool json) const;

  PairOptions options_;
  WorkMonitor monitor_;
  std::unique_ptr<Ranks> ranks_;
  LoadedScene loaded_;
  std::optional<double> units_;
};

}  // namespace snug::command
