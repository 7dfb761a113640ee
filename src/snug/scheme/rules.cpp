#include <snug/scheme/rules.h>

#include <algorithm>

namespace snug {

const SchemeRules& loop_rules();
const SchemeRules& catmark_rules();
const SchemeRules& doo_sabin_rules();
const SchemeRules& midedge_rules();
const SchemeRules& bilinear_rules();
const SchemeRules& flat_rules();

std::span<const SchemeRules* const> all_rules() {
  static const std::array all{&loop_rules(),    &catmark_rules(),  &doo_sabin_rules(),
                              &midedge_rules(), &bilinear_rules(), &flat_rules()};
  return all;
}

const SchemeRules& rules_of(Scheme scheme) { return *all_rules()[static_cast<std::size_t>(scheme)]; }

const SchemeRules* rules_named(std::string_view name) {
  for (const SchemeRules* rules : all_rules()) {
    const auto& others = rules->other_names;
    if (rules->name == name || std::find(others.begin(), others.end(), name) != others.end()) return rules;
  }
  return nullptr;
}

const SchemeTraits& traits_of(Scheme scheme) {
  static const auto all = [] {
    std::array<SchemeTraits, all_schemes.size()> traits;
    for (const SchemeRules* rules : all_rules()) {
      traits[static_cast<std::size_t>(rules->scheme)] = {
          rules->name,    rules->other_names, !rules->primal,        rules->triangular(),
          rules->creases, rules->local,       rules->regular_valence};
    }
    return traits;
  }();
  return all[static_cast<std::size_t>(scheme)];
}

std::optional<Scheme> scheme_named(std::string_view name) {
  const SchemeRules* const rules = rules_named(name);
  return rules ? std::optional(rules->scheme) : std::nullopt;
}

bool SchemeRules::answers(DefectKind kind) const {
  return is_legal(kind) || (is_non_manifold(kind) && kind != DefectKind::repeated_vertex);
}

// Half a quad c0 c1 c2 splits into halves of the quarters at its corners, and the other half of the one at
// c1. In each quarter of a quad all corners are in their places.
std::vector<HalfEdge> SchemeRules::child_starts(const Topology& ring, const Topology&) const {
  const std::size_t size = ring.face(FaceId(0)).size();
  if (triangular()) return {0, 3, 6, 9};
  if (size == 4) return {0, 4, 8, 4 + 2};
  std::vector<HalfEdge> starts;
  for (HalfEdge corner = 0; corner < size; ++corner) {
    starts.push_back(4 * corner);
    starts.push_back(4 * corner + 2);
  }
  return starts;
}

HalfEdge SchemeRules::quarter_start(const Topology&, const Topology&, std::size_t corner) const {
  return static_cast<HalfEdge>(4 * corner);
}

bool regular_among_quads(const CornerFan& fan) {
  if (fan.odd) return false;
  return fan.closed ? !fan.sharp && fan.after == 3 : fan.faces() == (fan.sharp ? 1u : 2u);
}

}  // namespace snug
