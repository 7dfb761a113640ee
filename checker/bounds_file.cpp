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
  template <class Rows>
  void table_of_reals(Rows& rows) {
    for (auto& row : rows) reals(row);
  }
  // As many as a word says.
  template <class Row>
  void counted(std::vector<Row>& rows) {
    const std::uint64_t count = whole(8);
    expect_reals(count);
    rows.resize(count);
    table_of_reals(rows);
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

Key read_key(Reader& reader) {
  Key key;
  for (Fan& fan : key) {
    fan.before = static_cast<std::uint16_t>(reader.whole(2));
    fan.after = static_cast<std::uint16_t>(reader.whole(2));
    fan.closed = reader.flag();
    fan.sharp = reader.flag();
    reader.zeros(2);
  }
  return key;
}

// All but their numbers.
void read_rows(Reader& reader, StoredRows& rows) {
  rows.entry_error = reader.real();
  rows.abs_sum = reader.real();
  const std::uint64_t count = std::uint64_t{rows.rows} * rows.controls;
  reader.expect_reals(count);
  rows.weights.resize(count);
  for (double& weight : rows.weights) weight = reader.real();
}

StoredComparison read_comparison(Reader& reader, std::uint32_t controls) {
  StoredComparison comparison;
  comparison.controls = controls;
  comparison.rows = static_cast<std::uint32_t>(reader.whole(4));
  const std::uint64_t bezier_rows = reader.whole(4);
  require(bezier_rows <= comparison.rows, "more Bezier points than rows");
  read_rows(reader, comparison);
  reader.expect_reals(6 * bezier_rows);
  comparison.quadratic.resize(bezier_rows);
  for (std::size_t k = 0; k < 6; ++k) {
    for (SixWeights& row : comparison.quadratic) row[k] = reader.real();
  }
  const std::uint64_t nets = reader.whole(8);
  reader.expect_reals(nets);
  for (std::uint64_t i = 0; i < nets; ++i) {
    StoredNet& net = comparison.nets.emplace_back();
    net.key = read_key(reader);
    net.first = reader.whole(8);
    reader.table_of_reals(net.restriction);
  }
  return comparison;
}

StoredFrame read_frame(Reader& reader, std::uint32_t controls) {
  StoredFrame frame;
  reader.expect_reals(std::uint64_t{3} * controls);
  frame.layout.resize(controls);
  frame.largest.resize(controls);
  reader.table_of_reals(frame.layout);
  for (double& largest : frame.largest) largest = reader.real();
  frame.offset_error = reader.real();
  reader.counted(frame.offsets);
  return frame;
}

StoredQuadratics read_quadratics(Reader& reader, std::uint32_t controls) {
  StoredQuadratics quadratics;
  reader.expect_reals(std::uint64_t{6} * controls);
  quadratics.fit.resize(controls);
  reader.table_of_reals(quadratics.fit);
  for (StoredComparison& comparison : quadratics.comparisons) comparison = read_comparison(reader, controls);
  const std::uint64_t frames = reader.whole(8);
  require(frames <= 1, "more than one frame of a kind");
  if (frames == 1) quadratics.frame = read_frame(reader, controls);
  return quadratics;
}

StoredTable read_table(Reader& reader, Scheme scheme, std::uint32_t controls) {
  StoredTable table;
  reader.expect_reals(std::uint64_t{2} * controls);
  table.layout.resize(controls);
  reader.table_of_reals(table.layout);
  reader.table_of_reals(table.triangle);
  const std::size_t planes = controls - first_bounded(scheme);
  reader.expect_reals(std::uint64_t{6} * planes);
  table.lower.resize(planes);
  table.upper.resize(planes);
  reader.table_of_reals(table.lower);
  reader.table_of_reals(table.upper);
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
  kind.key = read_key(reader);
  kind.rows = static_cast<std::uint32_t>(reader.whole(4));
  kind.controls = static_cast<std::uint32_t>(reader.whole(4));
  require(kind.controls >= 3, "fewer than three control points");
  read_rows(reader, kind);
  const std::uint64_t tables = reader.whole(8);
  require(tables <= 2, "more than two tables of a kind");
  for (std::uint64_t i = 0; i < tables; ++i) {
    kind.tables.push_back(read_table(reader, kind.scheme, kind.controls));
  }
  const std::uint64_t quadratics = reader.whole(8);
  require(quadratics <= 1, "quadratics of a kind that come twice");
  if (quadratics == 1) kind.quadratics = read_quadratics(reader, kind.controls);
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

void write_key(const Key& key, Writer& out) {
  for (const Fan& fan : key) {
    out.whole(fan.before, 2);
    out.whole(fan.after, 2);
    out.whole(fan.closed, 1);
    out.whole(fan.sharp, 1);
    out.whole(0, 2);
  }
}

void write_rows(const StoredRows& rows, Writer& out) {
  out.real(rows.entry_error);
  out.real(rows.abs_sum);
  for (const double weight : rows.weights) out.real(weight);
}

void write_comparison(const StoredComparison& comparison, Writer& out) {
  out.whole(comparison.rows, 4);
  out.whole(comparison.quadratic.size(), 4);
  write_rows(comparison, out);
  for (std::size_t k = 0; k < 6; ++k) {
    for (const SixWeights& row : comparison.quadratic) out.real(row[k]);
  }
  out.whole(comparison.nets.size(), 8);
  for (const StoredNet& net : comparison.nets) {
    write_key(net.key, out);
    out.whole(net.first, 8);
    out.table_of_reals(net.restriction);
  }
}

void write_quadratics(const StoredQuadratics& quadratics, Writer& out) {
  out.table_of_reals(quadratics.fit);
  for (const StoredComparison& comparison : quadratics.comparisons) write_comparison(comparison, out);
  out.whole(quadratics.frame ? 1 : 0, 8);
  if (!quadratics.frame) return;
  const StoredFrame& frame = *quadratics.frame;
  out.table_of_reals(frame.layout);
  for (const double largest : frame.largest) out.real(largest);
  out.real(frame.offset_error);
  out.whole(frame.offsets.size(), 8);
  out.table_of_reals(frame.offsets);
}

void write_kind(const StoredKind& kind, Writer& out) {
  const std::size_t begin = out.bytes().size();
  out.whole(0, 8);
  out.whole(static_cast<std::uint64_t>(kind.scheme), 8);
  write_key(kind.key, out);
  out.whole(kind.rows, 4);
  out.whole(kind.controls, 4);
  write_rows(kind, out);
  out.whole(kind.tables.size(), 8);
  for (const StoredTable& table : kind.tables) {
    out.table_of_reals(table.layout);
    out.table_of_reals(table.triangle);
    out.table_of_reals(table.lower);
    out.table_of_reals(table.upper);
  }
  out.whole(kind.quadratics ? 1 : 0, 8);
  if (kind.quadratics) write_quadratics(*kind.quadratics, out);
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
  require(reader.whole(4) == 5, "another version of the format");
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
  out.whole(5, 4);
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
