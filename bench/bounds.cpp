// bench_bounds A B: what bounds cost beside the cheapest baseline, the box of the control points, and what queries cost.
// Runs alternate; medians of seven; the checksum shows that the work was done and did not change.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include <snug/enclose/interval_triangle.h>
#include <snug/io/mesh_file.h>
#include <snug/query/collide.h>
#include <snug/query/subdivide.h>

namespace {

using namespace snug;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Contestant {
  const char* name;
  std::function<double()> work;  // returns a checksum
  std::vector<double> seconds;
  double checksum = 0;
};

void alternate(std::vector<Contestant>& contestants, double items, const char* item) {
  for (Contestant& c : contestants) c.checksum = c.work();  // warm: kinds and rows are made
  for (int round = 0; round < 7; ++round) {
    for (Contestant& c : contestants) c.seconds.push_back(seconds_of([&] { c.checksum = c.work(); }));
  }
  const double baseline = median(contestants.front().seconds);
  for (const Contestant& c : contestants) {
    const double t = median(c.seconds);
    std::printf("  %-34s %8.3f us a %s, %6.2f times the first, checksum %.17g\n", c.name, 1e6 * t / items,
                item, t / baseline, c.checksum);
  }
}

void bench_patches(const char* title, const Surface& surface) {
  std::printf("%s: %zu patches, %zu kinds\n", title, surface.face_count(), surface.kind_count());
  HullPoints points;
  const auto each = [&](const std::function<double(const Patch&)>& measure) {
    double sum = 0;
    for (std::size_t f = 0; f < surface.face_count(); ++f) sum += measure(surface.patch(FaceId(f)));
    return sum;
  };
  std::vector<Contestant> contestants{
      {"box of the control points",
       [&] {
         return each([&](const Patch& patch) {
           control_points(patch, points);
           return outer_box(points).longest_side();
         });
       },
       {}},
      {"offset triangle from hull rows",
       [&] {
         return each([&](const Patch& patch) {
           return make_piece(surface.library(), FaceId(0), patch, points).offset.radius;
         });
       },
       {}}};
  alternate(contestants, static_cast<double>(surface.face_count()), "patch");
}

CornerFan inside(std::size_t valence) { return {0, static_cast<std::uint16_t>(valence - 1), true, false}; }

// What a kind costs that was never met: the kind itself, its descendants' matrices, and its rows.
void bench_new_kinds() {
  std::printf("a new kind, cold library\n");
  struct Case {
    const char* name;
    std::array<CornerFan, 3> corners;
  };
  for (const Case& c : {Case{"valences 6 6 6", {inside(6), inside(6), inside(6)}},
                        {"valences 6 6 7", {inside(6), inside(6), inside(7)}},
                        {"valences 6 6 12", {inside(6), inside(6), inside(12)}},
                        {"valences 7 8 9", {inside(7), inside(8), inside(9)}},
                        {"valences 6 6 50", {inside(6), inside(6), inside(50)}},
                        {"valences 6 6 500", {inside(6), inside(6), inside(500)}}}) {
    std::vector<double> seconds;
    std::size_t rows = 0;
    for (int round = 0; round < 7; ++round) {
      seconds.push_back(seconds_of([&] {
        BoundLibrary library;
        rows = library.rows(library.kinds().find({Scheme::loop, c.corners})).count();
      }));
    }
    std::printf("  %-34s %8.3f ms, %zu rows\n", c.name, 1e3 * median(seconds), rows);
  }
}

Placement random_placement(std::mt19937_64& random, double half_room) {
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  double q[4], norm = 0;
  do {
    norm = 0;
    for (double& x : q) {
      x = unit();
      norm += x * x;
    }
  } while (norm > 1 || norm < 0.01);
  for (double& x : q) x /= std::sqrt(norm);
  const auto [w, x, y, z] = std::to_array(q);
  return {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), half_room * unit(),
           2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), half_room * unit(),
           2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), half_room * unit()}};
}

void bench_queries(const Surface& a, const Surface& b) {
  const CollisionModel model_a(a, 1), model_b(b, 1);
  CollideScratch scratch(model_a, model_b);
  const double size = std::max(a.size(), b.size());
  constexpr int count = 5000;
  for (const double room : {6.0, 3.0}) {
    std::printf("collide in a room of side %g sizes, %d placements\n", room, count);
    std::vector<Contestant> contestants;
    for (const double tolerance : {0.02, 0.01, 0.001}) {
      contestants.push_back(
          {tolerance == 0.02   ? "tolerance 2 %"
           : tolerance == 0.01 ? "tolerance 1 %"
                               : "tolerance 0.1 %",
           [&, tolerance] {
             std::mt19937_64 random(7);
             double within = 0;
             for (int i = 0; i < count; ++i) {
               const Placement place_a = random_placement(random, (room - 1) / 2 * size);
               const Placement place_b = random_placement(random, (room - 1) / 2 * size);
               within +=
                   collide(model_a, place_a, model_b, place_b, {tolerance * size, 0}, scratch).verdict ==
                   Verdict::within;
             }
             return within;
           },
           {}});
    }
    alternate(contestants, count, "query");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: bench_bounds A B\n");
    return 2;
  }
  const auto library = std::make_shared<BoundLibrary>();
  const ControlMesh mesh = read_mesh(argv[1]);
  const SchemeOptions rules;
  bench_new_kinds();
  bench_patches("control mesh", Surface(mesh, rules, library, 1));
  bench_patches("refined three times", Surface(subdivide(mesh, rules, 3, false), rules, library, 1));
  bench_queries(Surface(mesh, rules, library, 1), Surface(read_mesh(argv[2]), rules, library, 1));
  return 0;
}
