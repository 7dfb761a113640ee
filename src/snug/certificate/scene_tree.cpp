#include <snug/certificate/scene_tree.h>

#include <algorithm>
#include <numeric>

#include <snug/certificate/disc.h>
#include <support/point.h>
#include <support/run.h>

namespace snug {
SceneTree::SceneTree(std::vector<CertifiedSide> parts) : parts_(std::move(parts)), order_(parts_.size()) {
  for (const CertifiedSide& part : parts_) boxes_.push_back(box_of(part.pieces->hull(part.pose)));
  std::iota(order_.begin(), order_.end(), 0U);
  std::vector<Point3> middles;
  for (const Box3& box : boxes_) middles.push_back(box.lower + 0.5 * (box.upper - box.lower));
  sort_in_halves(order_, middles);
  if (!parts_.empty()) add_node(0, parts_.size());
}

std::size_t SceneTree::add_node(std::size_t begin, std::size_t end) {
  const std::size_t index = nodes_.size();
  Node node{begin, end, {}, 0};
  for (std::size_t i = begin; i < end; ++i) {
    node.box.add(boxes_[order_[i]]);
    node.magnitude = std::max(node.magnitude, parts_[order_[i]].magnitude);
  }
  nodes_.push_back(node);
  if (end - begin < 2) return index;
  const std::size_t middle = begin + (end - begin) / 2;
  const std::size_t first = add_node(begin, middle), second = add_node(middle, end);
  nodes_[index].halves = {first, second};
  return index;
}

void SceneTree::append(std::string& text, double margin, std::set<PartNumbers>& except,
                       const WorkMonitor& monitor) {
  for (const Node& node : nodes_) {  // which stand in the order in which the proof has them
    monitor.checkpoint();
    if (node.end - node.begin > 1)
      append_pair(text, nodes_[node.halves[0]], nodes_[node.halves[1]], margin, except);
  }
}

void SceneTree::append_pair(std::string& text, const Node& a, const Node& b, double margin,
                            std::set<PartNumbers>& except) {
  const bool is_leaf = a.end - a.begin == 1 && b.end - b.begin == 1;
  const std::uint32_t i = order_[a.begin], j = order_[b.begin];
  Vector3 hint;
  const double magnitude = std::max(a.magnitude, b.magnitude);
  auto direction = separating_direction(corners_of(a.box), corners_of(b.box), margin, magnitude, hint);
  if (!direction && is_leaf && !except.contains(std::minmax(i, j))) {
    direction = separating_direction(parts_[i].pieces->hull(parts_[i].pose),
                                     parts_[j].pieces->hull(parts_[j].pose), margin, magnitude, hint);
  }
  if (direction) {
    append_direction(text, *direction);
    return;
  }
  if (is_leaf) {
    except.insert(std::minmax(i, j));
    text += " x\n";
    return;
  }
  const bool divides_a =
      b.end - b.begin == 1 || (a.end - a.begin > 1 && longest_side(a.box) >= longest_side(b.box));
  text += divides_a ? " A" : " B";
  for (const std::size_t half : (divides_a ? a : b).halves) {
    divides_a ? append_pair(text, nodes_[half], b, margin, except)
              : append_pair(text, a, nodes_[half], margin, except);
  }
}

}  // namespace snug
