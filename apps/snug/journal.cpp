#include "journal.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fmt/core.h>
#include <snug/run.h>
#include <support/system_files.h>

namespace snug::command {
namespace {

constexpr std::string_view title = "snug journal 1 ";
constexpr std::size_t block = std::size_t{1} << 20;

std::uint64_t key_of(const PartPair& parts) { return std::uint64_t{parts.a} << 32 | parts.b; }
std::string reason() { return std::generic_category().message(errno); }

}  // namespace

Journal::Journal(const std::string& path, std::uint64_t fingerprint) : path_(path) {
  descriptor_ = system_files::open_to_update(path);
  if (descriptor_ < 0) fail("cannot be opened: " + reason());
  try {
    if (system_files::status_of(descriptor_).sort != system_files::Sort::file) {
      fail("is not a file; a journal is read and written");
    }
    if (system_files::lock(descriptor_) != 0) {
      fail("is in use by another run; wait for its end, or name another journal");
    }
    read_entries(fmt::format("{}{:016x}\n", title, fingerprint));
  } catch (...) {
    system_files::close(descriptor_);
    throw;
  }
}

Journal::~Journal() { system_files::close(descriptor_); }

void Journal::fail(const std::string& reason) const {
  throw InputError(InputProblem::unreadable, path_ + ": " + reason);
}

// Takes whole lines of a text that stands at `offset` in the file; `torn` once one is no answer. Returns how many bytes.
std::size_t Journal::take_lines(std::string_view text, std::uint64_t offset, bool& torn) {
  std::size_t taken = 0;
  PartPair parts;
  SceneAnswer answer;
  while (!torn) {
    const auto end = text.find('\n', taken);
    if (end == std::string_view::npos) break;
    torn = !parse_line(text.substr(taken, end - taken), parts, answer);
    if (torn) break;
    entries_.push_back({key_of(parts), offset + taken, static_cast<std::uint32_t>(end - taken)});
    taken = end + 1;
  }
  return taken;
}

void Journal::read_entries(const std::string& head) {
  std::string text;
  std::uint64_t offset = 0;  // of `text` in the file
  bool torn = false, ended = false, headed = false;
  while (!torn && !ended) {
    const std::size_t old = text.size();
    text.resize(old + block);
    const std::ptrdiff_t got = system_files::read_at(descriptor_, text.data() + old, block, offset + old);
    if (got < 0) fail("cannot be read: " + reason());
    text.resize(old + static_cast<std::size_t>(got));
    ended = got == 0;
    if (!headed && (text.size() >= head.size() || ended)) {
      // A journal torn in its first line holds no answer.
      if (text != head.substr(0, text.size()) && !text.starts_with(head)) {
        fail(text.starts_with(title) ? "is the journal of another scene, other meshes or other options; name "
                                       "another one, or remove it"
                                     : "is not a journal of snug; name another file");
      }
      headed = text.size() >= head.size();
      offset = headed ? head.size() : 0;
      text.erase(0, headed ? head.size() : text.size());
    }
    if (!headed) continue;
    const std::size_t taken = take_lines(text, offset, torn);
    text.erase(0, taken);
    offset += taken;
  }
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& x, const Entry& y) { return x.key < y.key; });
  if (system_files::truncate(descriptor_, offset) != 0) fail("cannot be written: " + reason());
  end_ = offset;
  if (!headed) write(head);
}

std::optional<SceneAnswer> Journal::find(const PartPair& parts) const {
  const std::uint64_t key = key_of(parts);
  const auto at = std::lower_bound(entries_.begin(), entries_.end(), key,
                                   [](const Entry& entry, std::uint64_t k) { return entry.key < k; });
  if (at == entries_.end() || at->key != key) return {};
  std::string line(at->size, '\0');
  PartPair read;
  SceneAnswer answer;
  const std::ptrdiff_t got = system_files::read_at(descriptor_, line.data(), line.size(), at->offset);
  const bool whole = got == std::ssize(line) && parse_line(line, read, answer) && read == parts;
  if (!whole) fail("was changed by somebody else; start again with a new journal");
  return answer;
}

void Journal::add(const PartPair& parts, const SceneAnswer& answer) {
  const std::string line = line_of(parts, answer);
  const std::lock_guard lock(mutex_);
  write(line);
}

void Journal::write(std::string_view text) {
  std::uint64_t end = end_;
  for (std::string_view left = text; !left.empty();) {
    const std::ptrdiff_t done = system_files::write_at(descriptor_, left.data(), left.size(), end);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) {
      const std::string why = reason();
      // Half a line would cost those that other threads write after it.
      static_cast<void>(system_files::truncate(descriptor_, end_));
      fail("cannot be written: " + why +
           "; what was finished stays in it: make room, and run again with the same --resume");
    }
    left.remove_prefix(static_cast<std::size_t>(done));
    end += static_cast<std::uint64_t>(done);
  }
  end_ = end;
}

}  // namespace snug::command
