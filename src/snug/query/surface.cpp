#include <snug/surface.h>

#include <utility>

#include <snug/inspect.h>
#include <snug/search/solid.h>
#include <snug/search/surface_data.h>
#include <snug/surface/evaluate.h>
#include <support/error.h>
#include <support/run.h>

namespace snug {

Surface::Surface(ControlMesh mesh, const SurfaceOptions& options, const Run& run)
    : data_(std::make_shared<const SurfaceData>(std::move(mesh), options, run)) {
  if (!options.notes || options.scheme) return;
  const std::string note = smoothing_note(*this, "scheme", {}, {.threads = run.threads});
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
std::size_t Surface::owner_count() const { return data_->limit().owner_count(); }
std::size_t Surface::corner_count(std::uint32_t owner) const {
  require_value(owner < owner_count(), "corner_count: the surface has no such face or vertex");
  const LimitSurface::PatchRange patches = data_->limit().patches_of(owner);
  return traits().triangular ? 1 : (patches.end - patches.begin) / 2;
}
bool Surface::has(const Place& at) const { return patch_at(data_->limit(), at).has_value(); }
std::size_t Surface::kind_count() const { return data_->limit().kind_count(); }
std::optional<std::string> Surface::open_reason() const { return snug::open_reason(data_->limit()); }
void Surface::prepare(const Run& run) const { static_cast<void>(data_->bvh(monitor_of(run))); }
double Surface::size() const { return data_->limit().size(); }
std::size_t Surface::bytes() const { return data_->bytes(); }

Surface load(const std::string& path, const SurfaceOptions& options, const Run& run) {
  ControlMesh mesh = read_mesh(path, {.weld = {}, .notes = options.notes}, run);
  SurfaceOptions named = options;
  if (options.notes) named.notes = [&](const std::string& line) { options.notes(path + ": " + line); };
  try {
    return Surface(std::move(mesh), named, run);
  } catch (const InputError& error) {
    throw InputError(error.problem(), path + ": " + error.what());
  }
}

}  // namespace snug
