// bench_scenes: scenes of many parts: broad and narrow phase, cost against the number of parts, FCL's manager on the same
// scenes, threads and ranks. Files: ring and other models of examples/models.

#include "scenes.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include <snug/scene.h>
#include <snug/tessellate.h>
#include <support/direction.h>
#include <support/number.h>

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

namespace {

// Rings of points one after the other, joined by quads: a torus, or a tube with two caps.
ControlMesh joined_rings(const std::vector<std::vector<Point3>>& rings, bool closed) {
  ControlMesh mesh;
  const std::size_t size = rings[0].size();
  const auto at = [&](std::size_t ring, std::size_t i) {
    return VertexId(static_cast<std::uint32_t>(ring % rings.size() * size + i % size));
  };
  for (const std::vector<Point3>& ring : rings)
    mesh.points.insert(mesh.points.end(), ring.begin(), ring.end());
  for (std::size_t ring = 0; ring + (closed ? 0 : 1) < rings.size(); ++ring) {
    for (std::size_t i = 0; i < size; ++i) {
      mesh.add_face(std::array{at(ring, i), at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)});
    }
  }
  return mesh;
}

// Outside and inside of a wheel, below and above. Teeth are at every thirty degrees from zero on.
ControlMesh gear() {
  constexpr int teeth = 12, steps = 4 * teeth;
  std::vector<std::vector<Point3>> rings(4);
  for (int i = 0; i < steps; ++i) {
    const double angle = 2 * std::numbers::pi * (i - 0.5) / steps, outside = i % 4 < 2 ? 1.16 : 0.86;
    for (std::size_t k = 0; k < 4; ++k) {
      const double radius = k < 2 ? outside : 0.35;
      rings[k].push_back(
          {radius * std::cos(angle), radius * std::sin(angle), k == 0 || k == 3 ? -0.15 : 0.15});
    }
  }
  return joined_rings(rings, true);
}

// A tube of length 1 along x with round ends.
ControlMesh link() {
  constexpr int around = 8;
  std::vector<std::vector<Point3>> rings;
  for (const auto& [x, radius] :
       {std::pair{-0.55, 0.15}, {-0.5, 0.3}, {-0.2, 0.3}, {0.2, 0.3}, {0.5, 0.3}, {0.55, 0.15}}) {
    std::vector<Point3>& ring = rings.emplace_back();
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      ring.push_back({x, radius * std::cos(angle), radius * std::sin(angle)});
    }
  }
  ControlMesh mesh = joined_rings(rings, false);
  std::vector<VertexId> first, last;
  for (std::uint32_t i = 0; i < around; ++i) {
    first.emplace_back(around - 1 - i);
    last.emplace_back(static_cast<std::uint32_t>(mesh.points.size()) - around + i);
  }
  mesh.add_face(first);
  mesh.add_face(last);
  return mesh;
}

ControlMesh sheet() {
  constexpr std::uint32_t side = 24;
  ControlMesh mesh;
  for (std::uint32_t j = 0; j <= side; ++j) {
    for (std::uint32_t i = 0; i <= side; ++i) {
      const double x = static_cast<double>(i) / side - 0.5, y = static_cast<double>(j) / side - 0.5;
      mesh.points.push_back({x, y, 0.02 * std::sin(14 * x + 3 * std::sin(5 * y)) + 0.01 * std::sin(17 * y)});
    }
  }
  const auto at = [](std::uint32_t i, std::uint32_t j) { return VertexId(j * (side + 1) + i); };
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      mesh.add_face(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

std::uint32_t made(MadeModel model) { return static_cast<std::uint32_t>(model); }

}  // namespace

std::vector<Model> make_models() { return {{"gear", gear()}, {"link", link()}, {"sheet", sheet()}}; }

ModelScene gear_train(std::size_t parts) {
  constexpr std::size_t row = 10, train = row * row, times = 10;
  constexpr double tooth = 30;
  ModelScene scene;
  for (std::size_t i = 0; i < parts; ++i) {
    const std::size_t x = i % row, y = i / row % row, time = i / train;
    const double turn = tooth * static_cast<double>(time) / times;
    // Every other one turns the other way, its gaps where the teeth of its neighbours are.
    const double angle = (x + y) % 2 == 0 ? turn : tooth / 2 - turn;
    scene.push_back(
        {made(MadeModel::gear), Motion::rotation_degrees({0, 0, 1}, angle)
                                    .with_offset({2 * static_cast<double>(x), 2 * static_cast<double>(y),
                                                  0.4 * static_cast<double>(time)})});
  }
  return scene;
}

ModelScene hose(std::size_t parts) {
  // Of a thousand links of length 1.
  const double scale = std::sqrt(static_cast<double>(parts) / 1000), large = 7 * scale, small = 2.4 * scale;
  const double windings = static_cast<double>(parts) / (2 * std::numbers::pi * small);
  ModelScene scene;
  for (std::size_t i = 0; i < parts; ++i) {
    const double t = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(parts),
                 s = windings * t;
    const double radius = large + small * std::cos(s);
    const Vector3 at{radius * std::cos(t), radius * std::sin(t), small * std::sin(s)};
    // Along the winding; the quarter turn about its own axis is whatever comes out.
    const Vector3 x = normalized(Vector3{-small * windings * std::sin(s) * std::cos(t) - radius * std::sin(t),
                                         -small * windings * std::sin(s) * std::sin(t) + radius * std::cos(t),
                                         small * windings * std::cos(s)});
    const Vector3 y = normalized(cross({0.1, 0.2, 1}, x)), z = cross(x, y);
    scene.push_back({made(MadeModel::link),
                     Motion::from_3x4({x.x, y.x, z.x, at.x, x.y, y.y, z.y, at.y, x.z, y.z, z.z, at.z})});
  }
  return scene;
}

ModelScene sheets(std::size_t parts) {
  ModelScene scene;
  const auto row = static_cast<std::size_t>(std::cbrt(static_cast<double>(parts)));
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (std::size_t i = 0; i < parts; ++i) {
    const auto x = static_cast<double>(i % row), y = static_cast<double>(i / row % row),
               z = static_cast<double>(i / (row * row));
    scene.push_back({made(MadeModel::sheet), Motion::rotation_degrees({0, 0, 1}, 3 * unit(random))
                                                 .with_offset({0.97 * x + 0.01 * unit(random),
                                                               0.97 * y + 0.01 * unit(random), 0.06 * z})});
  }
  return scene;
}

namespace {

struct NamedScene {
  std::string name;
  ModelScene parts;
  std::vector<Model> models;
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
  return collide(scene, options, [](const PairCollision&) {}, {.threads = threads});
}
double meeting(const SceneCounts& counts) { return static_cast<double>(counts.within + counts.intersecting); }

std::vector<Surface> surfaces_of(const std::vector<Model>& models) {
  std::vector<Surface> surfaces;
  for (const Model& model : models) surfaces.emplace_back(model.mesh, SurfaceOptions{}, Run{.threads = 1});
  return surfaces;
}

std::size_t near_pairs(const Scene& scene) {
  SceneBroadPhase broad(scene, 0, false, {.threads = 1});
  std::size_t near = 0;
  for (std::vector<ScenePair> batch; !(batch = broad.next(16384)).empty();) near += batch.size();
  return near;
}

void measure_kinds(const std::vector<NamedScene>& scenes, const Options& options) {
  for (const NamedScene& named : scenes) {
    const std::vector<Surface> surfaces = surfaces_of(named.models);
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
  const Tessellation fine = tessellate(Surface(model.mesh, {}, {.threads = 1}),
                                       {.error = tolerance, .normals = false}, {.threads = 1});
  return {fine.positions, fine.triangles};
}

// From control meshes to the count of pairs that meet: what is prepared is made anew each time.
void measure_fcl(const std::vector<NamedScene>& scenes, const Options& options) {
  for (const NamedScene& named : scenes) {
    const std::vector<Model>& models = named.models;
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

// Seconds that the command tells, without the start of processes and the reading of files. It writes into a file: what mpirun
// passes on goes through a terminal.
double seconds_of(const std::string& line, const std::string& file) {
  FILE* const pipe =
      popen((line + " -o " + file + " && tail -n 3 " + file + " | grep -o 'seconds.*'").c_str(), "r");
  double seconds = INFINITY;
  if (std::fscanf(pipe, "seconds\": %lf", &seconds) != 1) std::printf("# failed: %s\n", line.c_str());
  pclose(pipe);
  return seconds;
}

void measure_ranks(const std::vector<Model>& models, const std::vector<std::string>& files,
                   const Options& options) {
  if (std::system("mpirun --version > /dev/null 2>&1") != 0) {
    std::printf("# ranks: no mpirun\n");
    return;
  }
  const std::string file = (std::filesystem::temp_directory_path() / "snug-bench-scene.json").string();
  constexpr double spread = 3;  // the files' models are larger than 1
  write_scene(file, files, models, packed_scene(options.size(12'000u, 200u), 1, models.size(), 5), spread);
  const std::string snug = SNUG_COMMAND " collide --json --quiet --threads 1 --scene " + file;
  const std::string start =
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n 2 ";
  const std::string answers = (std::filesystem::temp_directory_path() / "snug-bench-answers.json").string();
  double one = INFINITY, two = INFINITY;
  for (int round = 0; round < options.rounds; ++round) {
    one = std::min(one, seconds_of(snug, answers));
    two = std::min(two, seconds_of(start + snug, answers));
  }
  std::printf("# ranks: one process %.3f s, two ranks %.3f s (least of %d)\n", one, two, options.rounds);
  at_least("two ranks, times as fast on the clock", one / two, 1.7);
  std::filesystem::remove(file);
  std::filesystem::remove(answers);
}

}  // namespace
}  // namespace snug::bench

int main(int argc, char** argv) {
  using namespace snug::bench;
  const Options options = start(argc, argv, any_files, " MODELS");
  const std::vector<Model> models = read_models(options.files);
  const std::size_t parts = options.size(1000u, 100u), read = models.size();
  // Each with the models that it has, so that no others are prepared.
  const std::vector<NamedScene> scenes{{"packed loosely", packed_scene(parts, 0.5, read, 1), models},
                                       {"packed", packed_scene(parts, 1, read, 1), models},
                                       {"packed densely", packed_scene(parts, 4, read, 1), models},
                                       {"robot cell", robot_cell(parts, read, 2), models},
                                       {"gear train", gear_train(parts), make_models()},
                                       {"hose", hose(parts), make_models()},
                                       {"sheets", sheets(parts), make_models()}};
  measure_kinds(scenes, options);
#ifdef SNUG_BENCH_FCL
  measure_fcl(scenes, options);
#endif
  measure_sizes(models, options);
  measure_threads(models, options);
  measure_ranks(models, options.files, options);
  return 0;
}
