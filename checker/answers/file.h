#pragma once

#include "question.h"

namespace answers {

/// Checks a certificate, as docs/certificates.md describes it. Returns what is proved, a sentence a
/// question; `least` becomes the leaf with the least slack. What is not proved, or is no
/// certificate, is thrown as checker::Rejected, with its line; so is what needs more refined points
/// at a time, half a kilobyte each.
[[nodiscard]] std::vector<std::string> check(std::string_view text, LeastSlack& least,
                                             std::size_t most_points = 8'000'000);

}  // namespace answers
