#include "common.h"
#include "program.h"

namespace {

using namespace snug::command;

Program snug_program() {
  return {"snug",
          "Tight, proved bounds for the limit surfaces of subdivision meshes, and answers about them.",
          "do two parts collide, one of them moved by 3 along x?",
          "snug collide pawn.obj bust.obj --place-b \"1 0 0 3  0 1 0 0  0 0 1 0\"",
          {collide_command(), distance_command(), closest_command(), bound_command(), eval_command(),
           info_command(), subdivide_command(), render_command()}};
}

}  // namespace

int main(int argc, char** argv) { return run(argc, argv, snug_program); }
