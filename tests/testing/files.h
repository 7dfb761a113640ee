#pragma once

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <snug/mesh/control_mesh.h>
#include <support/error.h>

namespace snug::testing {

/// Message of the InputError (unreadable) that an action throws; fails the test, and is empty, if it throws nothing.
inline std::string unreadable(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), InputProblem::unreadable);
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

inline std::vector<std::uint32_t> corners(const ControlMesh& mesh, std::size_t face) {
  std::vector<std::uint32_t> ids;
  for (const VertexId vertex : mesh.face(FaceId(face))) ids.push_back(vertex.value());
  return ids;
}

/// Equality that distinguishes 0 and -0.
inline void expect_same_arrays(const ControlMesh& a, const ControlMesh& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t v = 0; v < a.points.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(a.points[v][axis]),
                std::bit_cast<std::uint64_t>(b.points[v][axis]))
          << "vertex " << v;
    }
  }
  EXPECT_EQ(a.face_offsets, b.face_offsets);
  EXPECT_EQ(a.face_vertices, b.face_vertices);
  EXPECT_EQ(a.polyline_offsets, b.polyline_offsets);
  EXPECT_EQ(a.polyline_vertices, b.polyline_vertices);
}

/// An empty folder that vanishes with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::random_device device;
    do {
      path_ = std::filesystem::temp_directory_path() / ("snug-test-" + std::to_string(device()));
    } while (!std::filesystem::create_directory(path_));
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] std::string path() const { return path_.string(); }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }
  [[nodiscard]] bool empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::filesystem::path path_;
};

inline void put(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace snug::testing
