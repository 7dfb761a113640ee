#include "file_writer.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/invariant_layout.h>

namespace tablegen {
namespace {

static_assert(std::endian::native == std::endian::little, "fields are written as they lie in memory");

class Bytes {
 public:
  template <class T>
  void add(const T& value) {
    add(&value, 1);
  }
  template <class T>
  void add(const T* values, std::size_t count) {
    const auto* const begin = reinterpret_cast<const std::byte*>(values);
    bytes_.insert(bytes_.end(), begin, begin + count * sizeof(T));
  }
  void align() { bytes_.resize((bytes_.size() + 7) / 8 * 8); }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  void put(std::size_t place, std::uint64_t value) {
    std::memcpy(bytes_.data() + place, &value, sizeof value);
  }
  [[nodiscard]] std::uint64_t hash_from(std::size_t place) const {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (; place < bytes_.size(); place += 8) {
      std::uint64_t word;
      std::memcpy(&word, bytes_.data() + place, sizeof word);
      hash = (hash ^ word) * 0x100000001b3u;
      hash ^= hash >> 29;
    }
    return hash;
  }
  [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

void add_table(const snug::BoundTable& table, Bytes& out) {
  out.add(table.layout.data(), table.layout.size());
  out.add(table.triangle);
  out.add(table.lower.data(), table.lower.size());
  out.add(table.upper.data(), table.upper.size());
}

void add_key(const snug::KindKey& key, Bytes& out) {
  for (const snug::CornerFan& fan : key.corners) {
    out.add(fan.before);
    out.add(fan.after);
    out.add(static_cast<std::uint8_t>(fan.closed));
    out.add(static_cast<std::uint8_t>(fan.sharp));
    out.add(std::uint16_t{0});
  }
}

void add_rows(const snug::BoundingRows& rows, Bytes& out) {
  out.add(rows.entry_error());
  out.add(rows.abs_sum());
  for (std::size_t c = 0; c < rows.control_count(); ++c) out.add(rows.column(c), rows.count());
}

void add_comparison(const snug::BoundingRows& rows,
                    const std::vector<snug::QuadraticRows::Restriction>& restrictions, Bytes& out) {
  out.add(static_cast<std::uint32_t>(rows.count()));
  out.add(static_cast<std::uint32_t>(rows.bezier_count()));
  add_rows(rows, out);
  out.add(rows.quadratic(0), 6 * rows.bezier_count());
  out.add(std::uint64_t{rows.nets().size()});
  for (std::size_t i = 0; i < rows.nets().size(); ++i) {
    add_key(rows.nets()[i].kind->key(), out);
    out.add(std::uint64_t{rows.nets()[i].begin});
    out.add(restrictions[i]);
  }
}

void add_quadratics(snug::BoundsCache& library, const snug::Kind& kind, Bytes& out) {
  const snug::QuadraticRows& quadratics = library.quadratic_rows(kind);
  out.add(quadratics.fit(), 6 * kind.control_count());
  add_comparison(library.rows(kind), quadratics.to_nets(), out);
  add_comparison(library.level_rows(kind), quadratics.to_level_nets(), out);
  out.add(std::uint64_t{quadratics.layout().empty() ? 0u : 1u});
  if (quadratics.layout().empty()) return;
  out.add(quadratics.layout().data(), quadratics.layout().size());
  out.add(quadratics.largest().data(), quadratics.largest().size());
  out.add(quadratics.offset_error());
  out.add(std::uint64_t{quadratics.offsets().size()});
  out.add(quadratics.offsets().data(), quadratics.offsets().size());
}

void add_kind(snug::BoundsCache& library, const snug::Kind& kind, Bytes& out) {
  const snug::BoundingRows rows = snug::make_bounding_rows(kind);
  const std::size_t begin = out.size();
  out.add(std::uint64_t{0});
  out.add(static_cast<std::uint64_t>(kind.key().scheme));
  add_key(kind.key(), out);
  out.add(static_cast<std::uint32_t>(rows.count()));
  out.add(static_cast<std::uint32_t>(rows.control_count()));
  add_rows(rows, out);
  out.add(std::uint64_t{2});
  add_table(snug::make_bound_table(kind, rows), out);
  add_table(snug::make_bound_table(kind, rows, snug::tip_layout(kind)), out);
  out.add(std::uint64_t{1});
  add_quadratics(library, kind, out);
  out.put(begin, out.size() - begin);
}

}  // namespace

std::vector<std::byte> file_of(std::span<const snug::KindKey> keys) {
  constexpr char magic[8] = "snugbnd";
  constexpr std::string_view text =
      "made by tablegen of snug, no arguments; kinds: tablegen/kinds.h; arithmetic: IEEE doubles rounded to "
      "nearest, error terms by snug/geometry/rounding.h; proved by checker";
  constexpr std::size_t size_place = 16, hash_place = 24, hashed = 32;
  Bytes out;
  out.add(magic, 8);
  out.add(std::uint32_t{5});
  out.add(static_cast<std::uint32_t>(keys.size()));
  out.add(std::uint64_t{0});
  out.add(std::uint64_t{0});
  out.add(std::uint64_t{text.size()});
  out.add(text.data(), text.size());
  out.align();
  snug::BoundsCache library;
  for (const snug::KindKey& key : keys) add_kind(library, library.kinds().find(key), out);
  out.put(size_place, out.size());
  out.put(hash_place, out.hash_from(hashed));
  return out.take();
}

}  // namespace tablegen
