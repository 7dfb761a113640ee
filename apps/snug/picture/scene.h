#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <picture/colour.h>
#include <snug/ray.h>
#include <support/point.h>

namespace snug {

/// How a surface looks.
struct Material {
  Colour colour;
  double opacity = 1;     ///< share of the light from behind that it stops, in [0, 1]
  double gloss = 0;       ///< 0 matte, 1 polished: strength and sharpness of the highlights
  bool two_sided = true;  ///< otherwise triangles whose corners run clockwise for the viewer are not drawn
  bool lit = true;        ///< otherwise exactly `colour`, wherever the lights are
};

/// A triangle; corners run counterclockwise when seen from its outside. One without area is not drawn.
struct ShadedTriangle {
  Point3 corner[3];
  Vector3 normal[3];  ///< interpolated, of any length and either side; a zero one makes the triangle flat
  std::uint32_t material = 0;  ///< index into PictureScene::materials
};

/// A straight stroke with round ends, equally wide on the picture near and far; opaque.
struct Line {
  Point3 a, b;
  double width_in_pixels = 1;
  Colour colour;
};

/// A limit surface that rays meet by itself, and its place in the picture: a similarity.
struct SceneSurface {
  const RayCaster* surface;  ///< outlives the scene
  Rows3 to_mesh;             ///< of displacements, into mesh units
  Point3 origin;             ///< the picture's, in mesh units
  Rows3 turn;                ///< of directions, into the picture
  std::uint32_t material = 0;
  std::function<Colour(const QuickHit&)> colour{};  ///< in place of the material's, where given
};

/// A line of text in front of everything, as lettering() draws it, from the lower left corner of the picture; its rim
/// is white, or black where the text is bright.
struct Label {
  std::string text;
  double height_in_pixels;  ///< of a capital
  Colour colour;
  double lines_up = 0;  ///< so many lines above the lowest one
};

/// A key to colours in front of everything, along the lower border; above it its name, and at its ends what they stand for.
struct ColourBar {
  std::function<Colour(double share)> colour;  ///< from 0, at the left, to 1
  std::string name, least, largest;
  double height_in_pixels = 1;  ///< of a capital; smaller where the words would not fit
  Colour text{};
};

/// Of surfaces all is left out where dot(normal, p) is more than `offset`.
struct CutPlane {
  Vector3 normal;
  double offset;
};

/// The drawn scene. Triangles that share an edge must share its end points exactly, or the seam may show.
struct PictureScene {
  std::vector<Material> materials;
  std::vector<ShadedTriangle> triangles;
  std::vector<Line> lines;
  std::vector<SceneSurface> surfaces{};
  std::optional<CutPlane> cut{};
  std::vector<Label> labels{};
  std::optional<ColourBar> bar{};
};

}  // namespace snug
