#pragma once

#include <snug/mesh/control_mesh.h>
#include <support/names.h>

namespace snug {

inline constexpr auto boundary_rule_names =
    std::to_array<Named<BoundaryRule>>({{"edge-and-corner", BoundaryRule::edge_and_corner},
                                        {"edge-only", BoundaryRule::edge_only},
                                        {"none", BoundaryRule::none}});

inline constexpr auto crease_method_names =
    std::to_array<Named<CreaseMethod>>({{"normal", CreaseMethod::uniform},
                                        {"uniform", CreaseMethod::uniform},
                                        {"chaikin", CreaseMethod::chaikin}});

inline constexpr auto smooth_triangles_names = std::to_array<Named<SmoothTriangles>>(
    {{"catmark", SmoothTriangles::catmark}, {"smooth", SmoothTriangles::smooth}});

}  // namespace snug
