#include "file_writer.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include <snug/bounds/bound_rows.h>
#include <snug/bounds/bound_table.h>
#include <snug/bounds/lasting_layout.h>

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

void add_kind(const snug::Kind& kind, Bytes& out) {
  const snug::BoundRows rows = snug::make_bound_rows(kind);
  const std::size_t begin = out.size();
  out.add(std::uint64_t{0});
  out.add(static_cast<std::uint64_t>(kind.key().scheme));
  for (const snug::CornerFan& fan : kind.key().corners) {
    out.add(fan.before);
    out.add(fan.after);
    out.add(static_cast<std::uint8_t>(fan.closed));
    out.add(static_cast<std::uint8_t>(fan.sharp));
    out.add(std::uint16_t{0});
  }
  out.add(static_cast<std::uint32_t>(rows.count()));
  out.add(static_cast<std::uint32_t>(rows.control_count()));
  out.add(rows.entry_error());
  out.add(rows.abs_sum());
  for (std::size_t c = 0; c < rows.control_count(); ++c) out.add(rows.column(c), rows.count());
  out.add(std::uint64_t{2});
  add_table(snug::make_bound_table(kind, rows), out);
  add_table(snug::make_bound_table(kind, rows, snug::tip_layout(kind)), out);
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
  out.add(std::uint32_t{4});
  out.add(static_cast<std::uint32_t>(keys.size()));
  out.add(std::uint64_t{0});
  out.add(std::uint64_t{0});
  out.add(std::uint64_t{text.size()});
  out.add(text.data(), text.size());
  out.align();
  snug::KindCache library;
  for (const snug::KindKey& key : keys) add_kind(library.find(key), out);
  out.put(size_place, out.size());
  out.put(hash_place, out.hash_from(hashed));
  return out.take();
}

}  // namespace tablegen
