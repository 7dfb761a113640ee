#include <snug/basis/bound_library.h>

#include <memory>

#include <snug/base/contract.h>
#include <snug/basis/shipped.h>

namespace snug {

BoundLibrary::~BoundLibrary() {
  for (auto& place : blocks_) {
    const std::unique_ptr<Block> block(place.load());
    if (!block) continue;
    for (auto& rows : *block) delete rows.load();
  }
}

const BoundRows& BoundLibrary::rows(const Kind& kind) {
  const std::size_t index = kind.id().index();
  SNUG_EXPECT(index / block_size < blocks_.size());
  std::atomic<Block*>& block_place = blocks_[index / block_size];
  Block* block = block_place.load(std::memory_order_acquire);
  if (!block) {
    const std::lock_guard lock(growth_);
    block = block_place.load(std::memory_order_acquire);
    if (!block) block_place.store(block = new Block{}, std::memory_order_release);
  }
  std::atomic<const BoundRows*>& place = (*block)[index % block_size];
  if (const BoundRows* ready = place.load(std::memory_order_acquire)) return *ready;
  // Two threads may make the same rows; the first to finish keeps them. Both are equal.
  std::optional<BoundRows> shipped = ShippedBounds::compiled_in().rows(kind.key());
  auto fresh = std::make_unique<const BoundRows>(shipped ? *std::move(shipped) : make_bound_rows(kind));
  const BoundRows* expected = nullptr;
  if (!place.compare_exchange_strong(expected, fresh.get(), std::memory_order_acq_rel)) return *expected;
  count_.fetch_add(1);
  bytes_.fetch_add(fresh->bytes());
  return *fresh.release();
}

}  // namespace snug
