#include <snug/independence/zero_proof.h>

#include <algorithm>
#include <set>

namespace snug {

ZeroProof::ZeroProof(const ExactSurface& surface, const RealField& field)
    : surface_(surface), field_(field), spaces_(surface.kinds.size()), images_(surface.kinds.size()) {
  for (std::uint32_t p = 0; p < surface.patches.size(); ++p) {
    for (const std::uint32_t c : surface.patches[p].control) {
      if (c == no_column) continue;
      if (users_.size() <= c) users_.resize(c + std::size_t{1});
      users_[c].push_back(p);
    }
  }
}

bool ZeroProof::join(Space& space, Vector v) const {
  const auto subtract = [&](const Vector& row, std::size_t pivot) {
    if (v[pivot].is_zero()) return;
    const FieldNumber factor = field_.product(v[pivot], FieldNumber({-1}));
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (!row[i].is_zero()) field_.add_product(factor, row[i], v[i]);
    }
  };
  for (std::size_t k = 0; k < space.basis.size(); ++k) subtract(space.basis[k], space.pivots[k]);
  const auto pivot = std::find_if(v.begin(), v.end(), [](const FieldNumber& x) { return !x.is_zero(); });
  if (pivot == v.end()) return false;
  space.pivots.push_back(static_cast<std::size_t>(pivot - v.begin()));
  const FieldNumber scale = field_.inverse(*pivot);
  for (FieldNumber& x : v) {
    if (!x.is_zero()) x = field_.product(x, scale);
  }
  space.basis.push_back(std::move(v));
  return true;
}

bool ZeroProof::is_zero_on(const ExactKind& kind, const Vector& v) const {
  return std::all_of(kind.functionals.begin(), kind.functionals.end(), [&](const auto& functional) {
    FieldNumber sum;
    for (const auto& [i, weight] : functional) field_.add_product(FieldNumber({weight}), v[i], sum);
    return sum.is_zero();
  });
}

const std::vector<ZeroProof::Image>& ZeroProof::images(std::uint32_t kind) {
  std::vector<Image>& images = images_[kind];
  if (!images.empty()) return images;
  const auto fits = [&](const Weight& w) {
    return std::all_of(w.cosines.begin(), w.cosines.end(), [&](const auto& cosine) {
      return std::uint64_t{cosine.first} * field_.order() % surface_.order == 0;
    });
  };
  for (const ExactKind::Child& child : surface_.kinds[kind].children) {
    Image& image = images.emplace_back();
    for (const WeightRow& row : child.rows) {
      auto& entries = image.rows.emplace_back();
      for (const auto& [i, weight] : row) {
        if (fits(weight)) {
          entries.emplace_back(i, field_.number(weight, surface_.order / field_.order()));
        } else {
          image.foreign.push_back(i);
        }
      }
    }
  }
  return images;
}

bool ZeroProof::vanishes(const Values& values, const WorkMonitor& monitor) {
  std::vector<std::pair<std::uint32_t, Vector>> waiting;
  const auto ask = [&](std::uint32_t kind, Vector v) {
    if (std::any_of(v.begin(), v.end(), [](const FieldNumber& x) { return !x.is_zero(); })) {
      waiting.emplace_back(kind, std::move(v));
    }
  };
  std::set<std::uint32_t> users;
  for (const auto& [vertex, value] : values) {
    if (vertex < users_.size()) users.insert(users_[vertex].begin(), users_[vertex].end());
  }
  for (const std::uint32_t p : users) {
    const ExactSurface::Patch& patch = surface_.patches[p];
    Vector v;
    for (const std::uint32_t c : patch.control) {
      const auto at =
          std::lower_bound(values.begin(), values.end(), c,
                           [](const auto& entry, std::uint32_t vertex) { return entry.first < vertex; });
      v.push_back(at != values.end() && at->first == c ? at->second : FieldNumber());
    }
    ask(patch.kind, std::move(v));
  }
  std::vector<std::uint32_t> joined;  // kinds whose spaces grew: to be undone if something is not 0
  const auto undo = [&] {
    for (const std::uint32_t kind : joined) {
      spaces_[kind].basis.pop_back();
      spaces_[kind].pivots.pop_back();
    }
    return false;
  };
  while (!waiting.empty()) {
    monitor.checkpoint();
    const std::uint32_t kind = waiting.back().first;
    const Vector v = std::move(waiting.back().second);
    waiting.pop_back();
    if (surface_.kinds[kind].children.empty()) {
      if (!is_zero_on(surface_.kinds[kind], v)) return undo();
      continue;
    }
    if (!join(spaces_[kind], v)) continue;
    joined.push_back(kind);
    const std::vector<Image>& parts = images(kind);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const std::vector<std::uint32_t>& foreign = parts[k].foreign;
      if (std::any_of(foreign.begin(), foreign.end(), [&](std::uint32_t i) { return !v[i].is_zero(); })) {
        return undo();
      }
      Vector image(parts[k].rows.size());
      for (std::size_t r = 0; r < image.size(); ++r) {
        for (const auto& [i, weight] : parts[k].rows[r]) {
          if (!v[i].is_zero()) field_.add_product(weight, v[i], image[r]);
        }
      }
      ask(surface_.kinds[kind].children[k].kind, std::move(image));
    }
  }
  return true;
}

}  // namespace snug
