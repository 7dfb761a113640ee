// STEP files of B-spline faces.

#include <filesystem>

#include <snug/brep.h>

#include "answers.h"
#include "call.h"
#include "fields.h"
#include "surface.h"

namespace snug::python {
namespace {

LengthUnit unit_named(const std::string& word) {
  if (word == "mm") return LengthUnit::millimetre;
  if (word == "cm") return LengthUnit::centimetre;
  if (word == "m") return LengthUnit::metre;
  if (word == "inch") return LengthUnit::inch;
  if (word == "foot") return LengthUnit::foot;
  if (word == "micron") return LengthUnit::micron;
  throw py::value_error("units: '" + word + "' is none of mm, cm, m, inch, foot and micron");
}

py::dict write_step(const PySurface& self, const py::object& file, const py::object& error,
                    const py::object& max_angle, const std::string& units, const py::object& name,
                    const std::string& protocol, const py::object& max_splits, const py::object& threads,
                    const py::object& progress) {
  const Surface surface = self.surface();
  const std::string path = path_of(file);
  StepOptions options{name.is_none() ? std::filesystem::path(path).stem().string() : name.cast<std::string>(),
                      unit_named(units), protocol == "ap214"};
  if (!options.ap214 && protocol != "ap242")
    throw py::value_error("protocol: '" + protocol + "' is none of ap242 and ap214");
  BrepOptions how{length_of(error, surface.size(), "error"), {}};
  if (!max_angle.is_none()) how.max_angle = max_angle.cast<double>();
  Call call(progress, run_of(threads, max_splits));
  const auto [brep, bytes] = call.run([&](const Run& run) {
    Brep made = to_brep(surface, how, run);
    const std::size_t size = snug::write_step(made, path, options);
    return std::pair(std::move(made), size);
  });
  py::dict answer = dict_of(brep, {});
  answer["bytes"] = bytes;
  return answer;
}

}  // namespace

void add_brep(py::class_<PySurface>& cls) {
  const py::none none;
  using py::arg;
  cls.def(
      "write_step", &write_step, arg("path"), arg("error") = none, py::kw_only(), arg("max_angle") = none,
      arg("units") = "mm", arg("name") = none, arg("protocol") = "ap242", arg("max_splits") = none,
      arg("threads") = 0, arg("progress") = none,
      "Writes the surface as a STEP file of B-spline faces that share their edges, for CAD; schemes of "
      "quads.\n\n"
      "error: largest distance from the limit surface, either way, in mesh units or percent of the size "
      "(0.01 %).\n"
      "max_angle: between faces across smooth edges, in degrees. units of the mesh: mm, cm, m, inch, foot or "
      "micron. "
      "protocol:\n"
      "ap242 or ap214.\n\n"
      "Returns a dict: error_bound and gap_bound (of faces from their edges), both proved; break_angle, "
      "measured;\n"
      "outcome, solids, voids, sheets, faces, edges, spans, bytes. Where the budget of max_splits spans is "
      "spent the\n"
      "file is written as far as it was proved. Raises ValueError, MeshError, OSError.");
}

}  // namespace snug::python
