#include <apps/snug/program.h>
#include <experiments/program/experiments.h>

namespace {

using namespace snug::command;

Program experiments() {
  return {
      "snug-experiments",
      "Measurements of the dissertation repeated, and alternatives that were not adopted.",
      "how fast do enclosures shrink at an extraordinary vertex?",
      "snug-experiments rates --scheme catmark",
      {leaves_command(), creation_command(), rooms_command(), volumes_command(), rates_command(),
       tightness_command(), pair_test_command(), prism_command(), bounds_command(), older_rule_command()}};
}

}  // namespace

int main(int argc, char** argv) { return run(argc, argv, experiments); }
