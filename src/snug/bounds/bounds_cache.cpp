#include <snug/bounds/bounds_cache.h>

#include <snug/bounds/invariant_layout.h>

namespace snug {
const BoundingRows& BoundsCache::rows(const Kind& kind) {
  return rows_.get(kind.id(), [&] {
    return make_bounding_rows(kind, has_self_similar_tips(kind) ? levels_before_tips : deepest_tip);
  });
}

const BoundingRows* BoundsCache::direct_rows(const Kind& kind) {
  if (kind.polynomial() ? kind.form().degree < 2 : !kind.transient()) return nullptr;
  const CreaseRows& made = direct_rows_.get(kind.id(), [&] {
    return kind.polynomial() ? CreaseRows{polynomial_rows(kind)} : make_crease_rows(kind);
  });
  return made.rows ? &*made.rows : nullptr;
}

const BoundingRows& BoundsCache::level_rows(const Kind& kind) {
  return level_rows_.get(kind.id(), [&] { return make_bounding_rows(kind, 1); });
}

const LevelStep& BoundsCache::level_step(const Kind& kind) {
  return level_steps_.get(kind.id(), [&] { return make_level_step(kind); });
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

const kernels::RowsWithTips<float>* BoundsCache::piece_rows(const Kind& kind) {
  const PieceRows& made = piece_rows_.get(kind.id(), [&] {
    PieceRows result;
    if (kernels::has_rows_with_tips(*this, kind) && kernels::has_layouts(*this, kind)) {
      result.rows.emplace(*this, kind, kernels::TipsBy::layouts);
    }
    return result;
  });
  return made.rows ? &*made.rows : nullptr;
}

}  // namespace snug
