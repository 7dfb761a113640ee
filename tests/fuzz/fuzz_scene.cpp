#include <csignal>
#include <set>
#include <string_view>

#include <apps/snug/scene_file.h>

#include "claims.h"

using namespace snug;

namespace {

void claim_parts(const PartPair& parts, std::size_t count) {
  fuzz::claim(parts.a < count && parts.b < count && parts.a != parts.b, "pairs name two parts");
}

void claim_scene(const command::SceneText& scene) {
  fuzz::claim(!scene.parts.empty(), "there are parts");
  std::set<std::string> names;
  for (const command::SceneText::Part& part : scene.parts) {
    fuzz::claim(!part.name.empty() && names.insert(part.name).second, "each part has a name of its own");
    fuzz::claim(part.mesh < scene.meshes.size(), "each part has a mesh");
    for (const double x : part.pose.numbers()) fuzz::claim(std::isfinite(x), "poses are finite");
  }
  for (const command::SceneMesh& mesh : scene.meshes) fuzz::claim(!mesh.file.empty(), "meshes have files");
  if (scene.pairs) {
    for (const PartPair& pair : *scene.pairs) claim_parts(pair, scene.parts.size());
  }
  fuzz::claim(scene.margin >= 0 && std::isfinite(scene.margin), "the margin is a length");
  for (const PairMargin& own : scene.margins) {
    claim_parts(own.parts, scene.parts.size());
    fuzz::claim(own.margin >= 0 && std::isfinite(own.margin), "margins are lengths");
  }
}

// Names of parts and files stand in messages as they are, in any alphabet; what a terminal obeys does not.
void claim_no_control_characters(std::string_view message) {
  for (const char c : message) {
    const auto byte = static_cast<unsigned char>(c);
    fuzz::claim(byte >= ' ' && byte != 0x7f, "messages are one line without control characters");
  }
}

}  // namespace

// The command's handlers, which are there before main, take the fuzzer's own signals.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  for (const int signal : {SIGALRM, SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  command::CommonOptions options;
  options.quiet = true;
  try {
    claim_scene(command::parse_scene(bytes, "scene.json", options, size % 2 == 0));
  } catch (const InputError& error) {
    claim_no_control_characters(error.what());
  }
  return 0;
}
