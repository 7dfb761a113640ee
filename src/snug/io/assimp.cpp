#include <snug/io/formats.h>

#include <utility>

#include <snug/io/placed_meshes.h>
#include <support/error.h>
#include <support/text_cursor.h>

#if SNUG_HAS_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <algorithm>
#include <array>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <map>
#include <vector>

#include <support/binary.h>
#endif

namespace snug {

#if SNUG_HAS_ASSIMP
namespace {

/// The bytes at hand are the only file: none beside it is opened.
class NoOtherFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char* /*path*/) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* /*path*/, const char* /*mode*/) override { return nullptr; }
  void Close(Assimp::IOStream* /*stream*/) override {}
};

std::string text_of(const aiString& text) { return {text.data, text.length}; }

class AssimpReader {
 public:
  AssimpReader(const aiScene& scene, const std::string& name, std::size_t size, std::string ending)
      : scene_(scene), name_(name), ending_(std::move(ending)) {
    placed_.max_elements = std::min(placed_.max_elements, 100 * size);
  }

  PlacedMeshes read(const Notes& notes) {
    if (scene_.mRootNode != nullptr) visit_nodes();
    if (placed_.parts.empty()) fail_in_file(name_, "Assimp found no faces in the file");
    const bool triangles = std::all_of(
        placed_.meshes.begin(), placed_.meshes.end(),
        [](const ControlMesh& mesh) { return 3 * mesh.face_count() == mesh.face_vertices.size(); });
    for (ControlMesh& mesh : placed_.meshes) {
      if (triangles) mesh.tags.scheme = Scheme::flat;
      mesh.metres_per_unit = metres_per_unit();
    }
    if (notes) {
      notes(name_ + ": read by Assimp: coordinates are rounded to floats");
      if (lost_ > 0)
        notes(name_ + ": " + std::to_string(lost_) + " points, lines or faces without area are left out");
      if (deforms_) notes(name_ + ": bones and shapes to blend are left out: the surface is that at rest");
    }
    return std::move(placed_);
  }

 private:
  /// COLLADA is scaled to metres; FBX says how many centimetres a unit has.
  [[nodiscard]] std::optional<double> metres_per_unit() const {
    if (ending_ == ".dae") return 1;
    double centimetres = 0;
    float single = 0;
    if (ending_ != ".fbx" || scene_.mMetaData == nullptr) return {};
    if (!scene_.mMetaData->Get("UnitScaleFactor", centimetres) &&
        scene_.mMetaData->Get("UnitScaleFactor", single))
      centimetres = static_cast<double>(single);
    if (!(centimetres > 0)) return {};
    return centimetres / 100;
  }

  /// Parents before children, in the order of the file.
  void visit_nodes() {
    struct Open {
      const aiNode* node;
      AffineEnclosure above;
    };
    std::vector<Open> open{{scene_.mRootNode, {}}};
    while (!open.empty()) {
      const auto [node, above] = open.back();
      open.pop_back();
      const std::string what = "node " + in_quotes(text_of(node->mName));
      const aiMatrix4x4& m = node->mTransformation;
      std::array<double, 16> numbers{m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2,
                                     m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
      const TransformOperation operation = transform_operation("transform", numbers);
      if (!operation.fault.empty()) fail_in_file(name_, what + ": its matrix " + operation.fault);
      const AffineEnclosure map = above.after(operation.map);
      if (!map.is_finite()) fail_in_file(name_, what + " is beyond the range of doubles");
      add_part(*node, map, what);
      for (unsigned k = node->mNumChildren; k-- > 0;) open.push_back({node->mChildren[k], map});
    }
  }

  /// A node's meshes, which differ in materials, are one. Corners are split by normals: they are joined where they are equal.
  void add_part(const aiNode& node, const AffineEnclosure& map, const std::string& what) {
    if (node.mNumMeshes == 0) return;
    std::vector<unsigned> numbers(node.mMeshes, node.mMeshes + node.mNumMeshes);
    auto known = meshes_.find(numbers);
    if (known == meshes_.end()) {
      ControlMesh mesh;
      for (const unsigned number : numbers) append(number, mesh, what);
      const std::size_t before = mesh.face_count();
      weld(mesh);
      lost_ += before - mesh.face_count();
      std::optional<std::size_t> place;
      if (mesh.face_count() > 0) {
        place = placed_.meshes.size();
        placed_.meshes.push_back(std::move(mesh));
      }
      known = meshes_.emplace(std::move(numbers), place).first;
    }
    if (known->second) placed_.parts.push_back({text_of(node.mName), what, *known->second, map});
  }

  void append(unsigned number, ControlMesh& mesh, const std::string& what) {
    if (number >= scene_.mNumMeshes) fail_in_file(name_, what + ": a mesh that is not there");
    const aiMesh& own = *scene_.mMeshes[number];
    deforms_ = deforms_ || own.HasBones() || own.mNumAnimMeshes > 0;
    const std::size_t first = mesh.points.size();
    if (first + own.mNumVertices > max_elements)
      fail_in_file(name_, "more than " + std::to_string(max_elements) + " vertices: split the mesh");
    for (unsigned v = 0; v < own.mNumVertices; ++v) {
      const aiVector3D& p = own.mVertices[v];
      mesh.points.push_back({p.x, p.y, p.z});
      if (!is_finite(mesh.points.back())) fail_in_file(name_, what + ": a coordinate is not a finite number");
    }
    std::vector<VertexId> corners;
    for (unsigned f = 0; f < own.mNumFaces; ++f) {
      const aiFace& face = own.mFaces[f];
      corners.clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= own.mNumVertices)
          fail_in_file(name_, what + ": a face names a vertex that is not there");
        corners.push_back(VertexId(first + face.mIndices[k]));
      }
      if (mesh.face_vertices.size() + corners.size() > max_elements)
        fail_in_file(name_, "more than " + std::to_string(max_elements) + " corners: split the mesh");
      if (corners.size() < 3) {
        ++lost_;
      } else {
        mesh.add_face(corners);
      }
    }
  }

  const aiScene& scene_;
  const std::string& name_;
  std::string ending_;
  PlacedMeshes placed_;
  std::map<std::vector<unsigned>, std::optional<std::size_t>> meshes_;
  std::size_t lost_ = 0;
  bool deforms_ = false;
};

}  // namespace

bool has_assimp() { return true; }

PlacedMeshes read_assimp(std::string_view bytes, const std::string& ending, const std::string& name,
                         const Notes& notes) {
  if (bytes.empty()) fail_in_file(name, "the file is empty");
  Assimp::Importer importer;
  importer.SetIOHandler(new NoOtherFiles);  // NOLINT: the importer's own from now on
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
  const aiScene* const scene =
      importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, ending.substr(1).c_str());
  if (scene == nullptr) {
    std::string why = importer.GetErrorString();
    std::replace_if(
        why.begin(), why.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    fail_in_file(name, "Assimp cannot read it: " + why);
  }
  return AssimpReader(*scene, name, bytes.size(), ending).read(notes);
}

#else

bool has_assimp() { return false; }

PlacedMeshes read_assimp(std::string_view /*bytes*/, const std::string& /*ending*/, const std::string& name,
                         const Notes& /*notes*/) {
  fail_in_file(
      name,
      "this snug was built without Assimp, which reads such files: convert the mesh to OBJ, STL or glTF, or "
      "build snug with -DSNUG_ASSIMP=ON");
}

#endif

}  // namespace snug
