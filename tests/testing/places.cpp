#include <testing/places.h>

namespace snug::testing {

std::string models_dir() { return SNUG_MODELS_DIR; }
std::string corpus_dir() { return SNUG_CORPUS_DIR; }

}  // namespace snug::testing
