#include <snug/search/surface_bvh.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include <snug/base/error.h>
#include <snug/geometry/rounding.h>
#include <snug/search/enclosed_pieces.h>
#include <snug/search/solid.h>
#include <snug/surface/control_hull.h>

namespace snug {
namespace {

constexpr std::uint32_t none = UINT32_MAX;
constexpr std::size_t most_bytes = std::size_t{256} << 20;

BoundingVolume tight_volume(const LimitSurface& surface, std::span<const PatchId> patches,
                            const SurfaceBvhOptions& options) {
  // For their memory.
  thread_local HullPoints scratch;
  thread_local std::array<HullPoints, WideBvh::cluster_size> kept;
  std::vector<const HullPoints*> hulls;
  std::vector<OffsetTriangle> triangles;
  std::vector<Point3> spread;
  for (const PatchId p : patches) {
    const Piece piece = make_piece(surface.library(), p, surface.patch(p), scratch, options.table);
    triangles.push_back(piece.offset);
    spread.insert(spread.end(), piece.offset.base.begin(), piece.offset.base.end());
    if (options.table) continue;
    HullPoints& hull = kept[hulls.size()];
    close_points(surface.library(), piece.patch, hull);
    hulls.push_back(&hull);
  }
  if (options.table) return fit(options.volume, EnclosedTriangles(triangles, spread));
  return fit(options.volume, EnclosedHulls(hulls, spread));
}

std::vector<PatchId> existing_patches(const LimitSurface& surface) {
  std::vector<PatchId> patches;
  patches.reserve(surface.patch_count());
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) patches.emplace_back(p);
  }
  if (patches.size() >= WideBvh::cluster_bit) {
    throw InputError(InputProblem::refused, "more than 2^31 patches: ask about parts of the mesh");
  }
  if (patches.empty()) {
    throw InputError(InputProblem::refused,
                     "nothing here has a limit surface: all touches the boundary or is a hole; take another "
                     "boundary rule");
  }
  return patches;
}

WideBvh make_tree(const LimitSurface& surface, std::span<const PatchId> patches,
                  const SurfaceBvhOptions& options, const WorkMonitor& monitor) {
  std::vector<Point3> centres;
  centres.reserve(patches.size());
  for (const PatchId p : patches) centres.push_back(surface.middle(p));
  return {options.volume, centres, options.threads, [&](std::span<const std::uint32_t> items) {
            monitor.checkpoint();
            thread_local ControlHull hull;
            std::array<PatchId, WideBvh::cluster_size> members;
            for (std::size_t i = 0; i < items.size(); ++i) members[i] = patches[items[i]];
            const std::span<const PatchId> here = std::span(members).first(items.size());
            if (options.tight) return tight_volume(surface, here, options);
            hull.assign(surface, here);
            return fit(options.volume, hull);
          }};
}

}  // namespace

// Not std::call_once: an exception that leaves it, as of a surface that is not closed, may end the process or lock it up.
struct SurfaceBvh::LazySolid {
  std::mutex mutex;
  std::optional<Solid> solid;
  std::atomic<const Solid*> ready{nullptr};
};

SurfaceBvh::~SurfaceBvh() = default;
SurfaceBvh::SurfaceBvh(SurfaceBvh&&) noexcept = default;
SurfaceBvh& SurfaceBvh::operator=(SurfaceBvh&&) noexcept = default;

SurfaceBvh::SurfaceBvh(const LimitSurface& surface, const SurfaceBvhOptions& options,
                       const WorkMonitor& monitor)
    : surface_(&surface),
      table_(options.table),
      patches_(existing_patches(surface)),
      tree_(make_tree(surface, patches_, options, monitor)),
      solid_(std::make_unique<LazySolid>()) {
  const PowerOfTwo back = surface.scale().inverse();
  ball_ = {back.apply(tree_.ball().centre), enlarged(back.apply(tree_.ball().radius))};
  // Beyond these sizes products lose digits to the ends of the range.
  if (!is_finite(ball_.centre) || !(ball_.radius < 0x1p500) || std::abs(back.exponent()) > 500) {
    ball_ = {Point3{}, INFINITY};
  }
}

const Solid& SurfaceBvh::solid() const {
  if (const Solid* const ready = solid_->ready.load(std::memory_order_acquire)) return *ready;
  const std::lock_guard lock(solid_->mutex);
  if (!solid_->solid) solid_->solid.emplace(*surface_, tree_.blocks().volume());
  solid_->ready.store(&*solid_->solid, std::memory_order_release);
  return *solid_->solid;
}

std::size_t SurfaceBvh::bytes() const { return patches_.capacity() * sizeof(PatchId) + tree_.bytes(); }

SurfaceWorkspace::SurfaceWorkspace(const SurfaceBvh& model)
    : model_(&model),
      refinement_(model.surface(), model.table()),
      blocks_(model.tree().blocks().volume()),
      cluster_blocks_(model.tree().cluster_count(), none) {}

std::size_t SurfaceWorkspace::bytes() const {
  return refinement_.bytes() + blocks_.bytes() + ends_.bytes() + lanes_.capacity() * sizeof(Lanes) +
         (cluster_blocks_.capacity() + piece_blocks_.capacity() + stamps_.capacity()) * sizeof(std::uint32_t);
}

void SurfaceWorkspace::begin() {
  touched_ = 0;
  if (++query_ == 0 || bytes() > most_bytes) {
    refinement_.clear();
    blocks_.clear();
    lanes_.clear();
    std::fill(cluster_blocks_.begin(), cluster_blocks_.end(), none);
    piece_blocks_.clear();
    stamps_.clear();
    query_ = 1;
  }
}

std::uint32_t SurfaceWorkspace::touch(std::uint32_t block) {
  if (stamps_[block] != query_) {
    stamps_[block] = query_;
    ++touched_;
  }
  return block;
}

std::uint32_t SurfaceWorkspace::add_block(std::span<const PieceId> pieces) {
  std::array<BoundingVolume, Blocks::lanes> volumes;
  std::array<std::uint32_t, Blocks::lanes> names;
  Lanes lanes{};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (blocks_.volume() == Volume::obb) {
      volumes[i].box = refinement_.box(pieces[i]);
    } else {
      const OffsetTriangle& offset = refinement_[pieces[i]].offset;
      volumes[i] = fit(blocks_.volume(), EnclosedTriangles({&offset, 1}, offset.base));
    }
    names[i] = pieces[i].value();
    // Rounded to nearest, then up by more than that.
    lanes.radii[i] = static_cast<float>(refinement_[pieces[i]].offset.radius) * (1 + 0x1p-22F) + 0x1p-120F;
    if (refinement_.can_split(pieces[i])) lanes.can_split |= static_cast<std::uint8_t>(1u << i);
  }
  lanes_.push_back(lanes);
  stamps_.push_back(0);
  return blocks_.add(std::span(volumes).first(pieces.size()), std::span(names).first(pieces.size()));
}

SurfaceWorkspace::Opened SurfaceWorkspace::open(Node node) {
  std::array<PieceId, Blocks::lanes> pieces;
  if (node.piece) {
    const std::size_t id = piece(node).index();
    if (id >= piece_blocks_.size()) piece_blocks_.resize(refinement_.size(), none);
    if (piece_blocks_[id] == none) {
      const PieceId first = refinement_.split(PieceId(id));
      for (std::size_t i = 0; i < 4; ++i) pieces[i] = PieceId(first.index() + i);
      piece_blocks_[id] = add_block(std::span(pieces).first(4));
    }
    return {touch(piece_blocks_[id]), true};
  }
  const std::uint32_t name = model_->tree().blocks().name(node.lane());
  if ((name & WideBvh::cluster_bit) == 0) return {name, false};
  const std::size_t cluster = name & ~WideBvh::cluster_bit;
  if (cluster_blocks_[cluster] == none) {
    const std::span<const std::uint32_t> items = model_->tree().cluster(cluster);
    for (std::size_t i = 0; i < items.size(); ++i) pieces[i] = refinement_.root(model_->patch(items[i]));
    cluster_blocks_[cluster] = add_block(std::span(pieces).first(items.size()));
  }
  return {touch(cluster_blocks_[cluster]), true};
}

}  // namespace snug
