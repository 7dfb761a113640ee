#pragma once

#include <cstddef>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <snug/patch/kind_cache.h>

namespace snug {

/// Upper bounds of the areas of patches, or of distances along them, and of whole quads that patches are halves
/// of, by the boxes of their control points. For one thread.
///
/// Source:    derivations/measures.md, "What is left at a corner"; derivations/self_contact.md, "Lengths".
class TipFactors {
 public:
  /// A factor c such that the area is at most c d^2, or the distance along the patch or quad of any two points
  /// at most c d, d being the diagonal of the box around the control points; infinite where none is found,
  /// which happens to Midedge alone, beside a face of very many corners.
  /// Cost:      that of the kind's step the first time, and some dense products.
  [[nodiscard]] double factor(const Kind& kind);

 protected:
  explicit TipFactors(bool areas) : areas_(areas) {}

 private:
  [[nodiscard]] double power(double growth) const { return areas_ ? growth * growth : growth; }
  [[nodiscard]] double find(const Kind& kind);
  [[nodiscard]] double find_new(const Kind& kind);
  bool areas_;
  std::unordered_map<const Kind*, double> known_;
  std::unordered_set<const Kind*> open_;  // whose factors are being found
};

class TipAreas : public TipFactors {
 public:
  TipAreas() : TipFactors(true) {}
};
class TipLengths : public TipFactors {
 public:
  TipLengths() : TipFactors(false) {}
};

}  // namespace snug
