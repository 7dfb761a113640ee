#include "common.h"
#include "program.h"

namespace {

using namespace snug::command;

constexpr const char* of_research = "a command of snug-research (package snug-research)";

Program snug_program() {
  return {
      "snug",
      "Proved answers about the limit surfaces of subdivision meshes.",
      "Do two parts collide, one of them moved by 3 along x?",
      "snug collide pawn.obj bust.obj --move-b \"3 0 0\"",
      {collide_command(), contact_command(), clearance_command(), distance_command(),  deviation_command(),
       closest_command(), ray_command(),     bound_command(),     eval_command(),      info_command(),
       judge_command(),   measure_command(), self_command(),      subdivide_command(), tessellate_command(),
       convert_command(), robot_command(),   hull_command(),      envelope_command(),  render_command(),
       view_command()},
      "snug-research (package snug-research) has independence, table, weights and fit, and repeats the "
      "measurements of the dissertation.",
      {{"independence", "", of_research},
       {"table", "", of_research},
       {"fit", "", of_research},
       {"eval", "--weights", "the command weights of snug-research (package snug-research)"}}};
}

}  // namespace

int main(int argc, char** argv) { return run(argc, argv, snug_program); }
