#include "patches.h"

#include <array>

#include <snug/evaluate.h>

#include "bars.h"
#include "evaluation.h"
#include "meshes.h"

namespace snug::bench {
namespace {

// Sums of the radii of commit 863cdec for the patches of irregular_mesh(100'000) with 1, 2 and 3
// extraordinary corners.
constexpr std::array radii_before{51.272744788094755, 88.098704309628957, 62.495621939247577};

double millions_a_second(const Times& times) { return 1e-6 * times.items / times.median; }

void add_irregular(const Options& options, BarTable& table) {
  Subject irregular(irregular_mesh(options.size(100'000, 2'000)));
  for (std::size_t corners = 1; corners <= 3; ++corners) {
    const std::string part = std::to_string(corners) + " extraordinary corners";
    const std::vector<Times> times =
        bench_faces(part, irregular, faces_with(irregular.surface(), corners), options);
    const Times& rows = of_name(times, from_rows);
    table.at_least("bounds of irregular patches", "M/s", 3, part, millions_a_second(rows));
    if (options.quick) continue;
    table.at_most("radii of irregular patches", "sum over commit 863cdec's", 1.04, part,
                  rows.checksum / radii_before[corners - 1]);
  }
}

}  // namespace

void patch_bars(const Options& options, BarTable& table) {
  add_irregular(options, table);
  {
    Subject regular(regular_mesh(options.size(200'000, 2'000)));
    const std::vector<Times> times =
        bench_faces("regular", regular, all_faces(regular.surface().face_count()), options);
    table.at_least("regular Loop rows", "M/s", 10, "torus", millions_a_second(of_name(times, from_rows)));
  }
  const ControlMesh quads = quad_torus(options.size(100'000, 2'000)),
                    irregular = subdivided(irregular_mesh(options.size(10'000, 1'000)), 1, false,
                                           {.scheme = Scheme::catmark});
  for (const ControlMesh* mesh : {&quads, &irregular}) {
    const std::string title = mesh == &quads ? "regular quads" : "irregular quads";
    std::size_t corners = 0;
    for (const std::vector<Times>& times : bench_quads(title, *mesh, options)) {
      table.at_least("Catmull-Clark tables", "M/s", 15, title + " " + std::to_string(corners++),
                     millions_a_second(of_name(times, from_tables)));
    }
  }
#ifdef SNUG_BENCH_OPENSUBDIV
  const ControlMesh panels = panelled_mesh(options.size(10'000, 1'000)),
                    character = character_mesh(options.size(10'000, 1'000), options.size(7'000, 700));
  for (const ControlMesh* mesh : {&panels, &character}) {
    const std::string title = mesh == &panels ? "panels" : "character";
    const std::vector<Times> times = bench_creases(title, *mesh, options);
    table.at_most("creases, set-up and bounds", "snug over Bfr and boxes", 3, title,
                  ratio(of_name(times, snug_cold), of_name(times, bfr_cold)));
  }
#else
  table.missing("creases, set-up and bounds", "OpenSubdiv is not installed");
#endif
}

void evaluation_bars(const Options& options, BarTable& table) {
#ifdef SNUG_BENCH_OPENSUBDIV
  const ControlMesh mesh = irregular_quads(options.size(100'000, 2'000));
  const Subject subject(mesh, {Scheme::catmark});
  for (const std::size_t per_face : {16u, 100u, 256u}) {
    const bool many = per_face == 100;
    const char* const name =
        many ? "evaluation, Catmull-Clark, 100 points a face" : "evaluation, Catmull-Clark";
    for (const std::size_t corners : {0u, 1u, 3u}) {
      const std::vector<Times> times = bench_evaluation(mesh, subject, corners, per_face, options);
      const std::string part =
          std::to_string(per_face) + " points, " + std::to_string(corners) + " extraordinary corners";
      for (const char* way : {snug_with_errors, snug_single}) {
        table.at_least(name,
                       way == snug_single ? "Bfr over snug, single precision" : "Bfr over snug, error bounds",
                       many ? 3 : 1.5, part, ratio(of_name(times, bfr_points), of_name(times, way)));
      }
    }
  }
#else
  static_cast<void>(options);
  table.missing("evaluation, Catmull-Clark", "OpenSubdiv is not installed");
#endif
}

}  // namespace snug::bench
