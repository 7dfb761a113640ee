#include <snug/snug.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <testing/files.h>

namespace snug::smoothing_note_test {
namespace {

using Lines = std::vector<std::string>;

/// A box of twelve triangles without a tag.
ControlMesh box() {
  ControlMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.points.push_back({k & 1 ? 40.0 : 0.0, k & 2 ? 20.0 : 0.0, k & 4 ? 10.0 : 0.0});
  }
  for (const auto& [a, b, c] :
       {std::array{0, 2, 3}, std::array{0, 3, 1}, std::array{4, 5, 7}, std::array{4, 7, 6},
        std::array{0, 1, 5}, std::array{0, 5, 4}, std::array{2, 6, 7}, std::array{2, 7, 3},
        std::array{0, 4, 6}, std::array{0, 6, 2}, std::array{1, 3, 7}, std::array{1, 7, 5}}) {
    mesh.add_face(std::array{VertexId(std::size_t(a)), VertexId(std::size_t(b)), VertexId(std::size_t(c))});
  }
  return mesh;
}

/// A grid of n by n quads in triangles, on a bowl.
ControlMesh bowl(std::size_t n) {
  ControlMesh mesh;
  for (std::size_t i = 0; i <= n; ++i) {
    for (std::size_t j = 0; j <= n; ++j) {
      const double x = 2.0 * double(i) / double(n) - 1, y = 2.0 * double(j) / double(n) - 1;
      mesh.points.push_back({x, y, x * x + y * y});
    }
  }
  const auto at = [&](std::size_t i, std::size_t j) { return VertexId(i * (n + 1) + j); };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      mesh.add_face(std::array{at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.add_face(std::array{at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

Lines notes_of(ControlMesh mesh, SurfaceOptions options = {}) {
  Lines lines;
  options.notes = [&](const std::string& line) { lines.push_back(line); };
  static_cast<void>(Surface(std::move(mesh), options));
  return lines;
}

struct Loaded {
  Scheme scheme;
  Lines lines;
};
Loaded loaded(const std::string& path, SurfaceOptions options = {}) {
  Loaded result{};
  options.notes = [&](const std::string& line) { result.lines.push_back(line); };
  result.scheme = load(path, options).scheme();
  return result;
}

TEST(triangles, that_nobody_tagged_are_smoothed_with_one_note_that_says_how_far) {
  const Lines lines = notes_of(box());
  ASSERT_EQ(lines.size(), 1u);
  const std::string begin = "triangles taken as the control mesh of a Loop surface, up to ";
  ASSERT_EQ(lines[0].substr(0, begin.size()), begin);
  const double named = std::stod(lines[0].substr(begin.size()));
  const double bound = limit_to_faces(Surface(box())).value();
  EXPECT_GE(named, bound);
  EXPECT_LE(named, bound * 1.00001);
  EXPECT_NE(lines[0].find(" % of the size) away from them; scheme flat takes the facets, scheme loop says "
                          "that this is meant"),
            std::string::npos)
      << lines[0];
}

TEST(triangles, are_smoothed_without_a_note_where_the_caller_says_so) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::flat, Scheme::bilinear}) {
    EXPECT_EQ(notes_of(box(), {.scheme = scheme}), Lines{}) << name_of(scheme);
  }
  ControlMesh sharp = box();
  sharpen(sharp);
  EXPECT_EQ(notes_of(sharp), Lines{});
  sharp = bowl(4);
  EXPECT_EQ(sharpen(sharp, 170).creases, 0u);  // nothing is sharp: it is a control mesh all the same
  EXPECT_EQ(notes_of(sharp), Lines{});
}

TEST(triangles, are_smoothed_without_a_note_where_a_tag_says_so) {
  const auto tagged = [](const auto& tag) {
    ControlMesh mesh = box();
    tag(mesh.tags);
    return notes_of(std::move(mesh)).size();
  };
  EXPECT_EQ(tagged([](MeshTags&) {}), 1u);
  EXPECT_EQ(tagged([](MeshTags& tags) { tags.scheme = Scheme::loop; }), 0u);
  EXPECT_EQ(tagged([](MeshTags& tags) { tags.scheme = Scheme::flat; }), 0u);
  EXPECT_EQ(tagged([](MeshTags& tags) { tags.creases.push_back({VertexId(0), VertexId(1), 2}); }), 0u);
  EXPECT_EQ(tagged([](MeshTags& tags) { tags.corners.push_back({VertexId(0), 2}); }), 0u);
  EXPECT_EQ(tagged([](MeshTags& tags) { tags.holes.emplace_back(0); }), 0u);
  EXPECT_EQ(tagged([](MeshTags& tags) { tags.boundary = BoundaryRule::edge_only; }), 0u);
  EXPECT_EQ(tagged([](MeshTags& tags) { tags.crease_method = CreaseMethod::chaikin; }), 0u);
}

TEST(triangles, have_no_note_where_nothing_is_smoothed) {
  ControlMesh one;
  one.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
  EXPECT_EQ(notes_of(one), Lines{});  // its edges and corners are sharp by the boundary rule
  ControlMesh quad;
  quad.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  quad.add_face(std::array{VertexId(0), VertexId(1), VertexId(2), VertexId(3)});
  EXPECT_EQ(notes_of(quad), Lines{});
}

TEST(triangles, have_a_note_without_a_distance_where_there_are_very_many_or_no_double_holds_it) {
  Lines lines = notes_of(bowl(317));  // 200,978 faces
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("surface (how far from them is not measured above 200,000 faces); scheme flat"),
            std::string::npos)
      << lines[0];
  ControlMesh huge = box();
  for (Point3& p : huge.points) p = Point3{} + 4e306 * (p - Point3{20, 10, 5});
  lines = notes_of(huge);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("Loop surface, up to "), std::string::npos) << lines[0];
}

TEST(files_of_facets, are_read_as_facets_without_a_note) {
  const testing::TemporaryFolder folder;
  for (const char* name : {"box.stl", "box.glb"}) {
    const std::string path = folder.file(name);
    Lines dropped;
    ControlMesh mesh = box();
    write_mesh(mesh, path, {.notes = [&](const std::string& line) { dropped.push_back(line); }});
    mesh.tags.scheme = Scheme::flat;
    write_mesh(mesh, path, {.notes = [&](const std::string& line) { dropped.push_back(line); }});
    EXPECT_EQ(dropped, Lines{}) << name;
    EXPECT_EQ(loaded(path).scheme, Scheme::flat) << name;
    EXPECT_EQ(loaded(path).lines, Lines{}) << name;
    EXPECT_EQ(loaded(path, {.scheme = Scheme::loop}).scheme, Scheme::loop) << name;
    EXPECT_EQ(loaded(path, {.scheme = Scheme::loop}).lines, Lines{}) << name;

    ControlMesh sharp = read_mesh(path);  // sharpened, a control mesh with creases
    sharpen(sharp);
    const Surface surface(sharp);
    EXPECT_EQ(surface.scheme(), Scheme::loop) << name;
    EXPECT_EQ(surface.mesh().tags.creases.size(), 18u) << name;
    EXPECT_EQ(limit_to_faces(surface), 0.0) << name;
  }
}

TEST(files_without_tags, are_smoothed_with_a_note_that_names_them) {
  const testing::TemporaryFolder folder;
  for (const char* name : {"box.obj", "box.off", "box.ply"}) {
    const std::string path = folder.file(name);
    write_mesh(box(), path);
    const Loaded found = loaded(path);
    EXPECT_EQ(found.scheme, Scheme::loop) << name;
    ASSERT_EQ(found.lines.size(), 1u) << name;
    EXPECT_EQ(found.lines[0].find(path + ": triangles taken as"), 0u) << found.lines[0];
    EXPECT_EQ(loaded(path, {.scheme = Scheme::loop}).lines, Lines{}) << name;
  }
}

TEST(load, hands_on_the_notes_of_the_reader) {
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("edited.obj");
  std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nt strange 0/0/0\n";
  const Lines lines = loaded(path).lines;
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("strange"), std::string::npos) << lines[0];
}

TEST(writing, says_that_a_format_loses_facets_only_where_it_does) {
  const testing::TemporaryFolder folder;
  const auto lines = [&](const char* name, Scheme scheme) {
    Lines found;
    ControlMesh mesh = box();
    mesh.tags.scheme = scheme;
    write_mesh(mesh, folder.file(name), {.notes = [&](const std::string& line) { found.push_back(line); }});
    return found;
  };
  for (const char* name : {"a.off", "a.ply"}) {
    const Lines facets = lines(name, Scheme::flat);
    ASSERT_EQ(facets.size(), 1u) << name;
    EXPECT_NE(facets[0].find("meant as they are"), std::string::npos) << facets[0];
    EXPECT_EQ(lines(name, Scheme::loop), Lines{}) << name;  // what these faces are read as
    EXPECT_EQ(lines(name, Scheme::catmark).size(), 1u) << name;
  }
  for (const char* name : {"a.stl", "a.glb"}) {
    EXPECT_EQ(lines(name, Scheme::flat), Lines{}) << name;
    EXPECT_EQ(lines(name, Scheme::loop).size(), 1u) << name;
  }
  for (const char* name : {"a.obj", "a.usda"}) {
    EXPECT_EQ(lines(name, Scheme::flat), Lines{}) << name;
    EXPECT_EQ(read_mesh(folder.file(name)).tags.scheme, Scheme::flat) << name;
  }
}

}  // namespace
}  // namespace snug::smoothing_note_test
