#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace snug {

/// An index that cannot be mistaken for an index of another sort: comparing two sorts does not compile.
template <class Tag>
class Id {
 public:
  constexpr Id() = default;
  constexpr explicit Id(std::size_t value) : value_(static_cast<std::uint32_t>(value)) {}
  [[nodiscard]] constexpr std::uint32_t value() const noexcept { return value_; }
  /// For indexing arrays.
  [[nodiscard]] constexpr std::size_t index() const noexcept { return value_; }
  [[nodiscard]] constexpr bool valid() const noexcept { return value_ != UINT32_MAX; }
  friend constexpr auto operator<=>(Id, Id) = default;

 private:
  std::uint32_t value_ = UINT32_MAX;
};

using VertexId = Id<struct VertexTag>;
using EdgeId = Id<struct EdgeTag>;
using FaceId = Id<struct FaceTag>;
using PolylineId = Id<struct PolylineTag>;
/// A patch kind in a KindCache (patch/kind_cache.h).
using KindId = Id<struct KindTag>;

}  // namespace snug

template <class Tag>
struct std::hash<snug::Id<Tag>> {
  std::size_t operator()(snug::Id<Tag> id) const noexcept { return id.value(); }
};
