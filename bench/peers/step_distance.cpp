// step_distance FILE SCALE BOUND < POINTS: how far Open CASCADE finds points from the faces of a STEP file.
//
// Prints how many points were read, the largest distance of one from the nearest face, and how many of them took a comparison with edges
// as well. The shape is enlarged first: see scripts/check_step, which builds and runs this. Faces whose boxes are farther away than BOUND
// are not asked. A face is prepared once; FreeCAD would do so again for every point.

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepExtrema_ExtPF.hxx>
#include <Bnd_Box.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Trsf.hxx>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <list>

namespace {

struct Face {
  TopoDS_Face face;
  Bnd_Box box;
  BRepExtrema_ExtPF search;
};

// From the inside of a face; infinite if no point there is nearest.
double inner_distance(Face& face, const TopoDS_Vertex& vertex) {
  face.search.Perform(vertex, face.face);
  double least = INFINITY;
  if (!face.search.IsDone()) return least;
  for (int k = 1; k <= face.search.NbExt(); ++k) least = std::min(least, face.search.SquareDistance(k));
  return std::sqrt(least);
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) return 2;
  const double scale = std::atof(words[2]), bound = std::atof(words[3]);
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPControl_Reader reader;
  if (reader.ReadFile(words[1]) != IFSelect_RetDone) return 1;
  reader.TransferRoots();
  gp_Trsf enlarge;
  enlarge.SetScale(gp_Pnt(0, 0, 0), scale);
  const TopoDS_Shape shape = BRepBuilderAPI_Transform(reader.OneShape(), enlarge, true).Shape();
  std::list<Face> faces;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    Face& face = faces.emplace_back();
    face.face = TopoDS::Face(at.Current());
    BRepBndLib::Add(face.face, face.box, false);
    face.box.Enlarge(1.01 * bound + 1e-6);
    face.search.Initialize(face.face, Extrema_ExtFlag_MIN);
  }
  double x = 0, y = 0, z = 0, farthest = 0;
  std::size_t points = 0, at_edges = 0;
  while (std::scanf("%lf %lf %lf", &x, &y, &z) == 3) {
    ++points;
    const gp_Pnt point(scale * x, scale * y, scale * z);
    const TopoDS_Vertex vertex = BRepBuilderAPI_MakeVertex(point).Vertex();
    double least = INFINITY;
    for (Face& face : faces) {
      if (least <= 1e-3 * bound) break;
      if (!face.box.IsOut(point)) least = std::min(least, inner_distance(face, vertex));
    }
    if (least > bound) {
      ++at_edges;
      for (const Face& face : faces) {
        if (face.box.IsOut(point)) continue;
        const BRepExtrema_DistShapeShape both(vertex, face.face);
        if (both.IsDone()) least = std::min(least, both.Value());
      }
    }
    farthest = std::max(farthest, least);
  }
  std::printf("%zu %.9g %zu\n", points, farthest / scale, at_edges);
  return 0;
}
