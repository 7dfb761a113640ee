#include "faults.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "rejected.h"

namespace checker {
namespace {

// Spoils contents; the hash of what comes out is right.
Fault of_contents(std::string name, std::function<void(BoundsFile&)> spoil) {
  return {std::move(name), [spoil = std::move(spoil)](const BoundsFile& file) {
            BoundsFile copy = file;
            spoil(copy);
            return to_bytes(copy);
          }};
}

// Spoils bytes.
Fault of_bytes(std::string name, std::function<void(std::vector<std::byte>&)> spoil) {
  return {std::move(name), [spoil = std::move(spoil)](const BoundsFile& file) {
            std::vector<std::byte> bytes = to_bytes(file);
            spoil(bytes);
            return bytes;
          }};
}

void remove_row(StoredRows& kind, std::size_t row) {
  StoredRows smaller = kind;
  --smaller.rows;
  smaller.weights.resize(std::size_t{smaller.rows} * smaller.controls);
  for (std::size_t c = 0; c < kind.controls; ++c) {
    for (std::size_t r = 0; r < smaller.rows; ++r) smaller.weight(r, c) = kind.weight(r < row ? r : r + 1, c);
  }
  kind = smaller;
}

// A row and all its copies: pieces that share a corner may each have stored it.
template <class Spoil>
void with_copies(StoredRows& kind, std::size_t row, const Spoil& spoil) {
  std::vector<std::size_t> copies;
  for (std::size_t r = 0; r < kind.rows; ++r) {
    double distance = 0;
    for (std::size_t c = 0; c < kind.controls; ++c)
      distance += std::fabs(kind.weight(r, c) - kind.weight(row, c));
    if (distance <= 4 * kind.entry_error) copies.push_back(r);
  }
  for (std::size_t i = copies.size(); i-- > 0;) spoil(copies[i]);
}

// Takes from the largest entry of a row and gives to the next: the sum stays, and that of absolute values.
void move(StoredRows& kind, std::size_t row, double weight) {
  std::vector<std::size_t> order(kind.controls);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::partial_sort(order.begin(), order.begin() + 2, order.end(),
                    [&](std::size_t a, std::size_t b) { return kind.weight(row, a) > kind.weight(row, b); });
  with_copies(kind, row, [&](std::size_t r) {
    kind.weight(r, order[0]) -= weight;
    kind.weight(r, order[1]) += weight;
  });
}

void remove(StoredKind& kind, std::size_t row) {
  with_copies(kind, row, [&](std::size_t r) { remove_row(kind, r); });
}

Scheme another(Scheme scheme) { return schemes[(static_cast<std::size_t>(scheme) + 1) % schemes.size()]; }

// Table `i` of the first kind that has one.
StoredTable& table_of(BoundsFile& file, std::size_t i) {
  for (StoredKind& kind : file.kinds) {
    if (i < kind.tables.size()) return kind.tables[i];
  }
  throw Rejected("no table to spoil");
}

void shift(StoredTable::Plane& plane, double by) {
  for (double& value : plane) value += by;
}

void add_faults_of_table(Scheme scheme, std::size_t i, std::vector<Fault>& all) {
  const std::string of = " of table " + std::to_string(i);
  const auto add = [&](const std::string& name, const std::function<void(StoredTable&)>& spoil) {
    all.push_back(of_contents(name + of, [i, spoil](BoundsFile& f) { spoil(table_of(f, i)); }));
  };
  add("an upper plane lowered by 1e-10", [](StoredTable& t) { shift(t.upper[0], -1e-10); });
  add("a lower plane raised by 1e-10", [](StoredTable& t) { shift(t.lower[0], 1e-10); });
  add("a corner of the triangle drawn in", [](StoredTable& t) { t.triangle[1][0] -= 1e-6; });
  add("the triangle turned over", [](StoredTable& t) { std::swap(t.triangle[1], t.triangle[2]); });
  add("a place of the layout moved", [](StoredTable& t) { t.layout[4][0] += 1e-6; });
  if (scheme == Scheme::loop) {
    add("a corner of the layout moved", [](StoredTable& t) { t.layout[1][0] += 1e-15; });
  }
}

// Of the first kind that has nets.
StoredQuadratics& quadratics_of(BoundsFile& file) {
  for (StoredKind& kind : file.kinds) {
    if (kind.quadratics && !kind.quadratics->comparisons[0].nets.empty()) return *kind.quadratics;
  }
  throw Rejected("no quadratics to spoil");
}

// The row that has most of the last control point, and is none of a net.
std::size_t marked_row(const StoredComparison& comparison) {
  std::size_t row = 0;
  for (std::size_t r = 0; r < comparison.quadratic.size(); ++r) {
    if (comparison.weight(r, comparison.controls - 1) > comparison.weight(row, comparison.controls - 1))
      row = r;
  }
  return row;
}

void spoil_weight(StoredComparison& comparison, std::size_t point, double by) {
  const std::size_t row = marked_row(comparison);
  with_copies(comparison, row, [&](std::size_t r) {
    if (r < comparison.quadratic.size()) comparison.quadratic[r][point] += by;
  });
}

// Less than a basis function is at a corner of the patch, a limit point that is a Bezier point.
void lower_below_a_limit(StoredQuadratics& quadratics) {
  const StoredComparison& rows = quadratics.comparisons[0];
  std::size_t control = 0;
  double value = 0;
  for (std::size_t r = 0; r < rows.quadratic.size(); ++r) {
    if (std::count(rows.quadratic[r].begin(), rows.quadratic[r].begin() + 3, 1.0) == 0) continue;
    for (std::size_t c = 0; c < rows.controls; ++c) {
      if (rows.weight(r, c) > value) value = rows.weight(r, control = c);
    }
  }
  quadratics.frame.value().largest[control] = value - 1e-12;
}

// A polygon that ends, in a direction along an axis, a little before 0: so much are the corners' limits off.
void cut(StoredFrame& frame, std::size_t axis, bool least) {
  const double end = least ? 4 * frame.offset_error : -4 * frame.offset_error;
  for (auto& at : frame.offsets) at[axis] = least ? std::max(at[axis], end) : std::min(at[axis], end);
}

void add_faults_of_comparison(Scheme scheme, std::size_t i, std::vector<Fault>& all) {
  const std::string of = " of comparison " + std::to_string(i);
  const auto add = [&](const std::string& name, const std::function<void(StoredComparison&)>& spoil) {
    all.push_back(
        of_contents(name + of, [i, spoil](BoundsFile& f) { spoil(quadratics_of(f).comparisons[i]); }));
  };
  add("a Bezier point off by 1e-13, the sum right",
      [](StoredComparison& c) { move(c, marked_row(c), 1e-13); });
  add("a point of a net off by 1e-13, the sum right",
      [](StoredComparison& c) { move(c, c.rows - 1, 1e-13); });
  add("half of the Bezier points not compared",
      [](StoredComparison& c) { c.quadratic.resize(c.quadratic.size() / 2); });
  add("abs_sum too small", [](StoredComparison& c) { c.abs_sum = 1 - 1e-12; });
  if (scheme != Scheme::midedge) {
    add("entry_error too small", [](StoredComparison& c) { c.entry_error = 0; });
  }
  for (const std::size_t point : {0u, 2u, 3u, 5u}) {
    add("weight " + std::to_string(point) + " of a quadratic's Bezier point off by 1e-14",
        [point](StoredComparison& c) { spoil_weight(c, point, 1e-14); });
  }
  add("weights of a quadratic's Bezier point off by 1e-14, the sum right", [](StoredComparison& c) {
    spoil_weight(c, 1, 1e-14);
    spoil_weight(c, 4, -1e-14);
  });
  add("a net missing", [](StoredComparison& c) { c.nets.pop_back(); });
  add("a net that starts a row late", [](StoredComparison& c) { ++c.nets.back().first; });
  add("a net that starts behind the last row", [](StoredComparison& c) { c.nets.back().first = c.rows; });
  add("a net that starts nowhere", [](StoredComparison& c) { c.nets.back().first = ~std::uint64_t{0}; });
  add("a net of another kind",
      [](StoredComparison& c) { std::swap(c.nets.back().key[0], c.nets.back().key[1]); });
  add("two control points of a net swapped", [](StoredComparison& c) {
    const std::size_t first = c.nets.back().first;
    for (std::size_t k = 0; k < c.controls; ++k) std::swap(c.weight(first + 3, k), c.weight(first + 4, k));
  });
  for (const std::size_t k : {0u, 5u}) {
    add("an entry of what restricts a quadratic off by 2^-52, row " + std::to_string(k),
        [k](StoredComparison& c) { c.nets.back().restriction[k][k] += 0x1p-52; });
  }
  add("rows of what restricts a quadratic swapped",
      [](StoredComparison& c) { std::swap(c.nets.back().restriction[4], c.nets.back().restriction[3]); });
}

void add_faults_of_frame(std::vector<Fault>& all) {
  const auto add = [&](const std::string& name, const std::function<void(StoredFrame&)>& spoil) {
    all.push_back(of_contents(name + " of the frame",
                              [spoil](BoundsFile& f) { spoil(quadratics_of(f).frame.value()); }));
  };
  all.push_back(of_contents("a bound below what a basis function is at a corner",
                            [](BoundsFile& f) { lower_below_a_limit(quadratics_of(f)); }));
  for (const std::size_t c : {0u, 4u}) {
    add("the bound of basis function " + std::to_string(c) + " lowered by a tenth",
        [c](StoredFrame& frame) { frame.largest[c] *= 0.9; });
  }
  add("a bound of a basis function 0", [](StoredFrame& frame) { frame.largest.back() = 0; });
  for (const double by : {-0.5, 0.5}) {
    add("a place of the layout moved by " + std::to_string(by),
        [by](StoredFrame& frame) { frame.layout[1][0] += by; });
  }
  add("all places moved by 1e-10", [](StoredFrame& frame) {
    for (auto& place : frame.layout) place[0] += 1e-10;
  });
  add("a negative error of offsets", [](StoredFrame& frame) { frame.offset_error = -frame.offset_error; });
  add("no offsets", [](StoredFrame& frame) { frame.offsets.clear(); });
  add("the first offset alone", [](StoredFrame& frame) { frame.offsets.resize(1); });
  for (const std::size_t a : {0u, 1u}) {
    for (const bool least : {false, true}) {
      add("the polygon cut on side " + std::to_string(2 * a + least),
          [a, least](StoredFrame& frame) { cut(frame, a, least); });
    }
  }
}

void add_faults_of_quadratics(Scheme scheme, std::vector<Fault>& all) {
  for (const std::size_t i : {0u, 1u}) add_faults_of_comparison(scheme, i, all);
  add_faults_of_frame(all);
  all.push_back(of_contents("a weight of the fit that is not a number",
                            [](BoundsFile& f) { quadratics_of(f).fit[0][0] = NAN; }));
  all.push_back(of_contents("comparisons swapped", [](BoundsFile& f) {
    auto& [kept, level] = quadratics_of(f).comparisons;
    kept.nets.swap(level.nets);
  }));
}

}  // namespace

std::vector<Fault> faults(const BoundsFile& file) {
  std::vector<Fault> all{
      of_contents("an entry off by 1e-9", [](BoundsFile& f) { f.kinds[0].weight(7, 1) += 1e-9; }),
      of_contents("two entries off by 1e-9 each, the sum right",
                  [](BoundsFile& f) { move(f.kinds[0], 7, 1e-9); }),
      of_contents("a row of the last kind off by 1e-13, the sum right",
                  [](BoundsFile& f) { move(f.kinds.back(), f.kinds.back().rows - 1, 1e-13); }),
      of_contents("the first row missing", [](BoundsFile& f) { remove(f.kinds[0], 0); }),
      of_contents("the last row missing",
                  [](BoundsFile& f) { remove(f.kinds.back(), f.kinds.back().rows - 1); }),
      of_contents("two keys swapped", [](BoundsFile& f) { std::swap(f.kinds[0].key, f.kinds[1].key); }),
      of_contents("a key turned by a corner",
                  [](BoundsFile& f) {
                    Key& key = f.kinds[0].key;
                    std::rotate(key.begin(), key.begin() + 1,
                                key.end() - (f.kinds[0].scheme == Scheme::loop ? 1 : 0));
                  }),
      of_contents("a key mirrored", [](BoundsFile& f) { std::swap(f.kinds[0].key[0], f.kinds[0].key[1]); }),
      of_contents("two control points swapped",
                  [](BoundsFile& f) {
                    for (std::size_t r = 0; r < f.kinds[0].rows; ++r)
                      std::swap(f.kinds[0].weight(r, 3), f.kinds[0].weight(r, 4));
                  }),
      of_contents("abs_sum too small", [](BoundsFile& f) { f.kinds[0].abs_sum = 1 - 1e-12; }),
      of_contents("a kind twice", [](BoundsFile& f) { f.kinds.push_back(f.kinds[0]); }),
      of_contents("another scheme", [](BoundsFile& f) { f.kinds[0].scheme = another(f.kinds[0].scheme); }),
      of_contents("a scheme that is none", [](BoundsFile& f) { f.kinds[0].scheme = static_cast<Scheme>(9); }),
      of_contents("corners that do not fit",
                  [](BoundsFile& f) {
                    f.kinds[0].key[0] = {0, 2, false, false};
                  }),
      of_contents("a weight that is not a number", [](BoundsFile& f) { f.kinds[0].weight(0, 0) = NAN; }),
      of_bytes("a bit changed under the old hash",
               [](auto& bytes) { bytes[bytes.size() / 2] ^= std::byte{1}; }),
      of_bytes("another hash", [](auto& bytes) { bytes[24] ^= std::byte{1}; }),
      of_bytes("another version", [](auto& bytes) { bytes[8] ^= std::byte{3}; }),
      of_bytes("the last word cut off", [](auto& bytes) { bytes.resize(bytes.size() - 8); }),
      of_bytes("the second half cut off", [](auto& bytes) { bytes.resize(bytes.size() / 16 * 8); }),
      of_bytes("the last word cut off and the header set right",
               [](auto& bytes) {
                 bytes.resize(bytes.size() - 8);
                 seal(bytes);
               }),
      of_bytes("nothing left", [](auto& bytes) { bytes.clear(); }),
  };
  if (file.kinds[0].scheme != Scheme::midedge) {  // whose masks are multiples of 1/8: rows are exact
    all.push_back(of_contents("entry_error too small", [](BoundsFile& f) { f.kinds[0].entry_error = 0; }));
  }
  std::size_t tables = 0;
  for (const StoredKind& kind : file.kinds) tables = std::max(tables, kind.tables.size());
  for (std::size_t i = 0; i < tables; ++i) add_faults_of_table(file.kinds[0].scheme, i, all);
  if (file.kinds[0].quadratics) add_faults_of_quadratics(file.kinds[0].scheme, all);
  return all;
}

BoundsFile excerpt(const BoundsFile& file, Scheme scheme) {
  BoundsFile result;
  result.text = file.text;
  const auto add_least = [&](const auto& suits) {
    const StoredKind* least = nullptr;
    for (const StoredKind& kind : file.kinds) {
      if (kind.scheme == scheme && suits(kind.key) && (!least || kind.weights.size() < least->weights.size()))
        least = &kind;
    }
    if (!least) throw Rejected(std::string("no kind to plant faults in: ") + name_of(scheme));
    result.kinds.push_back(*least);
  };
  const auto inside = [](const Key& key) {
    return std::all_of(key.begin(), key.end(), [](const Fan& f) { return f.closed; });
  };
  const auto regular = [&](const Fan& f) { return f.regular(scheme); };
  if (scheme == Scheme::loop) {
    add_least(
        [&](const Key& key) { return inside(key) && !std::all_of(key.begin(), key.end() - 1, regular); });
    add_least(
        [&](const Key& key) { return !inside(key) && !std::all_of(key.begin(), key.end() - 1, regular); });
    return result;
  }
  add_least([&](const Key& key) { return !regular(key[0]) && inside(key); });
  if (scheme == Scheme::catmark) {
    add_least([&](const Key& key) { return !inside(key); });
  } else {
    add_least([&](const Key& key) { return !regular(key[3]); });
  }
  return result;
}

}  // namespace checker
