#include <snug/scheme/stencils.h>

#include <cmath>

#include <snug/base/error.h>
#include <snug/geometry/rounding.h>

namespace snug {

void Stencils::reserve(std::size_t rows, std::size_t entries) {
  offsets_.reserve(rows + 1);
  errors_.reserve(rows);
  abs_sums_.reserve(rows);
  sources_.reserve(entries);
  weights_.reserve(entries);
}

void Stencils::add(std::uint32_t source, double weight, double error) {
  sources_.push_back(source);
  weights_.push_back(weight);
  open_error_ += error;
  open_sum_ += std::fabs(weight);
}

void Stencils::end_row() {
  if (sources_.size() > UINT32_MAX) {
    throw InputError(InputProblem::refused,
                     "a mesh this large takes more than 2^32 weights: take a lower level");
  }
  const std::size_t entries = sources_.size() - offsets_.back();
  offsets_.push_back(static_cast<std::uint32_t>(sources_.size()));
  const double slack = 1 + gamma_bound(entries + 2);
  errors_.push_back(open_error_ * slack);
  abs_sums_.push_back(open_sum_ * slack);
  max_entries_ = std::max(max_entries_, entries);
  max_error_ = std::max(max_error_, errors_.back());
  max_abs_sum_ = std::max(max_abs_sum_, abs_sums_.back());
  open_error_ = open_sum_ = 0;
}

void Stencils::add_unit_row(std::uint32_t source) {
  add(source, 1.0);
  end_row();
}

void Stencils::append(const Row& row) {
  for (std::size_t i = 0; i < row.sources.size(); ++i) add(row.sources[i], row.weights[i]);
  open_error_ += row.error;
  end_row();
}

double Stencils::result_error(double largest, double source_error) const {
  const double k = static_cast<double>(max_entries_);
  return enlarged((gamma_bound(max_entries_) * max_abs_sum_ + max_error_) * largest +
                  (max_abs_sum_ + max_error_) * source_error) +
         3 * k * underflow_error;
}

}  // namespace snug
