#include <snug/bounds/piece_fit.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include <snug/bounds/part_kernels.h>
#include <snug/bounds/piece_kernel.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// How deep tips are, in turn, and how much they may add to what the rest needs.
constexpr unsigned levels_of_tips[] = {3, 4, 6, deepest_part_tip};
constexpr double max_excess = 0.1;
// Covers the roundings of some dozen operations here.
constexpr double generous = 1 + 0x1p-40;

// Patches of one sort: split into four, or their own only part.
class Group {
 public:
  void begin(unsigned parts_of_each) {
    parts_of_each_ = parts_of_each;
    patches_.clear();
    places_.clear();
  }
  // `place`: of the answer.
  void add(const Patch& patch, std::size_t place) {
    patches_.push_back(&patch);
    places_.push_back(place);
  }
  void fit(BoundsCache& library, std::span<PieceFit> out);

 private:
  void split_all();
  // Leaves those parts in order_ whose tips are farther from the base or the quadratic than the rest of the patch.
  void keep_what_sticks_out();
  template <class Work>
  void for_each_kind(BoundsCache& library, const Work& work);
  [[nodiscard]] const Patch& part(std::size_t i) const {
    return parts_of_each_ == 1 ? *patches_[i] : parts_[i];
  }

  unsigned parts_of_each_ = 1;
  std::vector<const Patch*> patches_;
  std::vector<std::size_t> places_;
  std::vector<Patch> parts_;          // as many as there ever were
  std::vector<std::uint32_t> order_;  // of parts, by kind
  std::vector<PartShape> shapes_;
  std::vector<PatchFrame> frames_;
  std::vector<PartBounds> bounds_;
  std::vector<TipState> tips_;  // as many as there ever were
};

void Group::split_all() {
  if (parts_of_each_ == 1) return;
  if (parts_.size() < 4 * patches_.size()) parts_.resize(4 * patches_.size());
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    split_into_four(*patches_[i], std::span<Patch, 4>(parts_.data() + 4 * i, 4));
  }
}

void Group::keep_what_sticks_out() {
  const auto fine = [&](std::uint32_t i) {
    const std::size_t first = i - i % parts_of_each_;
    double base = 0, quadratic = 0;
    for (std::size_t k = 0; k < parts_of_each_; ++k) {
      base = std::max(base, bounds_[first + k].points.base);
      quadratic = std::max(quadratic, bounds_[first + k].points.quadratic);
    }
    const PartBounds::Reach& tip = bounds_[i].tip;
    const double little = 0x1p-32 * bounds_[i].size;
    return tip.quadratic <= (1 + max_excess) * quadratic + little &&
           tip.base <= (1 + max_excess) * base + little;
  };
  order_.erase(std::remove_if(order_.begin(), order_.end(), fine), order_.end());
}

// work(rows, parts of the kind); parts of a kind without rows are passed over.
template <class Work>
void Group::for_each_kind(BoundsCache& library, const Work& work) {
  const auto name = [&](std::uint32_t i) { return part(i).kind->id().index(); };
  for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
    while (end < order_.size() && name(order_[end]) == name(order_[begin])) ++end;
    const std::optional<PartRows> rows =
        PartRows::of(library, *part(order_[begin]).kind, parts_of_each_ == 1);
    if (rows) work(*rows, std::span(order_).subspan(begin, end - begin));
  }
}

// Derivations/quadratics.md, "Many patches at once".
PieceFit answer(const Patch& patch, const PatchFrame& frame, const PartShape* const* corners,
                std::span<const PartBounds> parts) {
  PieceFit fit;
  fit.offset.radius = -1;
  const auto finite = [](const PartBounds& part) { return part.size < INFINITY; };
  if (!frame.good || !std::all_of(parts.begin(), parts.end(), finite)) return fit;
  PartBounds all = parts[0];
  all.points.add(all.tip);
  for (const PartBounds& part : parts.subspan(1)) {
    all.points.add(part.points);
    all.points.add(part.tip);
    all.error = std::max(all.error, part.error);
    all.size = std::max(all.size, part.size);
  }
  const auto out_of_frame = [&](const Vector3& p) {
    return p.x * frame.t1 + (p.y * frame.t2 + p.z * frame.n);
  };
  const Vector3 origin = patch.origin - Point3{};
  double reached = 4 * all.size + std::fabs(frame.middle) + max_abs(frame.a);
  for (std::size_t k = 0; k < 3; ++k) reached = std::max(reached, 4 * max_abs(corners[k]->corners[k]));
  const double rounded =
      16 * unit_roundoff * reached + 2 * unit_roundoff * max_abs(origin) + 4096 * underflow_error;
  const double given = spatial_error(generous * (all.error + rounded));
  for (std::size_t k = 0; k < 3; ++k) {
    fit.offset.base[k] = patch.origin + (corners[k]->corners[k] + frame.middle * frame.n);
  }
  const double far = generous * all.points.base;
  const double measuring = unit_roundoff * (8 + 48 * frame.amplify) * (far + 2 * frame.longest);
  const double rounding = frame.deviation + frame.stretch * std::fabs(frame.middle) + measuring;
  fit.offset.rounding = enlarged(generous * (rounding + given + all.doubt));
  const double radius = enlarged(generous * ((far + rounding) * (1 + frame.stretch) + given));

  std::array<Vector3, 6> quadratic = frame.quadratic[0];
  if (parts.size() == 4) {
    for (std::size_t k = 0; k < 3; ++k) quadratic[k] = frame.quadratic[k][k];
    for (std::size_t k = 0; k < 3; ++k) quadratic[3 + k] = 2.0 * frame.quadratic[k][3 + k] - quadratic[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    fit.quadratic.corners[k] = patch.origin + (frame.a + out_of_frame(quadratic[k]));
    fit.quadratic.middles[k] = patch.origin + (frame.a + out_of_frame(quadratic[3 + k]));
  }
  // What F' F lacks of the identity counts for the whole patch.
  const double turned = 4 * frame.stretch * all.size, moved = turned + spatial_error(rounded);
  fit.quadratic.error = enlarged(generous * (all.points.quadratic + moved));
  fit.quadratic.normal = out_of_frame(frame.direction);
  fit.quadratic.normal_error =
      enlarged(generous *
               (all.points.along + moved + 2 * (frame.stretch + 32 * unit_roundoff) * all.points.quadratic));

  fit.axes = {out_of_frame({frame.axis_x, frame.axis_y, 0}), out_of_frame({-frame.axis_y, frame.axis_x, 0}),
              frame.n};
  const double doubt =
      generous * (given + turned + 32 * unit_roundoff * (all.size + max_abs(origin) + max_abs(frame.a)));
  for (std::size_t a = 0; a < 3; ++a) {
    const double height = dot(fit.axes[a], origin) + dot(fit.axes[a], frame.a);
    fit.lower[a] = height + all.points.lower[a] - doubt;
    fit.upper[a] = height + all.points.upper[a] + doubt;
  }
  // Not a number is not less.
  if (radius < INFINITY && fit.quadratic.error < INFINITY) fit.offset.radius = radius;
  return fit;
}

void Group::fit(BoundsCache& library, std::span<PieceFit> out) {
  split_all();
  const std::size_t parts = parts_of_each_ * patches_.size();
  thread_local std::vector<std::uint64_t> by_kind;
  by_kind.resize(parts);
  for (std::size_t i = 0; i < parts; ++i) by_kind[i] = std::uint64_t{part(i).kind->id().value()} << 32 | i;
  std::sort(by_kind.begin(), by_kind.end());
  order_.resize(parts);
  std::transform(by_kind.begin(), by_kind.end(), order_.begin(),
                 [](std::uint64_t key) { return static_cast<std::uint32_t>(key); });
  shapes_.resize(parts);
  frames_.resize(patches_.size());
  bounds_.resize(parts);
  if (tips_.size() < parts) tips_.resize(parts);
  // Kept from call to call: a warm frame takes no memory.
  thread_local std::vector<const Patch*> of_kind;
  thread_local std::vector<PartShape*> shapes;
  thread_local std::vector<kernels::PlacedPart> placed;
  thread_local std::vector<PartBounds*> bounds;
  for (PartBounds& part_bounds : bounds_) {
    part_bounds.tip = {};
    part_bounds.error = -1;
  }
  for_each_kind(library, [&](const PartRows& rows, std::span<const std::uint32_t> which) {
    of_kind.clear();
    shapes.clear();
    for (const std::uint32_t i : which) {
      of_kind.push_back(&part(i));
      shapes.push_back(&shapes_[i]);
    }
    kernels::shape_parts(rows, of_kind, shapes);
  });
  kernels::make_frames(shapes_, parts_of_each_, frames_);
  unsigned done = 0;
  for (const unsigned levels : levels_of_tips) {
    for_each_kind(library, [&](const PartRows& rows, std::span<const std::uint32_t> which) {
      placed.clear();
      bounds.clear();
      for (const std::uint32_t i : which) {
        placed.push_back({&part(i), &frames_[i / parts_of_each_],
                          static_cast<std::uint8_t>(i % parts_of_each_), &tips_[i]});
        bounds.push_back(&bounds_[i]);
      }
      kernels::bound_parts(rows, placed, {done, levels}, bounds);
    });
    keep_what_sticks_out();
    done = levels;
  }
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const std::size_t first = i * parts_of_each_;
    const std::span<const PartBounds> own =
        std::span<const PartBounds>(bounds_).subspan(first, parts_of_each_);
    const bool known =
        std::all_of(own.begin(), own.end(), [](const PartBounds& part) { return part.error >= 0; });
    std::array<const PartShape*, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = &shapes_[first + (parts_of_each_ == 1 ? 0 : k)];
    if (known) {
      out[places_[i]] = answer(*patches_[i], frames_[i], corners.data(), own);
    } else {
      out[places_[i]].offset.radius = -1;
    }
  }
}

// As polynomials, or split.
class Parts {
 public:
  void begin() {
    whole_.begin(1);
    split_.begin(4);
  }
  void add(const Patch& patch, std::size_t i, std::span<PieceFit> out) {
    if (patch.kind->polynomial()) {
      whole_.add(patch, i);
    } else if (patch.kind->cacheable() && patch.path.level() < PiecePath::max_level) {
      split_.add(patch, i);
    } else {
      out[i].offset.radius = -1;
    }
  }
  void fit(BoundsCache& library, std::span<PieceFit> out) {
    whole_.fit(library, out);
    split_.fit(library, out);
  }

 private:
  Group whole_, split_;
};

// Patches of one kind without a split. Leaves those without an answer in `which`.
class ByRows {
 public:
  void fit(const kernels::RowsWithTips<float>& rows, std::span<const Patch> patches,
           std::vector<std::size_t>& which, std::span<PieceFit> out) {
    const std::size_t count = which.size();
    if (shapes_.size() < count) {
      shapes_.resize(count);
      frames_.resize(count);
      bounds_.resize(count);
    }
    pieces_.clear();
    for (std::size_t i = 0; i < count; ++i)
      pieces_.push_back({&patches[which[i]], &shapes_[i], &frames_[i], &bounds_[i]});
    // Of fewer levels most tips stick out, and a second pass costs more than the last levels.
    kernels::fit_pieces_by_rows(rows, kernels::most_row_levels, pieces_);
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      PieceFit& fit = out[which[i]];
      fit.offset.radius = -1;
      if (bounds_[i].error >= 0) {
        const PartShape* const shape = &shapes_[i];
        fit = answer(patches[which[i]], frames_[i], std::array{shape, shape, shape}.data(), {&bounds_[i], 1});
      }
      if (!(fit.offset.radius >= 0)) which[left++] = which[i];
    }
    which.resize(left);
  }

 private:
  // As many as there ever were.
  std::vector<PartShape> shapes_;
  std::vector<PatchFrame> frames_;
  std::vector<PartBounds> bounds_;
  std::vector<kernels::PieceToFit> pieces_;
};

struct Memory {
  Parts parts;
  ByRows by_rows;
  std::vector<std::size_t> which;
};
Memory& memory_of_thread() {
  thread_local Memory memory;
  return memory;
}

}  // namespace

void fit_pieces(BoundsCache& library, std::span<const Patch> patches, std::span<PieceFit> out) {
  Parts& parts = memory_of_thread().parts;
  parts.begin();
  for (std::size_t i = 0; i < patches.size(); ++i) parts.add(patches[i], i, out);
  parts.fit(library, out);
}

void fit_sorted_pieces(BoundsCache& library, std::span<const Patch> patches, std::span<PieceFit> out) {
  auto& [parts, by_rows, which] = memory_of_thread();
  parts.begin();
  for (std::size_t begin = 0, end = 0; begin < patches.size(); begin = end) {
    const Kind& kind = *patches[begin].kind;
    while (end < patches.size() && patches[end].kind == &kind) ++end;
    which.resize(end - begin);
    std::iota(which.begin(), which.end(), begin);
    const kernels::RowsWithTips<float>* const rows =
        kind.cacheable() && !kind.polynomial() ? library.piece_rows(kind) : nullptr;
    if (rows) by_rows.fit(*rows, patches, which, out);
    for (const std::size_t i : which) parts.add(patches[i], i, out);
  }
  parts.fit(library, out);
}

}  // namespace snug
