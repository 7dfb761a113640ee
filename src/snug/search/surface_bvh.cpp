#include <snug/search/surface_bvh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <snug/base/error.h>
#include <snug/geometry/rounding.h>
#include <snug/surface/control_hull.h>

namespace snug {
namespace {

std::vector<PatchId> existing_patches(const LimitSurface& surface) {
  std::vector<PatchId> patches;
  patches.reserve(surface.patch_count());
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) patches.emplace_back(p);
  }
  if (patches.size() >= WideBvh::leaf_bit) {
    throw InputError(InputProblem::refused, "more than 2^31 patches: split the mesh");
  }
  if (patches.empty()) {
    throw InputError(
        InputProblem::refused,
        "no face has a limit surface: all are holes or touch the boundary; use another boundary rule");
  }
  return patches;
}

}  // namespace

std::vector<PieceSketch> SurfaceBvh::sketches(std::span<const std::uint32_t> items) const {
  std::vector<PieceSketch> pieces;
  pieces.reserve(items.size());
  for (const std::uint32_t item : items) {
    const PatchId p = patches_[item];
    pieces.push_back(sketch(surface_->library(), surface_->patch(p), method_));
  }
  return pieces;
}

const LeafNode& SurfaceBvh::keep_leaf(std::uint32_t i, std::span<const PieceSketch> pieces) const {
  auto made = std::make_unique<const LeafNode>(pieces);
  const LeafNode* there = nullptr;
  // Another thread may have been quicker: both are the same.
  if (!leaves_->nodes[i].compare_exchange_strong(there, made.get(), std::memory_order_acq_rel)) return *there;
  leaves_->made.fetch_add(1, std::memory_order_relaxed);
  return *made.release();
}

const LeafNode& SurfaceBvh::make_leaf(std::uint32_t i) const { return keep_leaf(i, sketches(tree_.leaf(i))); }

WideBvh SurfaceBvh::make_tree(const SurfaceBvhOptions& options, const WorkMonitor& monitor) {
  const auto fit_to_control = [surface = surface_, patches = patches_.data()](
                                  std::size_t, std::span<const std::uint32_t> items,
                                  std::vector<Obb>& boxes) {
    thread_local ControlHull hull;
    std::array<PatchId, WideBvh::leaf_size> members;
    for (std::size_t i = 0; i < items.size(); ++i) members[i] = patches[items[i]];
    hull.assign(*surface, std::span(members).first(items.size()));
    boxes.push_back(hull.box());
  };
  if (!options.tight && patches_.size() >= options.least_lazy) {
    return {control_balls(*surface_, patches_), fit_to_control, options.part_level};
  }
  std::vector<Point3> centres;
  centres.reserve(patches_.size());
  for (const PatchId p : patches_) centres.push_back(surface_->middle(p));
  return {centres, options.threads,
          [&](std::size_t leaf, std::span<const std::uint32_t> items, std::vector<Obb>& boxes) {
            monitor.checkpoint();
            if (options.tight) {
              const std::vector<PieceSketch> pieces = sketches(items);
              for (const PieceSketch& piece : pieces) boxes.push_back(piece.box);
              keep_leaf(static_cast<std::uint32_t>(leaf), pieces);
              return;
            }
            fit_to_control(leaf, items, boxes);
          }};
}

SurfaceBvh::SurfaceBvh(const LimitSurface& surface, const SurfaceBvhOptions& options,
                       const WorkMonitor& monitor)
    : surface_(&surface),
      method_(options.method),
      patches_(existing_patches(surface)),
      leaves_(std::make_unique<Leaves>((patches_.size() + WideBvh::leaf_size - 1) / WideBvh::leaf_size)),
      tree_(make_tree(options, monitor)),
      solid_(std::make_unique<Lazy<Solid>>()) {
  const PowerOfTwo back = surface.scale().inverse();
  const Ball scaled = tree_.ball();
  ball_ = {back.apply(scaled.centre), enlarged(back.apply(scaled.radius))};
  // Beyond these sizes products lose digits to the ends of the range.
  if (!is_finite(ball_.centre) || !(ball_.radius < 0x1p500) || std::abs(back.exponent()) > 500) {
    ball_ = {Point3{}, INFINITY};
    box_.half = {INFINITY, INFINITY, INFINITY};
    return;
  }
  box_ = tree_.box();
  box_.centre = back.apply(box_.centre);
  for (std::size_t k = 0; k < 3; ++k) box_.half[k] = enlarged(back.apply(box_.half[k]));
}

SurfaceBvh::Leaves::~Leaves() {
  for (const auto& node : nodes) delete node.load(std::memory_order_relaxed);
}

const Solid& SurfaceBvh::solid() const {
  return solid_->get([&] { return Solid(*surface_); });
}

std::size_t SurfaceBvh::bytes() const {
  return patches_.capacity() * sizeof(PatchId) + tree_.bytes() + leaves_->nodes.size() * sizeof(void*) +
         leaves_->made.load(std::memory_order_relaxed) * sizeof(LeafNode);
}

}  // namespace snug
