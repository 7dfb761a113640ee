#pragma once

#include <memory>

#include "triangle_mesh.h"

namespace snug::bench {

/// A mesh as CGAL's Surface_mesh.
class CgalMesh {
 public:
  /// Requires:  manifold.
  explicit CgalMesh(const TriangleMesh& mesh);
  ~CgalMesh();
  CgalMesh(const CgalMesh&) = delete;
  CgalMesh& operator=(const CgalMesh&) = delete;

  struct Impl;
  [[nodiscard]] const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// CGAL's bounded_error_Hausdorff_distance, one-sided, on one core.
[[nodiscard]] double cgal_hausdorff(const CgalMesh& from, const CgalMesh& to, double error);

}  // namespace snug::bench
