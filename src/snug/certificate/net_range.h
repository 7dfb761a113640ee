#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <snug/mesh/topology.h>
#include <snug/scheme/creases.h>
#include <snug/scheme/scheme.h>
#include <snug/surface.h>

namespace snug {

/// A control mesh, or what a step makes of a part of one, in double precision: only hints for certificates, which
/// are checked by others, rest on it.
struct CertifiedNet {
  Topology topology;
  Sharpness sharpness;
  std::vector<Point3> points;
  /// Faces, or of a dual scheme half-edges that leave a vertex in the face that is counted first around it.
  std::vector<std::uint32_t> owners;
};

/// Owners of a net that follow each other, as docs/certificates.md counts them. Halves and finer ranges are made when
/// they are first asked for, and are kept.
class NetRange {
 public:
  NetRange(std::shared_ptr<const CertifiedNet> net, const SchemeOptions& options, std::size_t begin,
           std::size_t end, unsigned level)
      : net_(std::move(net)), options_(options), begin_(begin), end_(end), level_(level) {}

  [[nodiscard]] std::size_t size() const { return end_ - begin_; }
  /// Steps from the control mesh.
  [[nodiscard]] unsigned level() const { return level_; }
  /// Requires:  size() >= 2.
  NetRange& half(std::size_t which);
  /// The same pieces of the surface, each as those that a step makes of it.
  NetRange& finer();
  /// Drops all that was made of this range.
  void forget() {
    for (auto& half : halves_) half.reset();
    finer_.reset();
  }
  /// Requires:  owner < size().
  [[nodiscard]] std::unique_ptr<NetRange> only(std::size_t owner) const;
  /// About where the pieces lie: a box around their vertices, or the middles of faces around those of a dual scheme.
  [[nodiscard]] Box3 rough_box(const Motion& pose) const;
  /// Some of the owners, which are counted in the range.
  [[nodiscard]] std::unique_ptr<NetRange> some(std::span<const std::size_t> owners) const;
  /// Points whose hull contains the pieces, where they are placed.
  [[nodiscard]] std::vector<Point3> hull(const Motion& pose) const;
  /// Corners of the only owner: of a face, or faces around a vertex.
  [[nodiscard]] std::size_t corner_count() const;
  [[nodiscard]] bool dual() const;
  [[nodiscard]] bool triangular() const;

 private:
  [[nodiscard]] std::span<const std::uint32_t> owners() const {
    return std::span(net_->owners).subspan(begin_, size());
  }
  // The faces that decide about the owners, by their first half-edges.
  [[nodiscard]] std::vector<HalfEdge> faces_around(unsigned rings) const;

  std::shared_ptr<const CertifiedNet> net_;
  const SchemeOptions& options_;
  std::size_t begin_, end_;
  unsigned level_;
  std::unique_ptr<NetRange> halves_[2], finer_;
};

/// Sorts numbers so that the halves lie apart, and their halves; `middles`: where each number lies.
void sort_in_halves(std::span<std::uint32_t> order, std::span<const Point3> middles);

/// A surface as certificates have it: its owners in an order whose halves lie apart.
class CertifiedSurface {
 public:
  explicit CertifiedSurface(const Surface& surface);
  CertifiedSurface(const CertifiedSurface&) = delete;
  CertifiedSurface& operator=(const CertifiedSurface&) = delete;

  /// Rules, points, faces, tags and order.
  void write(std::string& text) const;
  [[nodiscard]] NetRange& all() { return *all_; }
  /// Where an owner stands in the order.
  [[nodiscard]] std::size_t position_of(std::uint32_t owner) const { return positions_[owner]; }
  [[nodiscard]] const Surface& surface() const { return surface_; }
  /// Why no certificate says anything about such a surface; empty if it can.
  [[nodiscard]] static std::string refusal(const Surface& surface);
  /// One owner of each component.
  [[nodiscard]] std::vector<std::uint32_t> owner_of_each_component() const;
  /// The children that lead to a place, one a step.
  /// Requires:  a limit point at the place.
  [[nodiscard]] std::vector<std::size_t> steps_to(const Place& at, std::size_t count) const;

 private:
  void find_owners();

  Surface surface_;
  SchemeOptions options_;
  std::shared_ptr<CertifiedNet> net_;
  std::vector<std::uint32_t> order_;  // faces or vertices
  std::vector<std::size_t> positions_;
  std::unique_ptr<NetRange> all_;
};

}  // namespace snug
