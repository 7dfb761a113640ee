#pragma once

#include <optional>
#include <string>

#include <snug/certificate/separation.h>

namespace snug {

/// How often a closed surface winds around a point, and the rest of a claim that says so.
struct WindingProof {
  int number;
  std::string text;  ///< a direction and a tree, as docs/certificates.md has it
};

/// All points of a box are meant, that come from coordinates up to `magnitude`. Nothing if no proof was found.
[[nodiscard]] std::optional<WindingProof> winding_proof(const CertifiedSide& surface, const Box3& point,
                                                        double magnitude, const WorkMonitor& monitor);

}  // namespace snug
