#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace snug {

/// An array that grows by blocks: elements stay where they are, and less than a block is to spare.
template <class T>
class Blocks {
 public:
  Blocks() = default;
  explicit Blocks(std::size_t size) { resize(size); }
  Blocks(const std::vector<T>& elements) {  // NOLINT: the same elements
    for (const T& element : elements) push_back(element);
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T& operator[](std::size_t i) { return blocks_[i / block_size][i % block_size]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return blocks_[i / block_size][i % block_size]; }
  /// Does not shrink.
  void resize(std::size_t size) {
    while (blocks_.size() * block_size < size) blocks_.push_back(std::make_unique<T[]>(block_size));
    size_ = size;
  }
  void push_back(const T& value) {
    resize(size_ + 1);
    (*this)[size_ - 1] = value;
  }

 private:
  // Smaller blocks of large elements stay with the heap once they are free: peaks are then a sixth higher.
  static constexpr std::size_t block_size = sizeof(T) <= 32 ? 4096 : 1024;
  std::vector<std::unique_ptr<T[]>> blocks_;
  std::size_t size_ = 0;
};

}  // namespace snug
