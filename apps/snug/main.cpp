#include "common.h"
#include "program.h"

namespace {

using namespace snug::command;

Program snug_program() {
  return {"snug",
          "Proved answers about the limit surfaces of subdivision meshes.",
          "Do two parts collide, one of them moved by 3 along x?",
          "snug collide pawn.obj bust.obj --move-b \"3 0 0\"",
          {collide_command(),      contact_command(), distance_command(), deviation_command(),
           closest_command(),      ray_command(),     bound_command(),    eval_command(),
           info_command(),         measure_command(), self_command(),     subdivide_command(),
           tessellate_command(),   hull_command(),    envelope_command(), fit_command(),
           independence_command(), render_command(),  table_command(),    view_command()}};
}

}  // namespace

int main(int argc, char** argv) { return run(argc, argv, snug_program); }
