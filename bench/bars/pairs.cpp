#include "pairs.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include <snug/mesh/topology.h>

#include "peers.h"

namespace snug::bench {
namespace {

constexpr std::size_t own_models = 7, max_others = 10;
constexpr std::array<std::array<const char*, 2>, 2> more_pairs{{{"bust", "figure"}, {"ring", "head"}}};
// What goals are set on, beside bust and figure: where all of these are given, pairs are those.
constexpr std::array<std::array<const char*, 2>, 4> pairs_of_goals{
    {{"venus", "cow"}, {"cow", "mannequin"}, {"knight", "venus"}, {"horse", "cow"}}};

// The pairs of goals; none if one of their models is missing.
std::vector<ModelPair> goals(const std::vector<Model>& own, std::span<const std::string> others) {
  std::vector<std::string> files;
  for (const std::string& file : others) {
    const std::string name = std::filesystem::path(file).stem().string();
    const auto in = [&](const auto& pair) { return pair[0] == name || pair[1] == name; };
    if (std::any_of(pairs_of_goals.begin(), pairs_of_goals.end(), in)) files.push_back(file);
  }
  if (files.size() != 5) return {};
  const std::vector<Model> models = read_models(files);
  std::vector<ModelPair> pairs;
  for (const auto& [a, b] : pairs_of_goals) pairs.push_back({named(models, a), named(models, b)});
  pairs.push_back({named(own, "bust"), named(own, "figure")});
  return pairs;
}

// The model of a file if it suits.
std::optional<Model> suitable(const std::string& file) {
  try {
    Model model = std::move(read_models({file}).front());
    const std::size_t faces = model.mesh.face_count();
    if (faces < 200 || faces > 10'000 || !model.mesh.tags.creases.empty()) return {};
    for (std::size_t f = 0; f < faces; ++f) {
      if (model.mesh.face(FaceId(f)).size() != 3) return {};
    }
    const LimitSurface surface(model.mesh, loop_rules(), std::make_shared<BoundsCache>());
    for (HalfEdge h = 0; h < 3 * faces; ++h) {
      if (surface.topology().twin(h) == no_half_edge) return {};
    }
#ifdef SNUG_BENCH_FCL
    if (faces << (2 * osd_uniform_level(model.mesh, 0.01)) > 200'000) return {};
#endif
    return model;
  } catch (const std::exception&) {
    return {};
  }
}

void print(const std::vector<ModelPair>& pairs) {
  for (const ModelPair& pair : pairs) {
    std::printf("# pair: %s, %zu and %zu faces\n", pair.name().c_str(), pair.a.mesh.face_count(),
                pair.b.mesh.face_count());
  }
}

}  // namespace

std::vector<ModelPair> choose_pairs(const std::vector<std::string>& files) {
  if (files.size() < own_models) throw std::runtime_error("the models of examples/models are missing");
  const std::vector<Model> own = read_models({files.begin(), files.begin() + own_models});
  if (std::vector<ModelPair> pairs = goals(own, std::span(files).subspan(own_models)); !pairs.empty()) {
    print(pairs);
    return pairs;
  }
  std::vector<ModelPair> pairs;
  for (const auto& [a, b] : model_pairs) pairs.push_back({named(own, a), named(own, b)});
  for (const auto& [a, b] : more_pairs) pairs.push_back({named(own, a), named(own, b)});
  std::vector<Model> others;
  for (std::size_t i = own_models; i < files.size(); ++i) {
    if (std::optional<Model> model = suitable(files[i])) others.push_back(std::move(*model));
  }
  std::sort(others.begin(), others.end(), [](const Model& a, const Model& b) {
    return std::pair(a.mesh.face_count(), a.name) < std::pair(b.mesh.face_count(), b.name);
  });
  const std::size_t half = std::min(others.size(), max_others) / 2;
  const auto at = [&](std::size_t i) { return i * others.size() / (2 * half); };
  for (std::size_t i = 0; i < half; ++i) pairs.push_back({others[at(i)], others[at(i + half)]});
  print(pairs);
  return pairs;
}

std::vector<const Model*> models_of(const std::vector<ModelPair>& pairs) {
  std::vector<const Model*> models;
  for (const ModelPair& pair : pairs) {
    for (const Model* model : {&pair.a, &pair.b}) {
      const auto same = [&](const Model* known) { return known->name == model->name; };
      if (std::none_of(models.begin(), models.end(), same)) models.push_back(model);
    }
  }
  return models;
}

}  // namespace snug::bench
