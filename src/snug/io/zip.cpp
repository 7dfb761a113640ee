#include <snug/io/zip.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>
#include <utility>

#include <support/binary.h>
#include <support/error.h>
#include <support/text_cursor.h>

#if SNUG_HAS_ZLIB
#include <zlib.h>
#endif

namespace snug {
namespace {

constexpr std::uint32_t local_mark = 0x04034b50, entry_mark = 0x02014b50, end_mark = 0x06054b50,
                        end64_mark = 0x06064b50, locator_mark = 0x07064b50;
constexpr std::size_t local_size = 30, entry_size = 46, end_size = 22, end64_size = 56, locator_size = 20;
constexpr std::uint32_t max_32 = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint16_t stored = 0, deflated = 8;

template <class Number>
Number number_at(std::string_view bytes, std::size_t at) {
  return load<Number>(bytes.data() + at, std::endian::little);
}

/// Of bytes after those of the sum `before`.
std::uint32_t check_sum(std::string_view bytes, std::uint32_t before = 0) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> values{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ ((value & 1) != 0 ? 0xedb88320u : 0u);
      values[i] = value;
    }
    return values;
  }();
  std::uint32_t sum = ~before;
  for (const char c : bytes) sum = sum >> 8 ^ table[(sum ^ static_cast<unsigned char>(c)) & 0xff];
  return ~sum;
}

#if SNUG_HAS_ZLIB
/// Exactly `size` bytes, or nothing.
bool inflate_all(std::string_view packed, std::size_t size, std::string& bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return false;
  stream.next_in =
      reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // NOLINT: zlib only reads there
  std::size_t left_in = packed.size();
  constexpr std::size_t step = std::size_t{1} << 20;
  int status = Z_OK;
  // As many bytes as there turn out to be, not as many as the archive promises.
  while (status == Z_OK && bytes.size() <= size) {
    const std::size_t before = bytes.size();
    bytes.resize(std::min(before + step, size + 1));
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + before);
    stream.avail_out = static_cast<uInt>(bytes.size() - before);
    do {
      if (stream.avail_in == 0) {
        stream.avail_in = static_cast<uInt>(std::min(left_in, step));
        left_in -= stream.avail_in;
      }
      status = inflate(&stream, Z_NO_FLUSH);
    } while (status == Z_OK && stream.avail_out > 0 && (stream.avail_in > 0 || left_in > 0));
    const bool stuck = stream.avail_out > 0;
    bytes.resize(bytes.size() - stream.avail_out);
    if (stuck) break;
  }
  inflateEnd(&stream);
  return status == Z_STREAM_END && bytes.size() == size;
}

#endif

/// Appends what it is given to a text; deflated where there is zlib.
class Packer {
 public:
  explicit Packer(std::string& to) : to_(to) {
#if SNUG_HAS_ZLIB
    if (deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::bad_alloc();
#endif
  }
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

#if SNUG_HAS_ZLIB
  static constexpr std::uint16_t method = deflated;
  ~Packer() { deflateEnd(&stream_); }

  void append(std::string_view bytes) {
    constexpr std::size_t step = std::size_t{1} << 20;
    for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), step)))
      run(bytes.substr(0, step), Z_NO_FLUSH);
  }
  void finish() { run({}, Z_FINISH); }

 private:
  void run(std::string_view bytes, int flush) {
    std::array<char, 1 << 14> packed;
    stream_.next_in =
        reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // NOLINT: zlib only reads there
    stream_.avail_in = static_cast<uInt>(bytes.size());
    do {
      stream_.next_out = reinterpret_cast<Bytef*>(packed.data());
      stream_.avail_out = static_cast<uInt>(packed.size());
      deflate(&stream_, flush);
      to_.append(packed.data(), packed.size() - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

  z_stream stream_{};
#else
  static constexpr std::uint16_t method = stored;
  ~Packer() = default;

  void append(std::string_view bytes) { to_.append(bytes); }
  void finish() {}

 private:
#endif
  std::string& to_;
};

}  // namespace

bool begins_like_zip(std::string_view bytes) { return bytes.starts_with(std::string_view("PK\3\4", 4)); }

ZipArchive::ZipArchive(std::string_view bytes, const std::string& name)
    : bytes_(bytes), name_(name), left_(100 * std::uint64_t{bytes.size()} + (std::uint64_t{1} << 20)) {
  read_directory();
}

void ZipArchive::fail(const std::string& message) const { fail_in_file(name_, "ZIP: " + message); }

void ZipArchive::read_directory() {
  // A comment of up to 64 KiB may follow.
  if (bytes_.size() < end_size) fail("the file is too short for an archive: it is truncated");
  std::size_t end = bytes_.size() - end_size;
  const std::size_t lowest = end - std::min<std::size_t>(end, 0xffff);
  while (number_at<std::uint32_t>(bytes_, end) != end_mark) {
    if (end == lowest) fail("no directory at the end of the file: it is truncated, or no archive");
    --end;
  }
  std::uint64_t count = number_at<std::uint16_t>(bytes_, end + 10),
                size = number_at<std::uint32_t>(bytes_, end + 12),
                begin = number_at<std::uint32_t>(bytes_, end + 16);
  if (end >= locator_size && number_at<std::uint32_t>(bytes_, end - locator_size) == locator_mark) {
    const auto at = number_at<std::uint64_t>(bytes_, end - locator_size + 8);
    if (bytes_.size() < end64_size || at > bytes_.size() - end64_size ||
        number_at<std::uint32_t>(bytes_, at) != end64_mark)
      fail("the directory of its 64-bit form is not where it is said to be");
    count = number_at<std::uint64_t>(bytes_, at + 32);
    size = number_at<std::uint64_t>(bytes_, at + 40);
    begin = number_at<std::uint64_t>(bytes_, at + 48);
  }
  if (begin > bytes_.size() || size > bytes_.size() - begin || count > size / entry_size)
    fail("the directory is beyond the file: it is truncated");
  std::size_t at = begin;
  for (std::uint64_t i = 0; i < count; ++i) read_entry(at);
}

void ZipArchive::read_entry(std::size_t& at) {
  if (bytes_.size() - at < entry_size || number_at<std::uint32_t>(bytes_, at) != entry_mark)
    fail("an entry of the directory is damaged");
  Entry entry{};
  entry.flags = number_at<std::uint16_t>(bytes_, at + 8);
  entry.method = number_at<std::uint16_t>(bytes_, at + 10);
  entry.check = number_at<std::uint32_t>(bytes_, at + 16);
  entry.packed = number_at<std::uint32_t>(bytes_, at + 20);
  entry.size = number_at<std::uint32_t>(bytes_, at + 24);
  entry.begin = number_at<std::uint32_t>(bytes_, at + 42);
  const std::size_t name_size = number_at<std::uint16_t>(bytes_, at + 28),
                    extra_size = number_at<std::uint16_t>(bytes_, at + 30),
                    comment_size = number_at<std::uint16_t>(bytes_, at + 32);
  if (name_size + extra_size + comment_size > bytes_.size() - at - entry_size)
    fail("an entry of the directory is damaged");
  std::string path(bytes_.substr(at + entry_size, name_size));
  std::string_view extra = bytes_.substr(at + entry_size + name_size, extra_size);
  while (extra.size() >= 4) {
    const auto kind = number_at<std::uint16_t>(extra, 0);
    const std::size_t own = std::min<std::size_t>(number_at<std::uint16_t>(extra, 2), extra.size() - 4);
    std::string_view values = extra.substr(4, own);
    extra.remove_prefix(4 + own);
    if (kind != 1) continue;  // what does not fit 32 bits
    for (std::uint64_t* number : {&entry.size, &entry.packed, &entry.begin}) {
      if (*number != max_32 || values.size() < 8) continue;
      *number = number_at<std::uint64_t>(values, 0);
      values.remove_prefix(8);
    }
  }
  if (!entries_.emplace(std::move(path), entry).second) fail("two files of one name");
  at += entry_size + name_size + extra_size + comment_size;
}

std::string_view ZipArchive::packed(const std::string& path, const Entry& entry) const {
  const bool there = entry.begin <= bytes_.size() && bytes_.size() - entry.begin >= local_size &&
                     number_at<std::uint32_t>(bytes_, entry.begin) == local_mark;
  const std::uint64_t begin = there ? entry.begin + local_size +
                                          number_at<std::uint16_t>(bytes_, entry.begin + 26) +
                                          number_at<std::uint16_t>(bytes_, entry.begin + 28)
                                    : 0;
  if (!there || begin > bytes_.size() || entry.packed > bytes_.size() - begin)
    fail(in_quotes(path) + " is not where the directory says: the file is truncated or damaged");
  return bytes_.substr(begin, entry.packed);
}

std::string ZipArchive::read(const std::string& path) {
  const auto found = entries_.find(path);
  if (found == entries_.end()) fail("no file " + in_quotes(path));
  const Entry& entry = found->second;
  if ((entry.flags & 1u) != 0) fail(in_quotes(path) + " is encrypted: write it without a password");
  const std::string_view source = packed(path, entry);
  if (entry.size > left_)
    fail(in_quotes(path) + " would unpack to " + std::to_string(entry.size) +
         " bytes, more than 100 times the file");
  std::string bytes;
  if (entry.method == stored) {
    if (entry.size != source.size()) fail(in_quotes(path) + " has two sizes: the file is damaged");
    bytes = source;
  } else if (entry.method == deflated) {
#if SNUG_HAS_ZLIB
    if (!inflate_all(source, entry.size, bytes))
      fail(in_quotes(path) + " does not unpack: the file is damaged");
#else
    fail(in_quotes(path) + " is compressed, and this snug was built without zlib: store it uncompressed");
#endif
  } else {
    fail(in_quotes(path) + " is compressed by method " + std::to_string(entry.method) +
         ": write it with plain ZIP compression");
  }
  if (check_sum(bytes) != entry.check) fail(in_quotes(path) + " has a wrong check sum: the file is damaged");
  left_ -= entry.size;
  return bytes;
}

void ZipWriter::add(const std::string& path, std::string_view bytes) {
  add(path, [&](const Append& append) { append(bytes); });
}

void ZipWriter::add(const std::string& path, const std::function<void(const Append&)>& fill) {
  const std::size_t begin = bytes_.size(), content = begin + local_size + path.size();
  bytes_.append(local_size, '\0').append(path);
  std::uint32_t check = 0;
  std::size_t size = 0;
  Packer packer(bytes_);
  fill([&](std::string_view bytes) {
    check = check_sum(bytes, check);
    size += bytes.size();
    fits_ = fits_ && bytes_.size() + (std::size_t{1} << 20) < max_32 && size < max_32;
    if (fits_) packer.append(bytes);
  });
  packer.finish();
  // The same date for the same bytes: 1 January 1980.
  const auto append_common = [&](std::string& to) {
    append_binary(to, std::uint16_t{20});     // version needed
    append_binary(to, std::uint16_t{0x800});  // names are UTF-8
    append_binary(to, Packer::method);
    append_binary(to, std::uint16_t{0});
    append_binary(to, std::uint16_t{0x21});
    append_binary(to, check);
    append_binary(to, static_cast<std::uint32_t>(bytes_.size() - content));
    append_binary(to, static_cast<std::uint32_t>(size));
    append_binary(to, static_cast<std::uint16_t>(path.size()));
    append_binary(to, std::uint16_t{0});
  };
  append_binary(directory_, entry_mark);
  append_binary(directory_, std::uint16_t{20});
  append_common(directory_);
  directory_.append(10, '\0');  // no comment, first disk, no attributes
  append_binary(directory_, static_cast<std::uint32_t>(begin));
  directory_ += path;
  std::string head;
  append_binary(head, local_mark);
  append_common(head);
  bytes_.replace(begin, local_size, head);
  ++count_;
}

std::string ZipWriter::finish(const std::string& name) {
  if (!fits_) {
    throw InputError(InputProblem::refused,
                     name + ": the mesh takes more than the 4 GiB of an archive: write PLY");
  }
  const auto begin = static_cast<std::uint32_t>(bytes_.size());
  bytes_ += directory_;
  append_binary(bytes_, end_mark);
  append_binary(bytes_, std::uint32_t{0});  // one disk
  append_binary(bytes_, count_);
  append_binary(bytes_, count_);
  append_binary(bytes_, static_cast<std::uint32_t>(directory_.size()));
  append_binary(bytes_, begin);
  append_binary(bytes_, std::uint16_t{0});
  return std::move(bytes_);
}

}  // namespace snug
