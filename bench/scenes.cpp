// bench_scenes: scenes of many parts: broad and narrow phase, cost against the number of parts, FCL's manager on the same
// scenes, threads and ranks. Files: ring and other models of examples/models.

#include "scenes.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include <snug/io/number.h>
#include <snug/scene.h>
#include <snug/tessellate.h>

#ifdef SNUG_BENCH_FCL
#include "peer_fcl_scene.h"
#endif

namespace snug::bench {
namespace {

Motion turned(std::mt19937_64& random, const Vector3& to) {
  std::normal_distribution<double> normal;
  return Motion::from_quaternion({normal(random), normal(random), normal(random), normal(random)}, to);
}

}  // namespace

ModelScene packed_scene(std::size_t parts, double density, std::size_t models, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const double side = std::cbrt(static_cast<double>(parts) / density);
  std::uniform_real_distribution<double> unit(0, side);
  ModelScene scene;
  while (scene.size() < parts) {
    const Vector3 to{unit(random), unit(random), unit(random)};
    scene.push_back({static_cast<std::uint32_t>(random() % models), turned(random, to)});
  }
  return scene;
}

ModelScene gear_train(std::size_t parts) {
  const auto row = static_cast<std::size_t>(std::sqrt(static_cast<double>(parts)));
  ModelScene scene;
  for (std::size_t i = 0; i < parts; ++i) {
    const auto x = static_cast<double>(i % row), y = static_cast<double>(i / row);
    scene.push_back(
        {0, Motion::rotation_degrees({0, 0, 1}, i % 2 == 0 ? 0 : 180).with_offset({1.01 * x, 1.01 * y, 0})});
  }
  return scene;
}

ModelScene robot_cell(std::size_t parts, std::size_t models, std::uint64_t seed) {
  ModelScene scene = packed_scene(parts / 2, 0.3, models - 1, seed);
  const double side = std::cbrt(static_cast<double>(parts / 2) / 0.3);
  std::mt19937_64 random(seed);
  const Motion turn = turned(random, {});
  while (scene.size() < parts) {
    const double t = static_cast<double>(scene.size() - parts / 2) / static_cast<double>(parts / 2);
    const double angle = 20 * t, radius = 0.4 * side;
    const Vector3 to{0.5 * side + radius * std::cos(angle), 0.5 * side + radius * std::sin(angle), side * t};
    scene.push_back({static_cast<std::uint32_t>(models - 1),
                     (Motion::rotation({0, 0, 1}, angle) * turn).with_offset(to)});
  }
  return scene;
}

ModelScene layers(std::size_t parts) {
  ModelScene scene;
  const auto row = static_cast<std::size_t>(std::cbrt(static_cast<double>(parts)));
  for (std::size_t i = 0; i < parts; ++i) {
    const auto x = static_cast<double>(i % row), y = static_cast<double>(i / row % row),
               z = static_cast<double>(i / (row * row));
    scene.push_back({0, Motion::translation({0.97 * x, 0.97 * y, 0.35 * z + 0.01 * x})});
  }
  return scene;
}

namespace {

struct NamedScene {
  std::string name;
  ModelScene parts;
};

constexpr double tolerance = 1e-3;  // models have size 1

Scene scene_of(const std::vector<Surface>& surfaces, const ModelScene& parts) {
  Scene scene;
  for (const PlacedModel& part : parts) scene.parts.push_back(surfaces[part.model].at(part.pose));
  return scene;
}

CollideOptions all_answers() { return {.tolerance = tolerance}; }
CollideOptions verdicts() { return {.tolerance = tolerance, .witness = WitnessKind::none, .measure = false}; }
// As much as triangles within the tolerance can tell.
CollideOptions contacts() {
  CollideOptions options = verdicts();
  options.prove_contact = false;
  return options;
}

SceneCounts count(const Scene& scene, const CollideOptions& options, int threads = 1) {
  return collide(
      scene, options, [](const PairCollision&) {}, threads);
}
double meeting(const SceneCounts& counts) { return static_cast<double>(counts.within + counts.intersecting); }

std::vector<Surface> surfaces_of(const std::vector<Model>& models) {
  std::vector<Surface> surfaces;
  for (const Model& model : models) surfaces.emplace_back(model.mesh, SurfaceOptions{.threads = 1});
  return surfaces;
}

std::size_t near_pairs(const Scene& scene) {
  SceneBroadPhase broad(scene, 0, false, 1);
  std::size_t near = 0;
  for (std::vector<ScenePair> batch; !(batch = broad.next(16384)).empty();) near += batch.size();
  return near;
}

void measure_kinds(const std::vector<Model>& models, const std::vector<NamedScene>& scenes,
                   const Options& options) {
  const std::vector<Surface> surfaces = surfaces_of(models);
  for (const NamedScene& named : scenes) {
    const Scene scene = scene_of(surfaces, named.parts);
    const SceneCounts counts = count(scene, all_answers());
    std::printf(
        "# %s: %zu parts, %zu pairs, %zu separated by boxes, %zu separated, %zu within, %zu intersecting, "
        "%zu undecided\n",
        named.name.c_str(), scene.parts.size(), std::size_t{counts.pairs},
        std::size_t{counts.separated_by_boxes}, std::size_t{counts.separated}, std::size_t{counts.within},
        std::size_t{counts.intersecting}, std::size_t{counts.undecided});
    Group group(named.name + ", warm, one thread", "scene", options);
    group.add("broad phase", 1, [&] { return static_cast<double>(near_pairs(scene)); });
    group.add("verdicts", 1, [&] { return meeting(count(scene, verdicts())); });
    group.add("answers with bounds and witnesses", 1, [&] { return meeting(count(scene, all_answers())); });
    const std::vector<Times> times = group.run();
    at_most(named.name + ": broad and narrow phase, seconds", times[2].median, 1);
  }
}

void measure_sizes(const std::vector<Model>& models, const Options& options) {
  const std::vector<Surface> surfaces = surfaces_of(models);
  for (const std::size_t parts : options.size(std::vector<std::size_t>{1000, 10'000, 100'000}, {100, 1000})) {
    const ModelScene placed = packed_scene(parts, 0.5, models.size(), 3);
    const Scene scene = scene_of(surfaces, placed);
    Group group("packed loosely, " + std::to_string(parts) + " parts", "part", options);
    group.limit_rounds(3);
    const auto items = static_cast<double>(parts);
    group.add("broad phase", items, [&] { return static_cast<double>(near_pairs(scene)); });
    group.add("verdicts", items, [&] { return meeting(count(scene, verdicts())); });
    group.run();
    print_peak("broad phase, " + std::to_string(parts) + " parts", items, "part",
               peak_mib([&] { return static_cast<double>(near_pairs(scene)); }));
  }
}

void measure_threads(const std::vector<Model>& models, const Options& options) {
  const std::vector<Surface> surfaces = surfaces_of(models);
  const Scene scene = scene_of(surfaces, packed_scene(options.size(10'000u, 500u), 1, models.size(), 4));
  Group group("packed, answers", "scene", options);
  for (const int threads : {1, 2}) {
    group.add(std::to_string(threads) + " threads", 1,
              [&, threads] { return meeting(count(scene, all_answers(), threads)); });
  }
  const std::vector<Times> times = group.run();
  at_least("two threads, times as fast on the clock", times[0].wall / times[1].wall, 1.7);
}

#ifdef SNUG_BENCH_FCL
TriangleMesh triangles_of(const Model& model) {
  const Tessellation fine = tessellate(Surface(model.mesh, {.threads = 1}),
                                       {.tolerance = tolerance, .normals = false, .threads = 1});
  return {fine.positions, fine.triangles};
}

// From control meshes to the count of pairs that meet: what is prepared is made anew each time.
void measure_fcl(const std::vector<Model>& models, const std::vector<NamedScene>& scenes,
                 const Options& options) {
  for (const NamedScene& named : scenes) {
    Group group(named.name + ", from meshes to verdicts", "scene", options);
    group.limit_rounds(3);
    group.add("snug", 1,
              [&] { return meeting(count(scene_of(surfaces_of(models), named.parts), contacts())); });
    std::vector<FclScene::Part> parts;
    for (const PlacedModel& part : named.parts) parts.push_back({part.model, part.pose});
    std::vector<TriangleMesh> ready;
    std::size_t triangles = 0;
    for (const Model& model : models) triangles += ready.emplace_back(triangles_of(model)).triangles.size();
    group.add("FCL, tessellated each time", 1, [&] {
      std::vector<TriangleMesh> meshes;
      for (const Model& model : models) meshes.push_back(triangles_of(model));
      return static_cast<double>(FclScene(meshes, parts).meeting());
    });
    group.add("FCL, triangles at hand", 1,
              [&] { return static_cast<double>(FclScene(ready, parts).meeting()); });
    const std::vector<Surface> surfaces = surfaces_of(models);
    const Scene scene = scene_of(surfaces, named.parts);
    static_cast<void>(count(scene, contacts()));
    group.add("snug, warm", 1, [&] { return meeting(count(scene, contacts())); });
    const FclScene fcl(ready, parts);
    group.add("snug, from meshes, contact proved", 1,
              [&] { return meeting(count(scene_of(surfaces_of(models), named.parts), verdicts())); });
    group.add("FCL, warm", 1, [&] { return static_cast<double>(fcl.meeting()); });
    const std::vector<Times> times = group.run();
    std::printf("# %zu triangles in %zu meshes\n", triangles, models.size());
    at_least(named.name + ": times as fast as FCL, preparation included", times[1].median / times[0].median,
             5);
    std::printf("# FCL over snug: triangles at hand %.2f, warm %.2f, contact proved %.2f\n",
                times[2].median / times[0].median, times[5].median / times[3].median,
                times[1].median / times[4].median);
  }
}
#endif

// The scene as a file for the command.
void write_scene(const std::string& path, const std::vector<std::string>& files,
                 const std::vector<Model>& models, const ModelScene& parts, double spread) {
  std::ofstream out(path);
  out << "{\"parts\": [";
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::string file;
    for (const std::string& candidate : files) {
      if (candidate.find(models[parts[i].model].name) != std::string::npos)
        file = std::filesystem::absolute(candidate);
    }
    out << (i ? ",\n" : "\n") << R"({"mesh": ")" << file << R"(", "place": [)";
    std::array<double, 12> numbers = parts[i].pose.numbers();
    for (std::size_t k = 0; k < 12; ++k) {
      std::string text;
      append_real(text, k % 4 == 3 ? spread * numbers[k] : numbers[k]);
      out << (k ? ", " : "") << text;
    }
    out << "]}";
  }
  out << "\n]}\n";
}

// Seconds that the command tells, without the start of processes and the reading of files; least of some runs.
double seconds_of(const std::string& line, int rounds) {
  double least = INFINITY;
  for (int round = 0; round < rounds; ++round) {
    FILE* const pipe = popen((line + " | tail -n 3 | grep -o 'seconds.*'").c_str(), "r");
    double seconds = INFINITY;
    if (std::fscanf(pipe, "seconds\": %lf", &seconds) != 1) std::printf("# failed: %s\n", line.c_str());
    pclose(pipe);
    least = std::min(least, seconds);
  }
  return least;
}

void measure_ranks(const std::vector<Model>& models, const std::vector<std::string>& files,
                   const Options& options) {
  if (std::system("mpirun --version > /dev/null 2>&1") != 0) {
    std::printf("# ranks: no mpirun\n");
    return;
  }
  const std::string file = (std::filesystem::temp_directory_path() / "snug-bench-scene.json").string();
  constexpr double spread = 3;  // the files' models are larger than 1
  write_scene(file, files, models, packed_scene(options.size(3000u, 200u), 1, models.size(), 5), spread);
  const std::string snug = SNUG_COMMAND " collide --json --threads 1 --scene " + file;
  const std::string start =
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n 2 ";
  const double one = seconds_of(snug, options.rounds), two = seconds_of(start + snug, options.rounds);
  std::printf("# ranks: one process %.3f s, two ranks %.3f s (least of %d)\n", one, two, options.rounds);
  at_least("two ranks, times as fast on the clock", one / two, 1.7);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace snug::bench

int main(int argc, char** argv) {
  using namespace snug::bench;
  const Options options = start(argc, argv, any_files, " MODELS");
  const std::vector<Model> models = read_models(options.files);
  const std::size_t parts = options.size(1000u, 100u);
  const std::vector<NamedScene> scenes{{"packed loosely", packed_scene(parts, 0.5, models.size(), 1)},
                                       {"packed", packed_scene(parts, 1, models.size(), 1)},
                                       {"packed densely", packed_scene(parts, 4, models.size(), 1)},
                                       {"gear train", gear_train(parts)},
                                       {"robot cell", robot_cell(parts, models.size(), 2)},
                                       {"layers", layers(parts)}};
  measure_kinds(models, scenes, options);
#ifdef SNUG_BENCH_FCL
  measure_fcl(models, scenes, options);
#endif
  measure_sizes(models, options);
  measure_threads(models, options);
  measure_ranks(models, options.files, options);
  return 0;
}
