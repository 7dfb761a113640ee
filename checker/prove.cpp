#include "prove.h"

#include <support/parallel.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "rejected.h"

namespace checker {
namespace {

using Planar = std::array<Real, 2>;

// So that what a net ends is itself proved.
void require_kinds_of_nets(const BoundsFile& file, const StoredKind& kind) {
  for (const StoredComparison& comparison : kind.quadratics->comparisons) {
    for (const StoredNet& net : comparison.nets) {
      const bool there = std::any_of(file.kinds.begin(), file.kinds.end(), [&](const StoredKind& other) {
        return other.quadratics && other.scheme == kind.scheme && other.key == net.key;
      });
      if (!there)
        throw Rejected("a net of a kind that the file does not have: " + to_text(kind.scheme, net.key));
    }
  }
}

RowsProof prove_kind(const BoundsFile& file, const StoredKind& kind) {
  if (kind.quadratics) {
    require_kinds_of_nets(file, kind);
    for (const StoredComparison& comparison : kind.quadratics->comparisons)
      prove_comparison(comparison, kind.scheme, kind.key);
    if (kind.quadratics->frame) prove_frame(*kind.quadratics->frame, kind.scheme, kind.key);
  }
  RowsProof proof = prove_rows(kind);
  for (const StoredTable& table : kind.tables) prove_table(table, kind.scheme, proof);
  proof.hull.clear();
  return proof;
}

Real cross(const Planar& origin, const Planar& a, const Planar& b) {
  return (a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0]);
}

}  // namespace

void prove_table(const StoredTable& table, Scheme scheme, const RowsProof& rows) {
  const std::size_t first = first_bounded(scheme);
  const std::vector<std::array<double, 2>> corners{{0, 0}, {1, 0}, {0, 1}};
  if (!std::equal(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first),
                  table.layout.begin()))
    throw Rejected("a layout whose corners are not (0,0), (1,0), (0,1)");
  std::array<Planar, 3> triangle;
  for (std::size_t k = 0; k < 3; ++k) triangle[k] = {table.triangle[k][0], table.triangle[k][1]};
  const Real area = cross(triangle[0], triangle[1], triangle[2]);
  if (!area.certainly_positive()) throw Rejected("a triangle that is not counter-clockwise");
  for (const Row& row : rows.hull) {
    Planar u;
    for (std::size_t c = 0; c < row.size(); ++c) {
      for (std::size_t x = 0; x < 2; ++x) u[x].add_product(row[c], table.layout[c][x]);
    }
    std::array<Real, 3> part;  // of the area: barycentric coordinates of u
    for (std::size_t k = 0; k < 3; ++k) {
      part[k] = cross(u, triangle[(k + 1) % 3], triangle[(k + 2) % 3]);
      if (!part[k].certainly_at_least(0)) throw Rejected("a domain point outside the triangle");
    }
    const auto plane = [&](const StoredTable::Plane& values) {
      return part[0] * Real(values[0]) + part[1] * Real(values[1]) + part[2] * Real(values[2]);
    };
    for (std::size_t c = first; c < row.size(); ++c) {
      const Real value = row[c] * area;
      if (!plane(table.upper[c - first]).certainly_at_least(value) ||
          !value.certainly_at_least(plane(table.lower[c - first])))
        throw Rejected("a plane of control point " + std::to_string(c) + " that cuts its function's hull");
    }
  }
}

FileProof prove_file(std::span<const std::byte> bytes) {
  const BoundsFile file = parse(bytes);
  struct Outcome {
    RowsProof rows;
    std::optional<std::string> failure;
  };
  std::vector<Outcome> outcomes(file.kinds.size());
  const auto prove = [&](const KeptByThread&, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const StoredKind& kind = file.kinds[i];
      try {
        outcomes[i].rows = prove_kind(file, kind);
      } catch (const Rejected& rejected) {
        outcomes[i].failure =
            "kind " + std::to_string(i) + ", " + to_text(kind.scheme, kind.key) + ": " + rejected.what();
      }
    }
  };
  snug::parallel_for_with(
      file.kinds.size(), 0, [] { return KeptByThread(); }, prove);
  FileProof proof;
  for (std::size_t i = 0; i < file.kinds.size(); ++i) {
    const Outcome& outcome = outcomes[i];
    if (outcome.failure) throw Rejected(*outcome.failure);
    for (std::size_t k = 0; k < i; ++k) {
      if (file.kinds[k].scheme == file.kinds[i].scheme && file.kinds[k].key == file.kinds[i].key)
        throw Rejected("a key that comes twice: " + to_text(file.kinds[i].scheme, file.kinds[i].key));
    }
    ++proof.kinds;
    proof.tables += file.kinds[i].tables.size();
    if (const auto& quadratics = file.kinds[i].quadratics) {
      proof.comparisons += quadratics->comparisons.size();
      proof.frames += quadratics->frame ? 1 : 0;
    }
    proof.stored_rows += file.kinds[i].rows;
    proof.pieces += outcome.rows.pieces;
    proof.covered += outcome.rows.covered;
    proof.depth = std::max(proof.depth, outcome.rows.depth);
  }
  return proof;
}

}  // namespace checker
