#pragma once

#include <cstddef>
#include <span>

#include <snug/patch/patch.h>

namespace snug {

/// A piece around a vertex of the subdivided surface.
struct StarSector {
  const Patch* patch;
  std::size_t centre;  ///< its corner at the vertex
  bool mirrored =
      false;  ///< Are its corners clockwise in the star? As those of one of two faces that run along an edge the same way.
};

/// Is it proved that no two parameters of a star have one point?
///
/// Sectors follow each other counter-clockwise: corner centre + 2 of one is corner centre + 1 of the next, with these two exchanged
/// where a sector is mirrored. A closed star ends where it begins; the centre of an open one lies on the border of the star.
///
/// Guarantee: true only if the star is injective, in exact arithmetic.
/// Requires:  one origin for all patches is not needed; none is a polygon; edges in common have the same points.
///            `balanced` only if what is around a sharp vertex with smooth edges has its mean there, exactly.
/// Cost:      about 20 microseconds for six regular patches.
/// Source:    derivations/self_contact.md, "A star".
[[nodiscard]] bool certainly_injective(std::span<const StarSector> sectors, bool closed,
                                       bool balanced = false);

/// Is the limit of a sector's vertex its control point, whatever all others are?
[[nodiscard]] bool stays_in_place(const StarSector& sector);

/// Is it proved that two sectors at a vertex that stays in place have no other point in common?
///
/// Guarantee: true only if they have none, in exact arithmetic.
/// Source:    derivations/self_contact.md, "Pairs at one vertex".
[[nodiscard]] bool certainly_meet_only_at_vertex(const StarSector& a, const StarSector& b);

}  // namespace snug
