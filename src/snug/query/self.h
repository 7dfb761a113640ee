#pragma once

#include <snug/contacts.h>

namespace snug {

/// The quick part of self_contact(): facets, pieces of the coarsest level that have no corner in common, and vertices that coincide. Contact
/// that it proves is contact; `clear` says that these pieces do not meet, and nothing of the others.
[[nodiscard]] SelfContact contact_far_apart(const Surface& surface, const Run& run);

}  // namespace snug
