#pragma once

#include <map>
#include <memory>
#include <string>

#include <snug/certificate/separation.h>
#include <snug/ray.h>

namespace snug {

/// Writes certificates: surfaces, questions about two sets each, and claims with their proofs. Nothing here is proved; who
/// checks the text proves it. Questions without a claim are left out.
class CertificateWriter {
 public:
  explicit CertificateWriter(const WorkMonitor& monitor) : monitor_(monitor) {}

  /// Begins a question about two placed surfaces; about a surface and a point; and a ray.
  void ask(const PlacedSurface& a, const PlacedSurface& b);
  void ask(const PlacedSurface& a, const Point3& b);
  void ask(const PlacedSurface& a, const Ray& b);

  /// The two are more than `margin` apart. Without a proof nothing is written.
  Found apart(double margin);
  /// The same for a lower end that may be as tight as doubles allow: less some 2^-38 of the largest coordinate. Without a
  /// proof of it nine tenths of it, half of it and 0 are tried; what is then written does not change the result.
  Found at_least(double lower);
  /// These limit points are at most as far apart as the result, which is at least `upper` and hardly more.
  double near(double upper, const Place& a, const Place* b);

  /// The two have a point in common, near these places; of a segment none. False if no proof was found; nothing is then
  /// written.
  bool meet(const Place& a, const Place* b);

  /// The text, with its end; empty if nothing was proved.
  [[nodiscard]] std::string finished();

 private:
  std::size_t index_of(const Surface& surface);
  void begin_question();
  void drop_question_without_claim();
  void set_side(std::size_t side, const PlacedSurface& surface);
  // Appends the name of a piece around a place and gives its box, where it is placed.
  Box3 append_place(std::size_t side, const Place& at);

  const WorkMonitor& monitor_;
  std::string text_ = "snug-certificate 1\n";
  bool has_claims_ = false;
  std::size_t asked_ = 0;
  std::size_t question_ = 0, claims_ = 0;  // where the last question and its claims begin; 0: there is none
  std::map<const SurfaceData*, std::size_t> indices_;
  std::vector<std::unique_ptr<CertifiedSurface>> surfaces_;
  std::array<CertifiedSide, 2> sides_;
  std::array<CertifiedSurface*, 2> of_sides_{};
};

}  // namespace snug
