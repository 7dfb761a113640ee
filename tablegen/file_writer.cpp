#include "file_writer.h"

#include <bit>
#include <cstdint>
#include <cstring>

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

void add_kind(const KindBounds& kind, Bytes& out) {
  const std::size_t begin = out.size();
  out.add(std::uint64_t{0});
  out.add(static_cast<std::uint64_t>(kind.key.scheme));
  for (const snug::CornerFan& fan : kind.key.corners) {
    out.add(fan.before);
    out.add(fan.after);
    out.add(static_cast<std::uint8_t>(fan.closed));
    out.add(static_cast<std::uint8_t>(fan.sharp));
    out.add(std::uint16_t{0});
  }
  out.add(static_cast<std::uint32_t>(kind.rows.count()));
  out.add(static_cast<std::uint32_t>(kind.rows.control_count()));
  out.add(kind.rows.entry_error());
  out.add(kind.rows.abs_sum());
  for (std::size_t c = 0; c < kind.rows.control_count(); ++c) out.add(kind.rows.column(c), kind.rows.count());
  out.add(std::uint64_t{1});
  out.add(kind.table.layout.data(), kind.table.layout.size());
  out.add(kind.table.triangle);
  out.add(kind.table.lower.data(), kind.table.lower.size());
  out.add(kind.table.upper.data(), kind.table.upper.size());
  out.put(begin, out.size() - begin);
}

}  // namespace

std::vector<std::byte> file_of(const std::vector<KindBounds>& kinds, std::string_view text) {
  constexpr char magic[8] = "snugbnd";
  constexpr std::size_t size_place = 16, hash_place = 24, hashed = 32;
  Bytes out;
  out.add(magic, 8);
  out.add(std::uint32_t{3});
  out.add(static_cast<std::uint32_t>(kinds.size()));
  out.add(std::uint64_t{0});
  out.add(std::uint64_t{0});
  out.add(std::uint64_t{text.size()});
  out.add(text.data(), text.size());
  out.align();
  for (const KindBounds& kind : kinds) add_kind(kind, out);
  out.put(size_place, out.size());
  out.put(hash_place, out.hash_from(hashed));
  return out.take();
}

}  // namespace tablegen
