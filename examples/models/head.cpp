#include "face.h"
#include "models.h"
#include "sculpt.h"

namespace models {

TriangleMesh make_head() {
  SculptOptions options;
  options.low = {0, -1.25, -1.25};
  options.high = {1.0, 1.25, 1.25};
  options.cell = 1.0 / 24;
  options.open_floor = true;
  options.faces = 700;
  options.importance = face_importance;
  return sculpt(human_head, options);
}

}  // namespace models
