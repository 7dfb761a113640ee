#include <snug/bounds/bounds_cache.h>

namespace snug {
namespace {

bool has_several_tips(const Kind& kind) {
  if (!has_lasting_tips(kind)) return false;
  int irregular = 0;
  for (std::size_t i = 0; i < 3; ++i) irregular += !kind.regular_corner(i);
  return irregular > 1;
}

}  // namespace

const BoundRows& BoundsCache::rows(const Kind& kind) {
  return rows_.get(kind.id(),
                   [&] { return has_several_tips(kind) ? make_bound_rows(kind, 1) : make_bound_rows(kind); });
}

const BoundTable& BoundsCache::table(const Kind& kind) {
  return tables_.get(kind.id(), [&] {
    const bool kept = kind.shared() && !has_several_tips(kind);  // the rows that patches need
    return make_bound_table(kind, kept ? rows(kind) : make_bound_rows(kind));
  });
}

const QuadraticRows& BoundsCache::quadratic_rows(const Kind& kind) {
  return quadratics_.get(kind.id(), [&] { return make_quadratic_rows(kind); });
}

}  // namespace snug
