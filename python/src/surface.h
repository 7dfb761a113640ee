#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <snug/ray.h>
#include <snug/surface.h>

#include "arrays.h"

namespace snug::python {

/// Python's Surface: a handle to a limit surface, which update() replaces.
class PySurface {
 public:
  PySurface(ControlMesh mesh, const SurfaceOptions& options, const Run& run = {});
  /// The same surface; each of the two is updated by itself.
  PySurface(const PySurface& other);
  PySurface& operator=(const PySurface&) = delete;

  /// Errors:    TypeError for an object whose __init__ never ran.
  [[nodiscard]] const Surface& surface() const {
    if (!surface_.data()) throw py::type_error("this Surface was not made: its __init__ has not run");
    return surface_;
  }
  [[nodiscard]] const SurfaceOptions& options() const { return options_; }
  /// The surface of the same faces, tags and options with these control points. Without the GIL.
  /// Errors:    those of MovingSurface; nothing is changed then.
  void update(std::span<const Point3> points);
  /// Made on first use, and anew for another error or after an update.
  [[nodiscard]] std::shared_ptr<const RayCaster> caster(double error, int threads);

 private:
  struct Moving {
    explicit Moving(const Surface& first) : frames(first) {}
    std::mutex mutex;
    MovingSurface frames;
  };

  Surface surface_;
  SurfaceOptions options_;
  std::shared_ptr<Moving> moving_;  // made by the first update()
  std::shared_ptr<const RayCaster> caster_;
  double caster_error_ = 0;
};

/// A control mesh as a value, such as one that was subdivided.
struct PyMesh {
  ControlMesh mesh;

  /// Errors:    TypeError for an object that __new__ alone made.
  [[nodiscard]] const ControlMesh& whole() const {
    if (mesh.face_offsets.empty()) throw py::type_error("this Mesh was not made: subdivided() makes meshes");
    return mesh;
  }
};

void add_errors(py::module_& module);
void add_surface(py::module_& module);
void add_pair_queries(py::module_& module);
/// After add_signatures().
void quicken_collide(py::module_& module);
void add_point_queries(py::class_<PySurface>& surface, py::module_& module);
void add_brep(py::class_<PySurface>& surface);
void add_shapes(py::class_<PySurface>& surface, py::module_& module);
void add_contacts(py::class_<PySurface>& surface, py::module_& module);
void add_motions(py::module_& module);
/// Robot, urdf().
void add_robots(py::module_& module);

/// A name in the file system's bytes. "-" is a file of that name here, not standard input.
[[nodiscard]] std::string path_of(const py::object& path);
/// Raises snug.UndecidedError.
[[noreturn]] void refuse_undecided(const std::string& message);
/// Text that may have the name of a file in it, whose bytes need not be UTF-8.
[[nodiscard]] py::object file_text(const std::string& bytes);
/// Issues a snug.MeshWarning for each line.
void warn(const std::vector<std::string>& lines);

}  // namespace snug::python
