#include <snug/patch/polynomial.h>

#include <algorithm>
#include <utility>

#include <snug/scheme/rules.h>

namespace snug {

std::optional<PolynomialForm> polynomial_form(const KindKey& key) {
  const SchemeRules& rules = rules_of(key.scheme);
  const std::span<const CornerFan> fans(key.corners.data(), rules.corners);
  if (!key.plain() || key.polygon ||
      !std::all_of(fans.begin(), fans.end(), [&](const CornerFan& fan) { return rules.regular(fan); })) {
    return {};
  }
  const Topology ring = rules.ring(key.corners);
  PolynomialForm form{rules.bezier(ring, fans), {}};
  const std::size_t count = bezier_count(form.degree), blocks = (ring.vertex_count() + 3) / 4;
  form.weights.resize(form.parts * blocks * count * 4);
  for (std::size_t r = 0; r < form.parts * count; ++r) {
    const std::size_t part = r / count, place = r % count;
    const Stencils::Row row = form.rows.row(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      const std::size_t block = part * blocks + row.sources[i] / 4;
      form.weights[(block * count + place) * 4 + row.sources[i] % 4] =
          multinomial(form.degree, place) * row.weights[i];
    }
  }
  return form;
}

}  // namespace snug
