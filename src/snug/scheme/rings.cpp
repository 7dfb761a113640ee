#include <snug/scheme/rings.h>

#include <array>
#include <initializer_list>
#include <utility>
#include <vector>

#include <support/contract.h>

namespace snug {
namespace {

// Faces in the making.
struct FaceList {
  std::vector<std::uint32_t> offsets{0};
  std::vector<VertexId> corners;
  void add(std::initializer_list<std::size_t> face) {
    for (const std::size_t v : face) corners.emplace_back(v);
    end_face();
  }
  void end_face() { offsets.push_back(static_cast<std::uint32_t>(corners.size())); }
  Topology finish(std::size_t vertices) && {
    return Topology(std::move(offsets), std::move(corners), vertices);
  }
};

bool merges(const CornerFan& fan) { return fan.closed && fan.faces() == 3; }

class FaceRing {
 public:
  explicit FaceRing(std::span<const CornerFan> fans) : fans_(fans), size_(fans.size()), count_(size_) {}

  Topology make() {
    size_ == 3 ? faces_.add({0, 1, 2}) : faces_.add({0, 1, 2, 3});
    number_across();
    for (std::size_t i = 0; i < size_; ++i) {
      if (!there(i)) continue;
      const std::size_t next = (i + 1) % size_;
      size_ == 3 ? faces_.add({next, i, near_[i]}) : faces_.add({next, i, near_[i], far_[i]});
    }
    for (std::size_t i = 0; i < size_; ++i) add_fan(i);
    return std::move(faces_).finish(count_);
  }

 private:
  // Is there a face across the edge from corner i?
  [[nodiscard]] bool there(std::size_t i) const { return fans_[i].closed || fans_[i].before > 0; }

  // The vertices across an edge: at its first corner and at its second one, which are one beyond a triangle.
  // At an interior vertex of valence 3 those of both its edges meet.
  void number_across() {
    const std::size_t last = size_ - 1;
    for (std::size_t i = 0; i < size_; ++i) {
      const CornerFan &here = fans_[i], &next = fans_[(i + 1) % size_];
      SNUG_EXPECT((!here.closed && here.before == 0) == (!next.closed && next.after == 0));
      if (!there(i)) continue;
      const bool merged = i > 0 && merges(here), closes = i == last && merges(fans_[0]);
      near_[i] = merged ? far_[i - 1] : size_ == 3 && closes ? near_[0] : count_++;
      far_[i] = size_ == 3 ? near_[i] : closes ? near_[0] : count_++;
    }
  }

  // The faces of corner i that are not across an edge of the patch. A quad has one more, across.
  void add_fan(std::size_t i) {
    const CornerFan& fan = fans_[i];
    std::size_t last = far_[(i + size_ - 1) % size_];
    for (std::size_t k = fan.closed ? 2 : 1; k < fan.after; ++k) {
      const std::size_t diagonal = size_ == 3 ? 0 : count_++;
      const std::size_t spoke = fan.closed && k + 1 == fan.after ? near_[i] : count_++;
      size_ == 3 ? faces_.add({i, last, spoke}) : faces_.add({i, last, diagonal, spoke});
      last = spoke;
    }
    last = near_[i];
    for (std::size_t k = 1; k < fan.before; ++k) {
      const std::size_t diagonal = size_ == 3 ? 0 : count_++, spoke = count_++;
      size_ == 3 ? faces_.add({i, spoke, last}) : faces_.add({i, spoke, diagonal, last});
      last = spoke;
    }
  }

  std::span<const CornerFan> fans_;
  std::size_t size_, count_;
  std::array<std::size_t, 4> near_{}, far_{};
  FaceList faces_;
};

}  // namespace

Topology ring_of_face(std::span<const CornerFan> fans) { return FaceRing(fans).make(); }

Topology ring_of_vertex(std::span<const CornerFan> fans) {
  FaceList faces;
  const std::size_t n = fans.size();
  std::size_t count = n + 1;
  for (std::size_t k = 0; k < n; ++k) {
    faces.corners.emplace_back(0u);
    faces.corners.emplace_back(1 + k);
    for (std::size_t i = 3; i < fans[k].faces(); ++i) faces.corners.emplace_back(count++);
    faces.corners.emplace_back(1 + (k + 1) % n);
    faces.end_face();
  }
  return std::move(faces).finish(count);
}

}  // namespace snug
