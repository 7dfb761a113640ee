#include <snug/independence/steps.h>

#include <algorithm>
#include <map>

namespace snug {
namespace {

// A row of weights times a vector, where no irrational part is left.
std::optional<mpq_class> rational_product(const WeightRow& row, const ExactVector& v) {
  mpq_class result;
  std::map<std::uint32_t, mpq_class> cosines;
  for (const auto& [point, w] : row) {
    if (v[point] == 0) continue;
    result += w.rational * v[point];
    for (const auto& [index, factor] : w.cosines) cosines[index] += factor * v[point];
  }
  if (std::any_of(cosines.begin(), cosines.end(), [](const auto& c) { return c.second != 0; }))
    return std::nullopt;
  return result;
}

// The first `count` rows times a vector, likewise.
std::optional<ExactVector> rational_product(const std::vector<WeightRow>& rows, std::size_t count,
                                            const ExactVector& v) {
  ExactVector result(count);
  for (std::size_t r = 0; r < count; ++r) {
    const auto value = rational_product(rows[r], v);
    if (!value) return std::nullopt;
    result[r] = *value;
  }
  return result;
}

// A row of the first rows' points as one of those that these are combinations of; rational parts alone.
ExactVector pulled_back(const ExactVector& row, const std::vector<WeightRow>& rows, std::size_t columns) {
  ExactVector result(columns);
  for (std::size_t r = 0; r < row.size(); ++r) {
    if (row[r] == 0) continue;
    for (const auto& [point, w] : rows[r]) result[point] += row[r] * w.rational;
  }
  return result;
}

}  // namespace

bool is_rational(const WeightRow& row) {
  return std::all_of(row.begin(), row.end(), [](const auto& entry) { return entry.second.is_rational(); });
}

Steps::Steps(PieceStep step, const ModularField& field, std::vector<WeightRow> base, std::uint32_t columns)
    : step_(std::move(step)),
      field_(field),
      base_(std::move(base)),
      columns_(base_.empty() ? step_.dimension : columns),
      rational_(std::all_of(step_.rows.begin(), step_.rows.end(), is_rational) &&
                std::all_of(base_.begin(), base_.end(), is_rational)) {
  for (const WeightRow& row : step_.rows) images_.push_back(image(row));
  powers_.emplace_back(step_.dimension, ModularRow(columns_));
  for (std::uint32_t i = 0; i < step_.dimension; ++i) {
    if (base_.empty()) {
      powers_[0][i][i] = 1;
      continue;
    }
    for (const auto& [point, w] : image(base_[i])) powers_[0][i][point] = w;
  }
}

Steps::ImageRow Steps::image(const WeightRow& row) const {
  ImageRow result;
  for (const auto& [point, w] : row) result.emplace_back(point, field_.image(w));
  return result;
}

ModularRow Steps::times(const ImageRow& row, const std::vector<ModularRow>& matrix) const {
  ModularRow result(columns_);
  for (const auto& [r, w] : row) {
    for (std::size_t c = 0; c < result.size(); ++c) {
      result[c] = static_cast<std::uint32_t>((result[c] + std::uint64_t{w} * matrix[r][c]) % field_.prime);
    }
  }
  return result;
}

ModularRow Steps::image(const Functional& functional, std::uint32_t before) {
  while (powers_.size() <= before) {
    std::vector<ModularRow> next;
    for (std::uint32_t r = 0; r < step_.kept; ++r) next.push_back(times(images_[r], powers_.back()));
    powers_.push_back(std::move(next));
  }
  ModularRow result(columns_);
  for (const auto& [row, sign] : functional) {
    const ModularRow part = times(images_[row], powers_[before]);
    for (std::size_t c = 0; c < result.size(); ++c) {
      result[c] = field_.sum(result[c], sign > 0 || part[c] == 0 ? part[c] : field_.prime - part[c]);
    }
  }
  return result;
}

ExactVector Steps::exact(const Functional& functional, std::uint32_t before) const {
  ExactVector row(step_.dimension);
  for (const auto& [r, sign] : functional) {
    for (const auto& [point, w] : step_.rows[r]) row[point] += sign * w.rational;
  }
  for (std::uint32_t i = 0; i < before; ++i) row = pulled_back(row, step_.rows, step_.dimension);
  return base_.empty() ? row : pulled_back(row, base_, columns_);
}

std::optional<ExactVector> Steps::at_base(const ExactVector& v) const {
  if (base_.empty()) return v;
  return rational_product(base_, base_.size(), v);
}

std::optional<mpq_class> Steps::factor(const ExactVector& v) const {
  const auto image = rational_product(step_.rows, step_.kept, v);
  if (!image) return std::nullopt;
  std::optional<mpq_class> result;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (v[i] == 0) {
      if ((*image)[i] != 0) return std::nullopt;
      continue;
    }
    const mpq_class ratio = (*image)[i] / v[i];
    if (result && *result != ratio) return std::nullopt;
    result = ratio;
  }
  return result;
}

bool vanishes(const ExactVector& v, const std::vector<DomainFunction>& functions) {
  const Steps* part = nullptr;
  std::uint32_t before = 0;
  std::optional<ExactVector> now;
  for (const DomainFunction& f : functions) {
    if (f.part != part) {
      part = f.part;
      before = 0;
      now = part->at_base(v);
    }
    const PieceStep& step = part->step();
    for (; now && before < f.before; ++before) now = rational_product(step.rows, step.kept, *now);
    if (!now) return false;
    mpq_class value;
    for (const auto& [row, sign] : f.functional) {
      const auto product = rational_product(step.rows[row], *now);
      if (!product) return false;
      value += sign * *product;
    }
    if (value != 0) return false;
  }
  return true;
}

std::vector<ExactVector> Steps::corner_conditions() const {
  std::vector<ExactVector> conditions;
  const auto add = [&](const ExactVector& row) {
    conditions.push_back(base_.empty() ? row : pulled_back(row, base_, columns_));
  };
  for (const WeightRow& row : step_.rows) {
    if (is_rational(row)) continue;
    ExactVector own(step_.dimension), others(step_.dimension);
    own[row.front().first] = 1;
    for (std::size_t i = 1; i < row.size(); ++i) others[row[i].first] = 1;
    add(own);
    add(others);
  }
  return conditions;
}

}  // namespace snug
