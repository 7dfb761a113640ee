// Answers bit by bit, for builds that other machines run: answers MODELS FOLDER prints the same lines everywhere. scripts/check_cross compares them.
// Writes files with names of every kind below FOLDER, and reads them again.

#include <bit>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <snug/snug.h>

namespace {

// FNV-1a, over the bits of numbers and over text.
class Sum {
 public:
  void add(double x) { add_bits(std::bit_cast<std::uint64_t>(x)); }
  void add(const snug::Point3& p) {
    for (const double x : {p.x, p.y, p.z}) add(x);
  }
  void add(const std::string& text) {
    for (const char c : text) step(static_cast<unsigned char>(c));
  }
  void add(std::uint32_t n) { add_bits(n); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  void step(unsigned byte) { value_ = (value_ ^ byte) * 1099511628211u; }
  void add_bits(std::uint64_t bits) {
    for (int k = 0; k < 64; k += 8) step(static_cast<unsigned>(bits >> k) & 255u);
  }
  std::uint64_t value_ = 14695981039346656037u;
};

void print(const char* what, double x) {
  std::printf("%s %016" PRIx64 "\n", what, std::bit_cast<std::uint64_t>(x));
}
void print(const char* what, const snug::Interval& x) {
  print(what, x.lower);
  print(what, x.upper);
}
void print(const char* what, const Sum& sum) { std::printf("%s sum %016" PRIx64 "\n", what, sum.value()); }

void pair(const snug::Surface& a, const snug::Surface& b, const snug::Motion& pose) {
  snug::Certificate proof;
  const snug::Collision hit = snug::collide(a, b.at(pose), {}, {.certificate = &proof});
  std::printf("collide %s\n", snug::name_of(hit.verdict));
  print("collide", hit.distance);
  Sum text;
  text.add(proof.text);
  print("proof", text);
  print("distance", snug::distance(a, b.at(pose), {.relative = 1e-6}).distance);
}

void alone(const snug::Surface& a) {
  print("size", a.size());
  for (const snug::Point3& p :
       {snug::Point3{0.3, 0.2, 0.1}, snug::Point3{1, -2, 3}, snug::Point3{-0.1, 4, 0}}) {
    print("closest", snug::closest_point(a, p).distance);
    print("signed", snug::signed_distance(a, p).distance);
  }
  const snug::Tessellation triangles = snug::tessellate(a, {.error = 0.01 * a.size()});
  Sum positions;
  for (const snug::Point3& p : triangles.positions) positions.add(p);
  for (const auto& corners : triangles.triangles) {
    for (const std::uint32_t corner : corners) positions.add(corner);
  }
  print("tessellate", positions);
  const snug::Measures measures = snug::measure(a);
  if (measures.volume) print("volume", *measures.volume);
  const snug::Envelope around = snug::envelope(a, {.error = 0.05 * a.size()});
  Sum envelope;
  for (const snug::Point3& p : around.positions) envelope.add(p);
  std::printf("envelope %zu\n", around.triangles.size());
  print("envelope", envelope);
}

// Written, read and compared; names are UTF-8.
void file(const snug::ControlMesh& mesh, const std::string& path, const char* what) {
  snug::write_mesh(mesh, path);
  const snug::ControlMesh again = snug::load(path).mesh();
  Sum points;
  for (const snug::Point3& p : again.points) points.add(p);
  print(what, points);
  snug::write_mesh(mesh, path);  // over itself
  const std::u8string name(path.begin(), path.end());
  std::error_code none;
  const auto size = std::filesystem::file_size(std::filesystem::path(name), none);
  if (!none) std::printf("%s has %ju bytes\n", what, static_cast<std::uintmax_t>(size));
}

void files(const snug::Surface& a, const std::string& folder) {
  const snug::ControlMesh& mesh = a.mesh();
  file(mesh, folder + "/plain.obj", "plain name");
  file(mesh,
       folder +
           "/gr\xc3\xb6\xc3\x9f"
           "er \xe6\x9b\xb2\xe9\x9d\xa2 \xf0\x9f\x90\x9f.obj",
       "wide name");
  file(mesh, folder + "/two words & a bracket).ply", "blank name");
  std::string longest = folder;
  for (int k = 0; k < 6; ++k) {
    longest += "/" + std::string(60, static_cast<char>('a' + k));
#ifdef _WIN32
    const std::string full = std::filesystem::absolute(longest).string();
    std::filesystem::create_directory(R"(\\?\)" + std::filesystem::path(full).make_preferred().string());
#else
    std::filesystem::create_directory(longest);
#endif
  }
  file(mesh, longest + "/part.off", "long name");
  // Ends of lines of Windows, and of none.
  const std::string text = snug::format_mesh(mesh, "a.obj");
  std::string other;
  for (const char c : text) other += c == '\n' ? std::string("\r\n") : std::string(1, c);
  Sum sum;
  for (const snug::Point3& p : snug::parse_mesh(other, "a.obj").points) sum.add(p);
  print("ends of lines", sum);
  for (const char* path : {"/none.obj", "/no/folder.obj"}) {
    try {
      static_cast<void>(snug::load(folder + path));
      std::puts("read what is not there");
    } catch (const snug::InputError& error) {
      std::printf("refused: %s\n",
                  std::strstr(error.what(), "cannot be read: No such file") ? "no such file" : error.what());
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const std::string models = argv[1];
    std::vector<snug::Surface> parts;
    for (const char* name : {"bracket", "pin", "star", "pawn"})
      parts.push_back(snug::load(models + "/" + name + ".obj"));
    for (const snug::Surface& part : parts) alone(part);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      for (std::size_t k = 0; k < parts.size(); ++k) {
        for (const double degrees : {0.0, 33.0, 135.0}) {
          const auto pose = snug::Motion::translation(
                                {0.5 + 0.3 * static_cast<double>(i), 0.05 * static_cast<double>(k), 0.5}) *
                            snug::Motion::rotation_degrees({0.1, 0.2, 1}, degrees);
          pair(parts[i], parts[k], pose);
        }
      }
    }
    files(parts[1], argv[2]);
    std::puts("end");
    return 0;
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
