#pragma once

#include <random>

#include <snug/geometry/motion.h>
#include <snug/mesh/control_mesh.h>

/// The dissertation's set-up for measuring queries: two models of one size, thrown at random into a cubic
/// room.
namespace snug {

/// The mesh moved and scaled so that its box has its middle at the origin and a longest side of 1. Tags stay.
///
/// Errors:    InputError (value) unless the used box has a positive, finite size.
/// Source:    [Wu05, sec. 5.1]: "scaled to tightly fit into a bounding box of size 1".
[[nodiscard]] ControlMesh unit_model(ControlMesh mesh);

/// Both models of size 1 anywhere in a cube of side `side` around the origin, turned about the middles of
/// their boxes, every rotation alike. Middles stay half a unit away from the walls.
///
/// Guarantee: rigid within a few roundings; the same for the same state of `random` with any standard
///            library.
/// Errors:    InputError (value) unless side > 1.
/// Source:    [Wu05, sec. 5.1] after [Klosowski98]; differs: the text does not say whether models may stick
///            out of the room. With this choice fewer of our models collide than its heads say, see
///            docs/tables.md.
[[nodiscard]] PosePair place_in_room(double side, std::mt19937_64& random);

}  // namespace snug
