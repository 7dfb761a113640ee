#include "bounds_file.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "rejected.h"

namespace checker {
namespace {

constexpr char magic[8] = "snugbnd";
constexpr std::size_t length_place = 16, hash_place = 24, hashed_from = 32;

void require(bool condition, const char* what) {
  if (!condition) throw Rejected(what);
}

// Byte by byte, so that it is right on every machine.
std::uint64_t number_at(std::span<const std::byte> bytes, std::size_t place, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(bytes[place + i]);
  return value;
}

std::uint64_t hash_from(std::span<const std::byte> bytes, std::size_t place) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (; place + 8 <= bytes.size(); place += 8) {
    hash = (hash ^ number_at(bytes, place, 8)) * 0x100000001b3u;
    hash ^= hash >> 29;
  }
  return hash;
}

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  [[nodiscard]] std::uint64_t whole(std::size_t size) {
    require(size <= bytes_.size() - place_, "the file is cut short");
    const std::uint64_t value = number_at(bytes_, place_, size);
    place_ += size;
    return value;
  }
  void zeros(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) require(whole(1) == 0, "padding that is not zero");
  }
  [[nodiscard]] bool flag() {
    const std::uint64_t value = whole(1);
    require(value <= 1, "a flag that is neither 0 nor 1");
    return value == 1;
  }
  [[nodiscard]] double real() {
    const auto value = std::bit_cast<double>(whole(8));
    require(std::isfinite(value), "a number that is not finite");
    return value;
  }
  template <std::size_t N>
  void reals(std::array<double, N>& out) {
    for (double& value : out) value = real();
  }
  // Refuses counts that the file cannot hold before memory is asked for.
  void expect_reals(std::uint64_t count) const {
    require(count <= (bytes_.size() - place_) / 8, "the file is cut short");
  }
  [[nodiscard]] std::size_t place() const { return place_; }
  [[nodiscard]] bool at_end() const { return place_ == bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t place_ = 0;
};

StoredTable read_table(Reader& reader, Scheme scheme, std::uint32_t controls) {
  StoredTable table;
  reader.expect_reals(std::uint64_t{2} * controls);
  table.layout.resize(controls);
  for (auto& place : table.layout) reader.reals(place);
  for (auto& corner : table.triangle) reader.reals(corner);
  const std::size_t planes = controls - first_bounded(scheme);
  reader.expect_reals(std::uint64_t{6} * planes);
  table.lower.resize(planes);
  table.upper.resize(planes);
  for (auto& plane : table.lower) reader.reals(plane);
  for (auto& plane : table.upper) reader.reals(plane);
  return table;
}

StoredKind read_kind(Reader& reader) {
  const std::size_t begin = reader.place();
  const std::uint64_t size = reader.whole(8);
  StoredKind kind;
  const std::uint64_t scheme = reader.whole(1);
  require(scheme < schemes.size(), "a scheme that is not known");
  kind.scheme = schemes[scheme];
  reader.zeros(7);
  for (Fan& fan : kind.key) {
    fan.before = static_cast<std::uint16_t>(reader.whole(2));
    fan.after = static_cast<std::uint16_t>(reader.whole(2));
    fan.closed = reader.flag();
    fan.sharp = reader.flag();
    reader.zeros(2);
  }
  kind.rows = static_cast<std::uint32_t>(reader.whole(4));
  kind.controls = static_cast<std::uint32_t>(reader.whole(4));
  require(kind.controls >= 3, "fewer than three control points");
  kind.entry_error = reader.real();
  kind.abs_sum = reader.real();
  const std::uint64_t count = std::uint64_t{kind.rows} * kind.controls;
  reader.expect_reals(count);
  kind.weights.resize(count);
  for (double& weight : kind.weights) weight = reader.real();
  const std::uint64_t tables = reader.whole(8);
  require(tables <= 2, "more than two tables of a kind");
  for (std::uint64_t i = 0; i < tables; ++i) {
    kind.tables.push_back(read_table(reader, kind.scheme, kind.controls));
  }
  require(reader.place() - begin == size, "a record is not as long as it says");
  return kind;
}

void put(std::vector<std::byte>& bytes, std::size_t place, std::uint64_t value) {
  for (std::size_t i = 0; i < 8; ++i, value >>= 8) bytes[place + i] = static_cast<std::byte>(value & 255);
}

class Writer {
 public:
  void whole(std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i, value >>= 8) bytes_.push_back(static_cast<std::byte>(value & 255));
  }
  void real(double value) { whole(std::bit_cast<std::uint64_t>(value), 8); }
  template <class Rows>
  void table_of_reals(const Rows& rows) {
    for (const auto& row : rows) {
      for (const double value : row) real(value);
    }
  }
  void align() { bytes_.resize((bytes_.size() + 7) / 8 * 8); }
  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

void write_kind(const StoredKind& kind, Writer& out) {
  const std::size_t begin = out.bytes().size();
  out.whole(0, 8);
  out.whole(static_cast<std::uint64_t>(kind.scheme), 8);
  for (const Fan& fan : kind.key) {
    out.whole(fan.before, 2);
    out.whole(fan.after, 2);
    out.whole(fan.closed, 1);
    out.whole(fan.sharp, 1);
    out.whole(0, 2);
  }
  out.whole(kind.rows, 4);
  out.whole(kind.controls, 4);
  out.real(kind.entry_error);
  out.real(kind.abs_sum);
  for (const double weight : kind.weights) out.real(weight);
  out.whole(kind.tables.size(), 8);
  for (const StoredTable& table : kind.tables) {
    out.table_of_reals(table.layout);
    out.table_of_reals(table.triangle);
    out.table_of_reals(table.lower);
    out.table_of_reals(table.upper);
  }
  put(out.bytes(), begin, out.bytes().size() - begin);
}

}  // namespace

const char* name_of(Scheme scheme) {
  switch (scheme) {
    case Scheme::loop:
      return "Loop";
    case Scheme::catmark:
      return "Catmull-Clark";
    case Scheme::doo_sabin:
      return "Doo-Sabin";
    case Scheme::midedge:
      break;
  }
  return "Midedge";
}

bool Fan::regular(Scheme scheme) const {
  switch (scheme) {
    case Scheme::loop:
      return !sharp && (closed ? faces() == 6 : faces() == 3);
    case Scheme::catmark:
      return closed ? !sharp && faces() == 4 : faces() == (sharp ? 1u : 2u);
    case Scheme::doo_sabin:
    case Scheme::midedge:
      break;
  }
  return !sharp && closed && faces() == 4;
}

std::string to_text(Scheme scheme, const Key& key) {
  std::string text;
  for (std::size_t k = 0; k < (scheme == Scheme::loop ? 3u : 4u); ++k) {
    const Fan& fan = key[k];
    if (!text.empty()) text += ", ";
    text += fan.closed ? std::to_string(fan.faces())
                       : std::to_string(fan.before) + "+1+" + std::to_string(fan.after);
    if (fan.sharp) text += " sharp";
  }
  return name_of(scheme) + std::string(" (") + text + ")";
}

BoundsFile parse(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  require(bytes.size() >= sizeof magic && std::memcmp(bytes.data(), magic, sizeof magic) == 0,
          "not a file of bounds: the first bytes are others");
  static_cast<void>(reader.whole(8));
  require(reader.whole(4) == 4, "another version of the format");
  const std::uint64_t kinds = reader.whole(4);
  require(reader.whole(8) == bytes.size() && bytes.size() % 8 == 0, "the file is not as long as it says");
  const std::uint64_t hash = reader.whole(8);
  require(hash == hash_from(bytes, hashed_from), "the hash is another");
  BoundsFile file;
  const std::uint64_t length = reader.whole(8);
  require(length < bytes.size(), "the file is cut short");
  for (std::uint64_t i = 0; i < length; ++i) file.text += static_cast<char>(reader.whole(1));
  reader.zeros((8 - length % 8) % 8);
  for (std::uint64_t i = 0; i < kinds; ++i) file.kinds.push_back(read_kind(reader));
  require(reader.at_end(), "bytes behind the last kind");
  return file;
}

std::vector<std::byte> to_bytes(const BoundsFile& file) {
  Writer out;
  for (const char c : magic) out.whole(static_cast<unsigned char>(c), 1);
  out.whole(4, 4);
  out.whole(file.kinds.size(), 4);
  out.whole(0, 8);
  out.whole(0, 8);
  out.whole(file.text.size(), 8);
  for (const char c : file.text) out.whole(static_cast<unsigned char>(c), 1);
  out.align();
  for (const StoredKind& kind : file.kinds) write_kind(kind, out);
  seal(out.bytes());
  return std::move(out.bytes());
}

void seal(std::vector<std::byte>& bytes) {
  if (bytes.size() < hashed_from) return;
  put(bytes, length_place, bytes.size());
  put(bytes, hash_place, hash_from(bytes, hashed_from));
}

}  // namespace checker
