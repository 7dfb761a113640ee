// bench_bars: what is to be reached, row by row, most of it beside peers. Files: the seven triangle models of
// examples/models, then any others (choose_pairs). Rounds: five.

#include <algorithm>

#include "bars.h"

int main(int argc, char** argv) {
  using namespace snug::bench;
  Options options = start(argc, argv, any_files, " SEVEN-MODELS [MODEL...]");
  options.rounds = std::min(options.rounds, 5);
  const std::vector<ModelPair> pairs = choose_pairs(options.files);
  BarTable table;
  query_bars(pairs, options, table);
  size_bars(pairs, options, table);
  closest_bars(pairs, options, table);
  patch_bars(options, table);
  evaluation_bars(options, table);
  model_bars(pairs, options, table);
  table.print();
  return 0;
}
