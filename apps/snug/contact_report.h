#pragma once

#include <snug/contacts.h>

#include "common.h"
#include "witness.h"

namespace snug::command {

/// All contacts for people: a line for each region and each curve.
[[nodiscard]] std::vector<std::string> contact_lines(const Sides& sides, const Contacts& found);

/// Curves as the lines of an OBJ file; a closed one ends where it begins.
void write_curves(const std::vector<IntersectionCurve>& curves, AtomicFile& file);

}  // namespace snug::command
