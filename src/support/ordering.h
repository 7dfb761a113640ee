#pragma once

#include <cstddef>
#include <utility>

/// Sorting and heaps where what the standard leaves open decides digits of an answer: in which order elements come that are
/// equal, such as candidates at the same distance, and those before and behind the median. Here every standard library gives
/// the same.
///
/// Source:    the heap of [Floyd64]; introspective sort [Musser97] with the steps of libstdc++.
namespace snug::ordering {

/// Fills the hole of a heap: moves larger children up until a leaf, then `value` from there up to its place.
template <class Item, class Less>
void sift_down(Item* heap, std::size_t size, std::size_t hole, Item value, const Less& less) {
  const std::size_t top = hole;
  for (std::size_t child = 2 * hole + 1; child < size; child = 2 * hole + 1) {
    if (child + 1 < size && !less(heap[child + 1], heap[child])) ++child;
    heap[hole] = std::move(heap[child]);
    hole = child;
  }
  for (std::size_t parent; hole > top && less(heap[parent = (hole - 1) / 2], value); hole = parent) {
    heap[hole] = std::move(heap[parent]);
  }
  heap[hole] = std::move(value);
}

template <class Item, class Less>
void make_heap(Item* heap, std::size_t size, const Less& less) {
  for (std::size_t i = size / 2; i > 0; --i) sift_down(heap, size, i - 1, Item(std::move(heap[i - 1])), less);
}

/// Adds the last element of a vector to the heap before it.
template <class Item, class Less>
void push_heap(Item* heap, std::size_t size, const Less& less) {
  Item value = std::move(heap[size - 1]);
  std::size_t hole = size - 1;
  for (std::size_t parent; hole > 0 && less(heap[parent = (hole - 1) / 2], value); hole = parent) {
    heap[hole] = std::move(heap[parent]);
  }
  heap[hole] = std::move(value);
}

/// Moves the largest element of a heap to its end.
template <class Item, class Less>
void pop_heap(Item* heap, std::size_t size, const Less& less) {
  if (size < 2) return;
  Item value = std::move(heap[size - 1]);
  heap[size - 1] = std::move(heap[0]);
  sift_down(heap, size - 1, 0, std::move(value), less);
}

/// The `middle` least elements come first, as a heap.
template <class Item, class Less>
void heap_select(Item* items, std::size_t middle, std::size_t size, const Less& less) {
  if (middle == 0) return;
  ordering::make_heap(items, middle, less);
  for (std::size_t i = middle; i < size; ++i) {
    if (!less(items[i], items[0])) continue;
    Item value = std::move(items[i]);
    items[i] = std::move(items[0]);
    sift_down(items, middle, 0, std::move(value), less);
  }
}

/// The `middle` least elements come first, in order.
template <class Item, class Less>
void partial_sort(Item* items, std::size_t middle, std::size_t size, const Less& less) {
  heap_select(items, middle, size, less);
  for (std::size_t left = middle; left > 1; --left) ordering::pop_heap(items, left, less);
}

/// Equal elements keep their order.
template <class Item, class Less>
void insertion_sort(Item* items, std::size_t sorted, std::size_t size, const Less& less) {
  for (std::size_t i = sorted; i < size; ++i) {
    Item value = std::move(items[i]);
    std::size_t hole = i;
    for (; hole > 0 && less(value, items[hole - 1]); --hole) items[hole] = std::move(items[hole - 1]);
    items[hole] = std::move(value);
  }
}

template <class Item, class Less>
void median_to_front(Item* items, std::size_t size, const Less& less) {
  Item &a = items[1], &b = items[size / 2], &c = items[size - 1];
  const bool ab = less(a, b);
  Item& median = ab ? (less(b, c) ? b : less(a, c) ? c : a) : (less(a, c) ? a : less(b, c) ? c : b);
  std::swap(items[0], median);
}

/// Around a median of three: elements before the place returned are not larger, the others not smaller.
/// Requires:  at least three.
template <class Item, class Less>
std::size_t partition(Item* items, std::size_t size, const Less& less) {
  median_to_front(items, size, less);
  std::size_t low = 1, high = size;
  for (;; ++low) {
    while (less(items[low], items[0])) ++low;
    do --high;
    while (less(items[0], items[high]));
    if (!(low < high)) return low;
    std::swap(items[low], items[high]);
  }
}

/// How often parts are divided before heaps take over, which no input slows down.
constexpr unsigned max_divisions(std::size_t size) {
  unsigned count = 0;
  for (; size > 1; size /= 2) count += 2;
  return count;
}

/// Sorts but for parts of few elements.
template <class Item, class Less>
void sort_roughly(Item* items, std::size_t size, unsigned divisions, const Less& less) {
  constexpr std::size_t few = 16;
  while (size > few) {
    if (divisions-- == 0) return ordering::partial_sort(items, size, size, less);
    const std::size_t middle = partition(items, size, less);
    sort_roughly(items + middle, size - middle, divisions, less);
    size = middle;
  }
}

template <class Item, class Less>
void sort(Item* items, std::size_t size, const Less& less) {
  sort_roughly(items, size, max_divisions(size), less);
  insertion_sort(items, 1, size, less);
}

/// The element that sorting would put at `place` comes there, no larger ones before it, no smaller ones behind it. Nothing
/// happens without a place.
template <class Item, class Less>
void nth_element(Item* items, std::size_t place, std::size_t size, const Less& less) {
  if (place >= size) return;
  for (unsigned divisions = max_divisions(size); size > 3; --divisions) {
    if (divisions == 0) {
      heap_select(items, place + 1, size, less);
      return std::swap(items[0], items[place]);
    }
    const std::size_t middle = partition(items, size, less);
    if (middle <= place) {
      items += middle;
      place -= middle;
      size -= middle;
    } else {
      size = middle;
    }
  }
  insertion_sort(items, 1, size, less);
}

}  // namespace snug::ordering
