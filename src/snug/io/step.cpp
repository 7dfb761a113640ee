#include <snug/brep.h>

#include <algorithm>

#include <snug/io/step_text.h>
#include <support/atomic_file.h>

namespace snug {
namespace {

struct UnitWords {
  const char* own;  // what an SI unit is called, or none
  double metres;
};
UnitWords words_of(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::millimetre:
      return {"(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))", 1e-3};
    case LengthUnit::centimetre:
      return {"(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.))", 1e-2};
    case LengthUnit::metre:
      return {"(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))", 1};
    case LengthUnit::inch:
      break;
  }
  return {nullptr, 0.0254};
}

// Knots, each once, and how often it is there.
struct KnotList {
  std::string multiplicities, knots;
  explicit KnotList(const std::vector<double>& all) {
    for (std::size_t i = 0; i < all.size();) {
      std::size_t count = 1;
      while (i + count < all.size() && all[i + count] == all[i]) ++count;
      if (i > 0) {
        multiplicities += ',';
        knots += ',';
      }
      multiplicities += std::to_string(count);
      append_step_real(knots, all[i]);
      i += count;
    }
  }
};

class StepWriter {
 public:
  StepWriter(const Brep& brep, const StepOptions& options) : brep_(brep), options_(options) {}

  std::string run() {
    head();
    context();
    for (const Point3& p : brep_.vertices)
      vertices_.push_back(file_.add("VERTEX_POINT('',", StepRef{file_.point(p)}, ")"));
    for (const Brep::Edge& edge : brep_.edges) add_edge(edge);
    for (const Brep::Face& face : brep_.faces) add_face(face);
    shapes();
    return file_.finish();
  }

 private:
  void head() {
    file_.begin(options_.name,
                options_.ap214 ? "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }"
                               : "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }");
  }

  void context() {
    const std::size_t application =
        file_.add("APPLICATION_CONTEXT('",
                  options_.ap214 ? "core data for automotive mechanical design processes"
                                 : "managed model based 3d engineering",
                  "')");
    file_.add("APPLICATION_PROTOCOL_DEFINITION('international standard','",
              options_.ap214 ? "automotive_design" : "ap242_managed_model_based_3d_engineering",
              options_.ap214 ? "',2000," : "',2014,", StepRef{application}, ")");
    const std::size_t product_context =
        file_.add("PRODUCT_CONTEXT('',", StepRef{application}, ",'mechanical')");
    const std::string name = step_string(options_.name);
    const std::size_t product =
        file_.add("PRODUCT(", name, ",", name, ",'',(", StepRef{product_context}, "))");
    file_.add("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(", StepRef{product}, "))");
    const std::size_t formation = file_.add("PRODUCT_DEFINITION_FORMATION('','',", StepRef{product}, ")");
    const std::size_t definition_context =
        file_.add("PRODUCT_DEFINITION_CONTEXT('part definition',", StepRef{application}, ",'design')");
    const std::size_t definition = file_.add("PRODUCT_DEFINITION('design','',", StepRef{formation}, ",",
                                             StepRef{definition_context}, ")");
    shape_ = file_.add("PRODUCT_DEFINITION_SHAPE('','',", StepRef{definition}, ")");
    const std::size_t length = length_unit();
    const std::size_t angle = file_.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
    const std::size_t solid = file_.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
    // What readers take for one point: above the gaps between faces and edges.
    std::string least;
    append_step_real(least, uncertainty());
    const std::size_t uncertain =
        file_.add("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(", least, "),", StepRef{length},
                  ",'distance_accuracy_value','largest gap between faces')");
    context_ = file_.add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((",
                         StepRef{uncertain}, "))GLOBAL_UNIT_ASSIGNED_CONTEXT((", StepRef{length}, ",",
                         StepRef{angle}, ",", StepRef{solid}, "))REPRESENTATION_CONTEXT('',''))");
    const std::size_t origin = file_.point({}), z = file_.direction({0, 0, 1}),
                      x = file_.direction({1, 0, 0});
    axes_ = file_.add("AXIS2_PLACEMENT_3D('',", StepRef{origin}, ",", StepRef{z}, ",", StepRef{x}, ")");
  }
  std::size_t length_unit() {
    const UnitWords words = words_of(options_.unit);
    if (words.own != nullptr) return file_.add(words.own);
    const std::size_t metre = file_.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))");
    std::string factor;
    append_step_real(factor, words.metres);
    const std::size_t inch =
        file_.add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(", factor, "),", StepRef{metre}, ")");
    const std::size_t dimension = file_.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)");
    return file_.add("(CONVERSION_BASED_UNIT('INCH',", StepRef{inch}, ")LENGTH_UNIT()NAMED_UNIT(",
                     StepRef{dimension}, "))");
  }
  [[nodiscard]] double uncertainty() const {
    Box3 box;
    for (const Point3& p : brep_.vertices) box.add(p);
    return std::max({16 * brep_.gap_bound, 1e-9 * longest_side(box), 1e-300});
  }

  std::size_t spline(const SplineCurve& curve) {
    std::string points;
    for (const Point3& p : curve.points) file_.list(points, file_.point(p));
    const KnotList knots(curve.knots);
    return file_.add("B_SPLINE_CURVE_WITH_KNOTS('',", std::to_string(curve.degree), ",(", points,
                     "),.UNSPECIFIED.,.F.,.F.,(", knots.multiplicities, "),(", knots.knots,
                     "),.UNSPECIFIED.)");
  }
  void add_edge(const Brep::Edge& edge) {
    const std::size_t curve = spline(edge.curve);
    edges_.push_back(file_.add("EDGE_CURVE('',", StepRef{vertices_[edge.vertices[0]]}, ",",
                               StepRef{vertices_[edge.vertices[1]]}, ",", StepRef{curve}, ",.T.)"));
  }

  void add_face(const Brep::Face& face) {
    std::string loop;
    for (const Brep::Side& side : face.loop)
      file_.list(loop, file_.add("ORIENTED_EDGE('',*,*,", StepRef{edges_[side.edge]},
                                 side.reversed ? ",.F.)" : ",.T.)"));
    const std::size_t edge_loop = file_.add("EDGE_LOOP('',(", loop, "))");
    const std::size_t bound = file_.add("FACE_OUTER_BOUND('',", StepRef{edge_loop}, ",.T.)");
    const SplineSurface& s = face.surface;
    std::string rows;
    for (std::size_t i = 0; i < s.columns(); ++i) {
      std::string row;
      for (std::size_t j = 0; j < s.rows(); ++j) file_.list(row, file_.point(s.points[i + s.columns() * j]));
      rows += (i > 0 ? ",(" : "(") + row + ")";
    }
    const KnotList u(s.u_knots), v(s.v_knots);
    const std::string degree = std::to_string(s.degree);
    const std::size_t surface = file_.add(
        "B_SPLINE_SURFACE_WITH_KNOTS('',", degree, ",", degree, ",(", rows, "),.UNSPECIFIED.,.F.,.F.,.F.,(",
        u.multiplicities, "),(", v.multiplicities, "),(", u.knots, "),(", v.knots, "),.UNSPECIFIED.)");
    faces_.push_back(file_.add("ADVANCED_FACE('',(", StepRef{bound}, "),", StepRef{surface}, ",.T.)"));
  }

  std::size_t shell(const Brep::Shell& shell) {
    std::string faces;
    for (std::uint32_t f = shell.begin; f < shell.end; ++f) file_.list(faces, faces_[f]);
    return file_.add(shell.closed ? "CLOSED_SHELL" : "OPEN_SHELL", "('',(", faces, "))");
  }

  void shapes() {
    std::string solids, sheets;
    std::vector<std::string> voids(brep_.shells.size());
    for (const Brep::Shell& s : brep_.shells) {
      if (s.void_of)
        file_.list(voids[*s.void_of], file_.add("ORIENTED_CLOSED_SHELL('',*,", StepRef{shell(s)}, ",.T.)"));
    }
    const std::string name = step_string(options_.name);
    for (std::size_t i = 0; i < brep_.shells.size(); ++i) {
      const Brep::Shell& s = brep_.shells[i];
      if (s.void_of) continue;
      const std::size_t outer = shell(s);
      if (!s.closed) {
        file_.list(sheets, file_.add("SHELL_BASED_SURFACE_MODEL(", name, ",(", StepRef{outer}, "))"));
      } else if (voids[i].empty()) {
        file_.list(solids, file_.add("MANIFOLD_SOLID_BREP(", name, ",", StepRef{outer}, ")"));
      } else {
        file_.list(solids, file_.add("BREP_WITH_VOIDS(", name, ",", StepRef{outer}, ",(", voids[i], "))"));
      }
    }
    represent("ADVANCED_BREP_SHAPE_REPRESENTATION", solids);
    represent("MANIFOLD_SURFACE_SHAPE_REPRESENTATION", sheets);
  }
  void represent(const char* how, const std::string& items) {
    if (items.empty()) return;
    const std::size_t shape =
        file_.add(how, "('',(", StepRef{axes_}, ",", items, "),", StepRef{context_}, ")");
    file_.add("SHAPE_DEFINITION_REPRESENTATION(", StepRef{shape_}, ",", StepRef{shape}, ")");
  }

  const Brep& brep_;
  const StepOptions& options_;
  StepText file_;
  std::size_t shape_ = 0, context_ = 0, axes_ = 0;
  std::vector<std::size_t> vertices_, edges_, faces_;
};

}  // namespace

std::string format_step(const Brep& brep, const StepOptions& options) {
  return StepWriter(brep, options).run();
}

std::size_t write_step(const Brep& brep, const std::string& path, const StepOptions& options) {
  const std::string text = format_step(brep, options);
  AtomicFile file(path);
  file.write(text);
  file.commit();
  return text.size();
}

}  // namespace snug
