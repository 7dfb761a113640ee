#include <snug/bounds/shipped.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include <snug/base/contract.h>

#ifndef SNUG_SHIPPED_FILE
#error "SNUG_SHIPPED_FILE names the file to compile in"
#endif

asm(".pushsection .rodata\n"
    ".balign 8\n"
    ".globl snug_shipped_begin\n.hidden snug_shipped_begin\n"
    ".globl snug_shipped_end\n.hidden snug_shipped_end\n"
    "snug_shipped_begin:\n"
    ".incbin \"" SNUG_SHIPPED_FILE
    "\"\n"
    "snug_shipped_end:\n"
    ".popsection\n");

extern "C" {
[[gnu::visibility("hidden")]] extern const std::byte snug_shipped_begin[];
[[gnu::visibility("hidden")]] extern const std::byte snug_shipped_end[];
}

namespace snug {
namespace {

static_assert(std::endian::native == std::endian::little, "shipped.bin is read in place");

// Takes fields off the front of a span.
class Fields {
 public:
  explicit Fields(std::span<const std::byte> bytes) : rest_(bytes) {}

  [[nodiscard]] std::span<const std::byte> bytes(std::uint64_t count) {
    SNUG_EXPECT(count <= rest_.size());
    const std::span<const std::byte> result = rest_.first(count);
    rest_ = rest_.subspan(count);
    return result;
  }
  template <class T>
  [[nodiscard]] T next() {
    T value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  template <class T>
  void fill(std::vector<T>& out, std::uint64_t count) {
    SNUG_EXPECT(count <= rest_.size() / sizeof(T));
    out.resize(count);
    std::memcpy(out.data(), bytes(count * sizeof(T)).data(), count * sizeof(T));
  }
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

 private:
  std::span<const std::byte> rest_;
};

std::uint64_t hash_of(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  Fields words(bytes);
  while (!words.rest().empty()) {
    hash = (hash ^ words.next<std::uint64_t>()) * 0x100000001b3u;
    hash ^= hash >> 29;
  }
  return hash;
}

KindKey next_key(Fields& fields) {
  KindKey key;
  key.scheme = static_cast<Scheme>(fields.next<std::uint64_t>());
  for (CornerFan& fan : key.corners) {
    fan.before = fields.next<std::uint16_t>();
    fan.after = fields.next<std::uint16_t>();
    fan.closed = fields.next<std::uint8_t>() != 0;
    fan.sharp = fields.next<std::uint8_t>() != 0;
    static_cast<void>(fields.bytes(2));
  }
  return key;
}

// What comes before the weights.
struct RowsHead {
  std::uint32_t rows, controls;
  double entry_error, abs_sum;
};

}  // namespace

ShippedBounds::ShippedBounds(std::span<const std::byte> file) {
  constexpr char magic[8] = "snugbnd";
  Fields fields(file);
  SNUG_EXPECT(std::memcmp(fields.bytes(8).data(), magic, 8) == 0);
  SNUG_EXPECT(fields.next<std::uint32_t>() == 3);
  const auto kinds = fields.next<std::uint32_t>();
  SNUG_EXPECT(fields.next<std::uint64_t>() == file.size() && file.size() % 8 == 0);
  const auto hash = fields.next<std::uint64_t>();
  SNUG_EXPECT(hash == hash_of(fields.rest()));
  const auto text = fields.next<std::uint64_t>();
  static_cast<void>(fields.bytes((text + 7) / 8 * 8));
  for (std::uint32_t i = 0; i < kinds; ++i) {
    Fields record(fields.bytes(Fields(fields).next<std::uint64_t>()));
    static_cast<void>(record.bytes(8));
    keys_.push_back(next_key(record));
    bodies_.emplace(keys_.back(), record.rest());
  }
  SNUG_EXPECT(fields.rest().empty());
}

const ShippedBounds& ShippedBounds::compiled_in() {
  static const ShippedBounds shipped(compiled_in_file());
  return shipped;
}

std::span<const std::byte> ShippedBounds::compiled_in_file() {
  return {snug_shipped_begin, snug_shipped_end};
}

std::optional<BoundRows> ShippedBounds::rows(const Kind& kind) const {
  const auto found = bodies_.find(kind.key());
  if (found == bodies_.end()) return {};
  Fields fields(found->second);
  const auto head = fields.next<RowsHead>();
  BoundRows result;
  result.count_ = head.rows;
  result.control_count_ = head.controls;
  result.entry_error_ = head.entry_error;
  result.abs_sum_ = head.abs_sum;
  fields.fill(result.weights_, std::uint64_t{head.rows} * head.controls);
  result.find_tips(kind, deepest_tip);
  return result;
}

std::optional<BoundTable> ShippedBounds::table(const KindKey& key) const {
  const auto found = bodies_.find(key);
  if (found == bodies_.end()) return {};
  Fields fields(found->second);
  const auto head = fields.next<RowsHead>();
  static_cast<void>(fields.bytes(std::uint64_t{head.rows} * head.controls * sizeof(double)));
  if (fields.next<std::uint64_t>() == 0) return {};
  const std::size_t planes = head.controls - (laid_by_rings(key) ? 3u : 0u);
  BoundTable table;
  fields.fill(table.layout, head.controls);
  table.triangle = fields.next<std::array<BoundTable::Planar, 3>>();
  fields.fill(table.lower, planes);
  fields.fill(table.upper, planes);
  return table;
}

}  // namespace snug
