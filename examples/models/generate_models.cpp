// Writes the example control meshes: generate_models OUTPUT_FOLDER

#include <array>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "models.h"

namespace {

struct Model {
  const char* name;
  const char* title;
  models::TriangleMesh (*make)();
};

constexpr std::array<Model, 7> kModels = {{
    {"star", "Star with six spikes", models::make_star},
    {"pawn", "Chess pawn", models::make_pawn},
    {"ring", "Trefoil ring", models::make_ring},
    {"head", "Head, open at the neck", models::make_head},
    {"bust", "Bust on a socle", models::make_bust},
    {"demon", "Horned head", models::make_demon},
    {"figure", "Low-polygon game character", models::make_figure},
}};

void write(const std::filesystem::path& folder, const std::string& name, const std::string& text) {
  std::ofstream file(folder / (name + ".obj"), std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + name + ".obj");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: generate_models OUTPUT_FOLDER\n";
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    for (const Model& model : kModels) {
      models::TriangleMesh mesh = model.make();
      models::finish(mesh, model.name);
      write(folder, model.name, models::obj_text(mesh, model.title));
      std::cout << model.name << ": " << mesh.points.size() << " vertices, " << mesh.faces.size()
                << " faces\n";
    }
    write(folder, "bracket", models::bracket_text());
    write(folder, "pin", models::pin_text());
  } catch (const std::exception& error) {
    std::cerr << "generate_models: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
