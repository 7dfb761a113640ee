// bench_flat: triangle meshes as they are, by the flat scheme, beside FCL on the same triangles in the same
// poses. Files: the triangle models of examples/models.

#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <snug/evaluate.h>

#include "peers.h"

namespace {

using namespace snug;
using namespace snug::bench;

// Two meshes for both.
struct Pair {
  LimitSurface a, b;
  Queries queries;
  FclPair boxes, distances;

  static TriangleMesh triangles(const ControlMesh& mesh) {
    TriangleMesh result{mesh.points, {}};
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      const auto face = mesh.face(FaceId(f));
      result.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
    }
    return result;
  }
  Pair(const ControlMesh& mesh_a, const ControlMesh& mesh_b, const std::shared_ptr<BoundsCache>& library)
      : a(mesh_a, {Scheme::flat}, library),
        b(mesh_b, {Scheme::flat}, library),
        queries(a, b),
        boxes(triangles(mesh_a), triangles(mesh_b), FclBoxes::obb),
        distances(triangles(mesh_a), triangles(mesh_b), FclBoxes::obbrss) {}
};

// A question about all pairs of meshes, by both.
template <class Ask, class AskPeer>
void measure(const std::string& title, std::vector<std::unique_ptr<Pair>>& pairs,
             const std::vector<std::vector<PosePair>>& at, const Options& options, const Ask& ask,
             const AskPeer& ask_peer) {
  double items = 0;
  for (const auto& poses : at) items += static_cast<double>(poses.size());
  if (items == 0) return;
  Group group(title, "query", options);
  const auto run = [&](const auto& question) {
    double sum = 0;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      for (const PosePair& pose : at[p]) sum += question(*pairs[p], pose);
    }
    return sum;
  };
  group.add("snug, flat", items, [&] { return run(ask); });
  group.add("FCL", items, [&] { return run(ask_peer); });
  const std::vector<Times> times = group.run();
  std::printf("# %s: FCL over snug %.2f\n", title.c_str(), times[1].median / times[0].median);
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 7, " SEVEN-MODELS");
  const std::vector<Model> models = read_models(options.files);
  for (const unsigned level : {0u, options.size(2u, 1u)}) {
    const auto library = std::make_shared<BoundsCache>();
    std::vector<std::unique_ptr<Pair>> pairs;
    std::vector<std::vector<PosePair>> meeting, apart;
    std::size_t faces = 0, agree = 0, count = 0;
    double most = 0;
    for (const auto& [a, b] : model_pairs) {
      const ControlMesh mesh_a = subdivided(named(models, a).mesh, level),
                        mesh_b = subdivided(named(models, b).mesh, level);
      faces += mesh_a.face_count() + mesh_b.face_count();
      Pair& pair = *pairs.emplace_back(std::make_unique<Pair>(mesh_a, mesh_b, library));
      meeting.emplace_back();
      apart.emplace_back();
      std::mt19937_64 random(4);
      for (int i = 0; i < options.size(600, 40); ++i) {
        const PosePair at = place_in_room(1.9, random);
        const Collision found = pair.queries.collide(at, 1e-9);
        (found.verdict == Verdict::separated ? apart : meeting).back().push_back(at);
        ++count;
        agree += pair.boxes.collide(at) == (found.verdict != Verdict::separated);
        if (found.verdict == Verdict::separated) {
          const Distance distance = pair.queries.distance(at, 1e-9);
          const double theirs = pair.distances.distance(at);
          most = std::max({most, distance.distance.lower - theirs, theirs - distance.distance.upper});
        }
      }
    }
    std::printf(
        "# level %u: %zu triangles in all; FCL has the same verdict in %zu of %zu, its distance is outside "
        "of "
        "snug's interval by %.3g at most\n",
        level, faces, agree, count, most);
    const std::string size = ", level " + std::to_string(level);
    const auto collide = [](Pair& pair, const PosePair& at) {
      return pair.queries.collide(at, 1e-9).verdict == Verdict::separated ? 0.0 : 1.0;
    };
    const auto distance = [](Pair& pair, const PosePair& at) {
      return pair.queries.distance(at, 1e-6).distance.upper;
    };
    const auto peer_collides = [](Pair& pair, const PosePair& at) {
      return pair.boxes.collide(at) ? 1.0 : 0.0;
    };
    const auto peer_distance = [](Pair& pair, const PosePair& at) { return pair.distances.distance(at); };
    measure("collide, meshes that meet" + size, pairs, meeting, options, collide, peer_collides);
    measure("collide, meshes apart" + size, pairs, apart, options, collide, peer_collides);
    measure("distance to 1e-6, meshes apart" + size, pairs, apart, options, distance, peer_distance);
  }
  return 0;
}
