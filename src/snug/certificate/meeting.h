#pragma once

#include <snug/certificate/separation.h>

namespace snug {

/// A piece of a surface: where its owner stands in the order, and the children that lead to it.
struct CertifiedPiece {
  std::size_t position;
  std::vector<std::size_t> steps;
};

/// Appends a proof that two sets have a point in common, as docs/certificates.md has it: two surfaces, or a surface and a
/// segment, the second one. `hint` names pieces of the surfaces that are near each other. False if none was found; nothing is
/// then appended.
[[nodiscard]] bool append_meeting(std::string& text, const std::array<CertifiedSide, 2>& sides,
                                  const std::array<std::optional<CertifiedPiece>, 2>& hint,
                                  const WorkMonitor& monitor);

}  // namespace snug
