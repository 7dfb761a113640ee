#pragma once

#include <snug/contacts.h>
#include <snug/search/surface_workspace.h>

namespace snug {

/// contacts() of contacts.h. Both trees are opened from their roots on, breadth first; pairs of pieces that are not
/// proved apart are listed, joined to regions, and cut.
[[nodiscard]] Contacts contacts(const PlacedBvh& a, const PlacedBvh& b, const ContactsOptions& options,
                                const Run& run = {});

}  // namespace snug
