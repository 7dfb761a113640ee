#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <support/point.h>

namespace snug {

/// The attributes of a prim Mesh that concern the surface.
enum class UsdaAttribute : std::uint8_t {
  points,
  face_counts,
  face_indices,
  scheme,
  boundary,
  triangle_rule,
  orientation,
  crease_indices,
  crease_lengths,
  crease_sharpness,
  corner_indices,
  corner_sharpness,
  holes,
};
inline constexpr std::array<std::string_view, 13> usda_attribute_names{"points",
                                                                       "faceVertexCounts",
                                                                       "faceVertexIndices",
                                                                       "subdivisionScheme",
                                                                       "interpolateBoundary",
                                                                       "triangleSubdivisionRule",
                                                                       "orientation",
                                                                       "creaseIndices",
                                                                       "creaseLengths",
                                                                       "creaseSharpnesses",
                                                                       "cornerIndices",
                                                                       "cornerSharpnesses",
                                                                       "holeIndices"};

/// Their values as the file gives them; line 0: not given.
struct UsdaMesh {
  std::array<std::size_t, usda_attribute_names.size()> lines{};
  std::vector<Point3> points;
  std::vector<std::int64_t> face_counts, face_indices, crease_indices, crease_lengths, corner_indices, holes;
  std::vector<double> crease_sharpness, corner_sharpness;
  std::string_view scheme, boundary, triangle_rule, orientation;

  [[nodiscard]] std::size_t line(UsdaAttribute attribute) const {
    return lines[static_cast<std::size_t>(attribute)];
  }
};

/// Something named, and where it stands.
struct UsdaPlace {
  std::string_view name;
  std::size_t line = 0;
};

/// The operations of a prim: their numbers by attribute, and the order in which they are applied.
struct UsdaOperations {
  struct Numbers {
    std::vector<double> values;
    std::size_t line = 0;
  };
  std::map<std::string_view, Numbers> given;
  std::vector<std::string_view> order;
  std::size_t order_line = 0;  ///< 0: none
};

enum class UsdaSpecifier : std::uint8_t { def, over, abstract };  // the last is written class

struct UsdaPrim {
  static constexpr std::size_t no_parent = SIZE_MAX;

  std::string_view type, name;  ///< no type: empty
  std::size_t parent = no_parent;
  std::size_t line = 0;
  UsdaSpecifier specifier = UsdaSpecifier::def;
  bool active = true, invisible = false;
  std::string_view purpose;  ///< empty: that of the parent
  UsdaPlace arc;             ///< the first metadata by which it gets content from elsewhere; line 0: none
  std::vector<UsdaPlace> samples;  ///< attributes with values by time, of those that are read
  std::unique_ptr<UsdaMesh> mesh;  ///< of a Mesh
  std::unique_ptr<UsdaOperations> operations;
};

/// The contents of a USD text, not yet interpreted. Views point into the text.
struct UsdaStage {
  std::vector<UsdaPrim> prims;  ///< parents before children
  std::optional<double> metres_per_unit;
  std::string_view up_axis;
};

/// Reads a text that begins with the header `#usda 1.0`.
///
/// Reads:     of a Mesh the attributes above; of every prim its operations `xformOp:...` and `xformOpOrder`,
///            `visibility`, `purpose`, and in the metadata `active`. All else is passed over: brackets must
///            match there.
/// Errors:    InputError (unreadable) naming the line: what is not of this form; an attribute that is given
///            twice; values of another type; sublayers. References and the like, variants, and values by time
///            are kept for the caller to refuse, who knows which prims count.
/// Cost:      linear in the text.
[[nodiscard]] UsdaStage read_usda_prims(std::string_view text, const std::string& name);

}  // namespace snug
