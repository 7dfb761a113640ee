#pragma once

#include <snug/contacts.h>

#include "common.h"
#include "witness.h"

namespace snug::command {

/// The fields of collide --all: exhaustive, regions, curves, open.
void write_contacts(JsonWriter& json, const Sides& sides, const Contacts& found);

/// The same for people: a line for each region and each curve.
[[nodiscard]] std::vector<std::string> contact_lines(const Sides& sides, const Contacts& found);

/// Curves as the lines of an OBJ file; a closed one ends where it begins.
void write_curves(const std::vector<IntersectionCurve>& curves, AtomicFile& file);

}  // namespace snug::command
