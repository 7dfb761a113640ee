#pragma once

#include <map>
#include <memory>
#include <string>

#include <snug/certificate/scene_tree.h>
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

  /// Begins a question about many parts, of which pairs are asked then.
  void ask(std::span<const PlacedSurface> parts);
  /// All pairs of parts but those of `except` have hulls more than `margin` apart; pairs without a proof are added to these.
  void hulls(double margin, std::set<PartNumbers>& except);
  void pair(std::uint32_t a, std::uint32_t b);

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

  /// How often a closed surface, which is the first if the point is the second, winds around a point: a limit point of
  /// the other one, or that which it is. Nothing if no proof was found; nothing is then written.
  std::optional<int> winding(std::size_t side, const Place* at);
  /// What apart() has proved of two surfaces holds of the solids that they bound, too. False if no proof was found.
  bool solids_apart();
  /// A limit point of a surface lies in the other one's solid. False if no proof was found.
  bool solids_meet(std::size_t side, const Place& at);

  /// Claims so far of the last question or pair; and the same of another one about the same.
  [[nodiscard]] std::string claims() const { return text_.substr(claims_); }
  void add_claims(const std::string& claims) { text_ += claims; }

  /// The text, with its end; empty if nothing was proved.
  [[nodiscard]] std::string finished();

 private:
  std::size_t index_of(const Surface& surface);
  void begin_question();
  void drop_question_without_claim();
  void drop_scene_without_claim();
  CertifiedSide append_placed(const PlacedSurface& surface);
  void set_side(std::size_t side, const PlacedSurface& surface);
  // Appends the name of a piece around a place and gives its box, where it is placed.
  Box3 append_place(std::size_t side, const Place& at);

  const WorkMonitor& monitor_;
  std::string text_ = "snug-certificate 1\n";
  bool has_claims_ = false;
  bool are_apart_ = false;  // proved in the last question
  std::size_t asked_ = 0;
  // Where the last question, or pair of a scene, and its claims begin; 0: there is none.
  std::size_t question_ = 0, claims_ = 0;
  std::size_t scene_begin_ = 0, scene_claims_ = 0;  // the same of a scene
  std::map<const SurfaceData*, std::size_t> indices_;
  std::vector<std::unique_ptr<CertifiedSurface>> surfaces_;
  std::optional<SceneTree> scene_;
  std::vector<CertifiedSurface*> of_parts_;
  std::array<CertifiedSide, 2> sides_;
  std::array<CertifiedSurface*, 2> of_sides_{};
};

}  // namespace snug
