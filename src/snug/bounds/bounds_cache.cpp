#include <snug/bounds/bounds_cache.h>

#include <snug/bounds/invariant_layout.h>

namespace snug {
const BoundingRows& BoundsCache::rows(const Kind& kind) {
  return rows_.get(kind.id(), [&] {
    return make_bounding_rows(kind, has_self_similar_tips(kind) ? levels_before_tips : deepest_tip);
  });
}

const Stencils* BoundsCache::crease_rows(const Kind& kind) {
  const CreaseRows& made = crease_rows_.get(kind.id(), [&] { return make_crease_rows(kind); });
  return made.rows ? &*made.rows : nullptr;
}

const BoundingRows& BoundsCache::level_rows(const Kind& kind) {
  return level_rows_.get(kind.id(), [&] { return make_bounding_rows(kind, 1); });
}

const BoundTable& BoundsCache::table(const Kind& kind) {
  return tables_.get(kind.id(), [&] { return make_bound_table(kind, make_bounding_rows(kind)); });
}

const TipTable& BoundsCache::tip_table(const Kind& kind) {
  return tip_tables_.get(kind.id(), [&] {
    return TipTable(make_bound_table(kind, make_bounding_rows(kind), tip_layout(kind)));
  });
}

const QuadraticRows& BoundsCache::quadratic_rows(const Kind& kind) {
  return quadratics_.get(kind.id(), [&] { return make_quadratic_rows(*this, kind); });
}

}  // namespace snug
