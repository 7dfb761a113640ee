#include <oracle/obj_reader.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace oracle {

namespace {

using Id = std::uint32_t;

/// `t name 2/1/0 integers... floats... strings...`
struct Tag {
  std::vector<Id> integers;
  std::vector<double> floats;
  std::vector<std::string> strings;
};

Tag read_tag(std::istream& line) {
  std::size_t integers = 0, floats = 0, strings = 0;
  char slash = 0;
  line >> integers >> slash >> floats >> slash >> strings;
  Tag tag;
  tag.integers.resize(integers);
  tag.floats.resize(floats);
  tag.strings.resize(strings);
  for (Id& x : tag.integers) line >> x;
  for (double& x : tag.floats) line >> x;
  for (std::string& x : tag.strings) line >> x;
  return tag;
}

/// One value for all, or one for each.
double value(const Tag& tag, std::size_t k) { return tag.floats.at(std::min(k, tag.floats.size() - 1)); }

}  // namespace

TaggedFile read_tagged_obj(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("oracle: cannot read " + path.string());
  TaggedFile result;
  TaggedMesh& mesh = result.mesh;
  for (std::string text; std::getline(file, text);) {
    std::istringstream line(text);
    std::string word;
    line >> word;
    if (word == "v") {
      Point p{};
      if (!(line >> p[0] >> p[1] >> p[2])) throw std::runtime_error("oracle: a vertex is incomplete");
      mesh.points.push_back(p);
    } else if (word == "f") {
      mesh.polygons.emplace_back();
      while (line >> word) {
        const int k = std::stoi(word);  // what follows a slash does not matter
        mesh.polygons.back().push_back(k > 0 ? static_cast<Id>(k - 1)
                                             : static_cast<Id>(mesh.points.size()) - static_cast<Id>(-k));
      }
    } else if (word == "t") {
      line >> word;
      const Tag tag = read_tag(line);
      if (!line) throw std::runtime_error("oracle: a tag is incomplete");
      if (word == "crease")
        for (std::size_t k = 0; k + 1 < tag.integers.size(); ++k)
          mesh.creases.push_back({tag.integers[k], tag.integers[k + 1], value(tag, k)});
      if (word == "corner")
        for (std::size_t k = 0; k < tag.integers.size(); ++k)
          mesh.corners.push_back({tag.integers[k], value(tag, k)});
      if (word == "hole") mesh.holes.insert(mesh.holes.end(), tag.integers.begin(), tag.integers.end());
      if (word == "creasemethod") result.chaikin = tag.strings.at(0) == "chaikin";
      if (word == "smoothtriangles") result.smooth_triangles = tag.strings.at(0) == "smooth";
    }
  }
  return result;
}

}  // namespace oracle
