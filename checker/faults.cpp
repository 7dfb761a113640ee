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

void remove_row(StoredKind& kind, std::size_t row) {
  StoredKind smaller = kind;
  --smaller.rows;
  smaller.weights.resize(std::size_t{smaller.rows} * smaller.controls);
  for (std::size_t c = 0; c < kind.controls; ++c) {
    for (std::size_t r = 0; r < smaller.rows; ++r) smaller.weight(r, c) = kind.weight(r < row ? r : r + 1, c);
  }
  kind = smaller;
}

// A row and all its copies: pieces that share a corner may each have stored it.
template <class Spoil>
void with_copies(StoredKind& kind, std::size_t row, const Spoil& spoil) {
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
void move(StoredKind& kind, std::size_t row, double weight) {
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
