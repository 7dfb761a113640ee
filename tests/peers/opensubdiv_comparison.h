#pragma once

#include <oracle/polygon_twin.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace oracle {

/// The twin's meshes and limits against OpenSubdiv's; differences are relative to the largest coordinate.
struct Compared {
  struct Part {
    std::size_t count = 0;
    double worst = 0;
  };
  bool accepted = false;   ///< OpenSubdiv made a refiner
  bool same_faces = true;  ///< numbers of faces and corners, holes
  Part refined;            ///< corners of faces at all levels
  Part limit;              ///< limit points where OpenSubdiv's mask is one
  /// Where it is not: one sharp edge, Catmull-Clark with two faces, finite sharpness at the last level.
  Part dart, valence_two, alive;
};

/// Sharpnesses are rounded to float first, as OpenSubdiv stores them.
[[nodiscard]] Compared compare_with_opensubdiv(TaggedMesh mesh, const Rules& rules, int levels);

/// OpenSubdiv's own mesh after uniform refinement, face by face in its order, in double precision.
struct OpenSubdivMesh {
  enum class Limit : std::uint8_t { exact, dart, valence_two, alive };  ///< as the parts of Compared
  struct Corner {
    Point refined, limit;
    Limit sort;
  };
  bool accepted = false;
  std::vector<std::vector<Corner>> faces;
  std::vector<bool> holes;
};
/// With `bilinear` under OpenSubdiv's third scheme, whatever rules.scheme says.
[[nodiscard]] OpenSubdivMesh refine_with_opensubdiv(const TaggedMesh& mesh, const Rules& rules, int levels,
                                                    bool bilinear = false);

/// Limit points of faces by OpenSubdiv's Bfr: in a triangle or quad u runs from corner 0 to corner 1, v to the last one.
class BfrSurfaces {
 public:
  BfrSurfaces(const TaggedMesh& mesh, const Rules& rules);
  ~BfrSurfaces();
  struct Face {
    bool regular;  ///< one polynomial, exact up to rounding
    std::vector<Point> points;
  };
  /// None where Bfr has no surface.
  [[nodiscard]] std::optional<Face> at(std::size_t face, const std::vector<std::array<double, 2>>& uv) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace oracle
