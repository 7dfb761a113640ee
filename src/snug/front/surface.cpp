#include <snug/surface.h>

#include <utility>

#include <snug/front/smoothing_note.h>
#include <snug/search/surface_data.h>

namespace snug {

Surface::Surface(ControlMesh mesh, const SurfaceOptions& options)
    : data_(std::make_shared<const SurfaceData>(std::move(mesh), options)) {
  if (!options.notes || options.scheme) return;
  const std::string note = smoothing_note(data_->limit(), "scheme", {}, options.threads);
  if (!note.empty()) options.notes(note);
}
Surface::Surface(std::shared_ptr<const SurfaceData> data) noexcept : data_(std::move(data)) {}
Surface::Surface(const Surface&) noexcept = default;
Surface& Surface::operator=(const Surface&) noexcept = default;
Surface::~Surface() = default;

PlacedSurface Surface::at(const Motion& pose) const { return {*this, pose}; }
const ControlMesh& Surface::mesh() const { return data_->limit().mesh(); }
Scheme Surface::scheme() const { return data_->limit().options().scheme; }
BoundaryRule Surface::boundary() const { return data_->limit().options().boundary; }
double Surface::size() const { return data_->limit().size(); }
std::size_t Surface::bytes() const { return data_->bytes(); }

Surface load(const std::string& path, const SurfaceOptions& options) {
  ControlMesh mesh = read_mesh(path, {.weld = {}, .notes = options.notes, .monitor = options.monitor});
  SurfaceOptions named = options;
  if (options.notes) named.notes = [&](const std::string& line) { options.notes(path + ": " + line); };
  try {
    return Surface(std::move(mesh), named);
  } catch (const InputError& error) {
    throw InputError(error.problem(), path + ": " + error.what());
  }
}

}  // namespace snug
