#include <snug/search/surface_bvh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/surface/control_hull.h>
#include <support/error.h>
#include <support/parallel.h>

namespace snug {
namespace {

// Patches of a tight tree that are fitted together.
constexpr std::size_t block = 256;

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

std::span<const PieceBuild> SurfaceBvh::piece_builds(std::span<const std::uint32_t> items) const {
  thread_local std::array<Patch, WideBvh::leaf_size> members;
  thread_local std::array<PieceBuild, WideBvh::leaf_size> pieces;
  for (std::size_t i = 0; i < items.size(); ++i) surface_->patch(patches_[items[i]], members[i]);
  const std::span<PieceBuild> result = std::span(pieces).first(items.size());
  build_pieces(surface_->library(), std::span(members).first(items.size()), options_.method, result);
  return result;
}

const LeafNode& SurfaceBvh::make_leaf(std::uint32_t i) const {
  return leaves_->keep(i, piece_builds(tree_.leaf(i)));
}

LeafNode* SurfaceBvh::Leaves::unused() {
  const std::lock_guard lock(mutex_);
  if (unused_.empty()) {
    ++count_;
    return nullptr;
  }
  LeafNode* const node = unused_.back().release();
  unused_.pop_back();
  return node;
}

const LeafNode& SurfaceBvh::Leaves::keep(std::uint32_t i, std::span<const PieceBuild> pieces) {
  std::unique_ptr<LeafNode> made(unused());
  if (made) {
    *made = LeafNode(pieces);
  } else {
    made = std::make_unique<LeafNode>(pieces);
  }
  kernels::NodeBoxes* there = nullptr;
  if (nodes_[i].compare_exchange_strong(there, made.get(), std::memory_order_acq_rel)) return *made.release();
  // Another thread was quicker: both are the same.
  const std::lock_guard lock(mutex_);
  if (unused_.size() < unused_.capacity()) {
    unused_.push_back(std::move(made));
  } else {
    --count_;
  }
  return *static_cast<const LeafNode*>(there);
}

void SurfaceBvh::Leaves::clear() {
  unused_.reserve(count_);
  for (auto& place : nodes_) {
    if (kernels::NodeBoxes* const node = place.load(std::memory_order_relaxed)) {
      unused_.emplace_back(static_cast<LeafNode*>(node));
      place.store(nullptr, std::memory_order_relaxed);
    }
  }
}

SurfaceBvh::Leaves::~Leaves() {
  for (const auto& node : nodes_) delete static_cast<LeafNode*>(node.load(std::memory_order_relaxed));
}

std::size_t SurfaceBvh::Leaves::bytes() const {
  const std::lock_guard lock(mutex_);
  return nodes_.size() * sizeof(void*) + count_ * sizeof(LeafNode) + unused_.capacity() * sizeof(void*);
}

WideBvh SurfaceBvh::make_tree(const WorkMonitor& monitor) {
  const auto fit_to_control = [surface = surface_, patches = patches_.data()](
                                  std::size_t, std::span<const std::uint32_t> items,
                                  std::vector<Obb>& boxes) {
    thread_local ControlHull hull;
    std::array<PatchId, WideBvh::leaf_size> members;
    for (std::size_t i = 0; i < items.size(); ++i) members[i] = patches[items[i]];
    hull.assign(*surface, std::span(members).first(items.size()));
    boxes.push_back(hull.box());
  };
  if (!options_.tight && patches_.size() >= options_.min_lazy) {
    return {control_balls(*surface_, patches_), fit_to_control, options_.part_level};
  }
  if (options_.tight) return make_tight_tree(monitor);
  std::vector<Point3> centres;
  centres.reserve(patches_.size());
  for (const PatchId p : patches_) centres.push_back(surface_->middle(p));
  return {centres, options_.threads,
          [&](std::size_t leaf, std::span<const std::uint32_t> items, std::vector<Obb>& boxes) {
            monitor.checkpoint();
            fit_to_control(leaf, items, boxes);
          }};
}

WideBvh SurfaceBvh::make_tight_tree(const WorkMonitor& monitor) {
  // By kind, and in the order of the patches.
  std::vector<std::uint64_t> order(patches_.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = std::uint64_t{surface_->kind(patches_[i]).id().value()} << 32 | i;
  std::sort(order.begin(), order.end());
  std::vector<PieceBuild> pieces(patches_.size());
  std::vector<FittedSet> sets(patches_.size());
  const std::size_t blocks = (patches_.size() + block - 1) / block;
  parallel_for(blocks, options_.threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Patch> members(block);
    std::vector<PieceBuild> built(block);
    for (std::size_t b = begin; b < end; ++b) {
      monitor.checkpoint();
      const std::span<const std::uint64_t> own =
          std::span<const std::uint64_t>(order).subspan(b * block, std::min(block, order.size() - b * block));
      const auto item = [&](std::size_t k) { return static_cast<std::uint32_t>(own[k]); };
      for (std::size_t k = 0; k < own.size(); ++k) surface_->patch(patches_[item(k)], members[k]);
      build_sorted_pieces(surface_->library(), std::span(members).first(own.size()), options_.method,
                          std::span(built).first(own.size()));
      for (std::size_t k = 0; k < own.size(); ++k) {
        pieces[item(k)] = built[k];
        sets[item(k)] = fitted_set(built[k]);
      }
    }
  });
  WideBvh tree(sets, monitor);
  std::array<PieceBuild, WideBvh::leaf_size> of_leaf;
  for (std::size_t i = 0; i < tree.leaf_count(); ++i) {
    const std::span<const std::uint32_t> items = tree.leaf(i);
    for (std::size_t k = 0; k < items.size(); ++k) of_leaf[k] = pieces[items[k]];
    leaves_->keep(static_cast<std::uint32_t>(i), std::span(of_leaf).first(items.size()));
  }
  return tree;
}

SurfaceBvh::SurfaceBvh(const LimitSurface& surface, const SurfaceBvhOptions& options,
                       const WorkMonitor& monitor)
    : surface_(&surface),
      options_(options),
      patches_(existing_patches(surface)),
      leaves_(std::make_unique<Leaves>((patches_.size() + WideBvh::leaf_size - 1) / WideBvh::leaf_size)),
      tree_(make_tree(monitor)),
      solid_(std::make_unique<Lazy<Solid>>()) {
  find_extents();
}

namespace {

std::shared_ptr<const RefitPlan> plan_for(const LimitSurface& surface, SharedPlan& shared, int threads) {
  std::shared_ptr<const RefitPlan> plan = shared.get();
  if (!plan) {
    plan = std::make_shared<const RefitPlan>(surface, existing_patches(surface), threads);
    shared.set(plan);
  }
  return plan;
}

}  // namespace

SurfaceBvh::SurfaceBvh(const LimitSurface& surface, const SurfaceBvhOptions& options, SharedPlan& plan)
    : surface_(&surface),
      options_(options),
      plan_(plan_for(surface, plan, options.threads)),
      patches_(plan_->patches()),
      leaves_(std::make_unique<Leaves>(plan_->order().leaf_count())),
      tree_(WideBvh::in_order_of(plan_->order())),
      solid_(std::make_unique<Lazy<Solid>>()) {
  refit(plan);
}

void SurfaceBvh::refit(SharedPlan& plan) {
  const auto refit_by = [this](std::shared_ptr<const RefitPlan> latest) {
    if (plan_ != latest) {
      tree_ = WideBvh::in_order_of(latest->order());
      plan_ = std::move(latest);
    }
    return plan_->refit(*surface_, tree_);
  };
  leaves_->clear();
  solid_->clear();
  const double looseness = refit_by(plan_for(*surface_, plan, options_.threads));
  if (looseness > options_.max_looser * plan_->looseness()) {
    auto better = std::make_shared<const RefitPlan>(*surface_, patches_, options_.threads);
    plan.set(better);
    refit_by(std::move(better));
  }
  find_extents();
}

namespace {

// The control points that faces use.
std::span<const Point3> used_points(const LimitSurface& surface) {
  const std::span<const Point3> all = surface.scaled_points();
  if (surface.isolated().empty()) return all;
  thread_local std::vector<Point3> used;
  used.clear();
  std::size_t begin = 0;
  const auto add_up_to = [&](std::size_t end) {
    used.insert(used.end(), all.begin() + static_cast<std::ptrdiff_t>(begin),
                all.begin() + static_cast<std::ptrdiff_t>(end));
    begin = end + 1;
  };
  for (const VertexId v : surface.isolated()) add_up_to(v.index());
  if (begin < all.size()) add_up_to(all.size());
  return used;
}

}  // namespace

void SurfaceBvh::find_extents() {
  // Limit points are convex combinations of control points; leaves' boxes stick out at their corners.
  tree_.narrow(used_points(*surface_));
  const PowerOfTwo back = surface_->scale().inverse();
  const Ball scaled = tree_.ball();
  ball_ = {back.apply(scaled.centre), enlarged(back.apply(scaled.radius))};
  // Beyond these sizes products lose digits to the ends of the range.
  if (!is_finite(ball_.centre) || !(ball_.radius < 0x1p500) || std::abs(back.exponent()) > 500) {
    ball_ = {Point3{}, INFINITY};
    box_ = {};
    box_.half = {INFINITY, INFINITY, INFINITY};
    return;
  }
  box_ = tree_.box();
  box_.centre = back.apply(box_.centre);
  for (std::size_t k = 0; k < 3; ++k) box_.half[k] = enlarged(back.apply(box_.half[k]));
}

const Solid& SurfaceBvh::solid() const {
  return solid_->get([&] { return Solid(*surface_); });
}

std::size_t SurfaceBvh::bytes() const {
  return patches_.capacity() * sizeof(PatchId) + tree_.bytes() + leaves_->bytes();
}

}  // namespace snug
