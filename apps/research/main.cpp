#include <apps/snug/program.h>

#include "commands.h"

namespace {

using namespace snug::command;

Program research() {
  return {"snug-research",
          "Nodal functions of subdivision surfaces, and measurements of the dissertation repeated.",
          "Which rings of control points around a vertex of valence 8 are independent?",
          "snug-research independence --scheme loop --valence 8",
          {independence_command(), table_command(), weights_command(), fit_command(), leaves_command(),
           creation_command(), rooms_command(), volumes_command(), rates_command(), tightness_command(),
           pair_test_command(), prism_command(), bounds_command(), older_rule_command()}};
}

}  // namespace

int main(int argc, char** argv) { return run(argc, argv, research); }
