#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <snug/certificate/separation.h>

namespace snug {

/// Two parts of a scene, the lower number first.
using PartNumbers = std::pair<std::uint32_t, std::uint32_t>;

/// Parts in an order whose halves lie apart.
class SceneTree {
 public:
  explicit SceneTree(std::vector<CertifiedSide> parts);

  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
  [[nodiscard]] const CertifiedSide& part(std::uint32_t i) const { return parts_[i]; }
  /// Appends trees that prove the hulls of all pairs of parts to be more than `margin` apart, but for those in `except`, to
  /// which others are added where their hulls are not.
  void append(std::string& text, double margin, std::set<PartNumbers>& except, const WorkMonitor& monitor);

 private:
  struct Node {
    std::size_t begin, end;
    Box3 box;
    double magnitude;
    std::array<std::size_t, 2> halves{};
  };
  std::size_t add_node(std::size_t begin, std::size_t end);
  void append_pair(std::string& text, const Node& a, const Node& b, double margin,
                   std::set<PartNumbers>& except);

  std::vector<CertifiedSide> parts_;
  std::vector<Box3> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace snug
