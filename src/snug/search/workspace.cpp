#include <snug/search/workspace.h>

#include <algorithm>
#include <vector>

namespace snug {
namespace {

constexpr std::size_t byte_limit = std::size_t{512} << 20;
// The memory of workspaces is summed once in so many queries, and when a surface is met for the first time.
constexpr std::uint64_t queries_between_looks = 1024;

}  // namespace

PieceCache& Workspace::Pieces::of(const Surface& surface) {
  begin_query();
  return find(surface, false);
}

Workspace::Pieces::Pair Workspace::Pieces::of(const Surface& a, const Surface& b) {
  begin_query();
  PieceCache& first = find(a, false);
  return {first, find(b, a.data() == b.data())};
}

void Workspace::Pieces::begin_query() {
  if (++query_ % queries_between_looks == 0) drop_old();
}

PieceCache& Workspace::Pieces::find(const Surface& surface, bool second) {
  const SurfaceData& data = *surface.data();
  const std::uint64_t name = 2 * data.storage() + (second ? 1 : 0);
  Recent& recent = recent_[name % recent_.size()];
  if (recent.name != name) {
    Entry& entry = entries_[name];
    if (!entry.pieces) {
      entry.query = query_;
      entry.surface = surface.data();
      drop_old();
      entry.pieces = std::make_unique<PieceCache>(data.bvh());
      entry.number = data.number();
    }
    recent = {name, &entry};
  }
  if (recent.entry->number != data.number()) {
    recent.entry->pieces->renew(data.bvh());
    recent.entry->number = data.number();
  }
  recent.entry->query = query_;
  return *recent.entry->pieces;
}

void Workspace::Pieces::drop_old() {
  recent_ = {};
  std::erase_if(entries_, [&](const auto& item) {
    return item.second.query != query_ && (item.second.surface.expired() || !item.second.pieces);
  });
  for (const Workspace& other : of_other_threads_) other.pieces().drop_gone();
  std::size_t sum = bytes();
  if (sum > byte_limit && !of_other_threads_.empty()) {
    of_other_threads_.clear();
    sum = bytes();
  }
  if (sum <= byte_limit) return;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> by_age;  // last query, name
  for (const auto& [name, entry] : entries_) {
    if (entry.query != query_) by_age.emplace_back(entry.query, name);
  }
  std::sort(by_age.begin(), by_age.end());
  for (const auto& [query, name] : by_age) {
    if (sum <= byte_limit) return;
    sum -= entries_[name].pieces->bytes();
    entries_.erase(name);
  }
}

void Workspace::Pieces::drop_gone() {
  recent_ = {};
  std::erase_if(entries_, [](const auto& item) { return item.second.surface.expired(); });
}

std::size_t Workspace::Pieces::bytes() const {
  std::size_t sum = bytes_kept_;
  for (const auto& [name, entry] : entries_) sum += entry.pieces ? entry.pieces->bytes() : 0;
  for (const Workspace& other : of_other_threads_) sum += other.bytes();
  return sum;
}

void Workspace::Pieces::clear() {
  recent_ = {};
  entries_.clear();
  of_other_threads_.clear();
  kept_ = {};
  bytes_kept_ = 0;
}

Workspace::Workspace() : pieces_(std::make_unique<Pieces>()) {}
Workspace::~Workspace() = default;
Workspace::Workspace(Workspace&& other) noexcept = default;
Workspace& Workspace::operator=(Workspace&& other) noexcept = default;

Workspace& Workspace::of_this_thread() {
  thread_local Workspace workspace;
  return workspace;
}

std::size_t Workspace::bytes() const { return pieces_->bytes(); }
std::size_t Workspace::max_bytes() { return byte_limit; }
void Workspace::clear() { pieces_->clear(); }

}  // namespace snug
