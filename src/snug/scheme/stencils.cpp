#include <snug/scheme/stencils.h>

#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/error.h>

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

Interval times(const Interval& factor, const Interval& weight) {
  return factor == Interval(1) ? weight : factor * weight;
}

void add_mean(std::span<const VertexId> face, const Interval& share, RowBuilder& row) {
  const std::size_t n = face.size();
  const Interval each =
      share == Interval(1) && n == 4 ? Interval(0.25) : share / Interval(static_cast<double>(n));
  for (const VertexId v : face) row.add(v.value(), each);
}

void add_face_means(const Topology& topology, const WorkMonitor& monitor, Stencils& out) {
  RowBuilder row;
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    monitor.checkpoint();
    add_mean(topology.face(FaceId(f)), Interval(1), row);
    row.end_row(out);
  }
}

void add_product(const Stencils::Row& outer, const Stencils& inner, std::span<const VertexId> names,
                 Stencils& out) {
  RowBuilder builder;
  double largest = 0;
  for (std::size_t i = 0; i < outer.sources.size(); ++i) {
    const Stencils::Row row = inner.row(outer.sources[i]);
    builder.add(Interval(outer.weights[i]), row);
    largest = std::max(largest, row.abs_sum + row.error);
  }
  Stencils one;
  builder.end_row(one);
  const Stencils::Row product = one.row(0);
  for (std::size_t i = 0; i < product.sources.size(); ++i) {
    const std::uint32_t source = product.sources[i];
    out.add(names.empty() ? source : names[source].value(), product.weights[i],
            i == 0 ? enlarged(product.error + outer.error * largest) : 0.0);
  }
  out.end_row();
}

}  // namespace snug
