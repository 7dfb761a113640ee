#pragma once

/// Proved answers about limit surfaces of subdivision meshes; docs/start.md shows the way. Results depend on the input
/// alone, not on threads or earlier queries.

#include <snug/bound.h>
#include <snug/brep.h>
#include <snug/clearance.h>
#include <snug/collide.h>
#include <snug/contacts.h>
#include <snug/curves.h>
#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/geometry.h>
#include <snug/hull.h>
#include <snug/inspect.h>
#include <snug/measure.h>
#include <snug/mesh.h>
#include <snug/ray.h>
#include <snug/robot.h>
#include <snug/scene.h>
#include <snug/surface.h>
#include <snug/tessellate.h>
#include <snug/time_of_contact.h>
