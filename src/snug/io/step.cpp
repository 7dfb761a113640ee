#include <snug/brep.h>

#include <algorithm>

#include <snug/io/step_text.h>
#include <support/atomic_file.h>
#include <support/error.h>
#include <support/run.h>

namespace snug {
namespace {

struct UnitWords {
  const char* si;         // of an SI unit
  const char* name = "";  // else its name, and its length
  double metres = 0;
};
UnitWords words_of(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::millimetre:
      return {"(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))"};
    case LengthUnit::centimetre:
      return {"(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.))"};
    case LengthUnit::metre:
      return {"(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))"};
    case LengthUnit::micron:
      return {"(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MICRO.,.METRE.))"};
    case LengthUnit::foot:
      return {nullptr, "FOOT", 0.3048};
    case LengthUnit::inch:
      break;
  }
  return {nullptr, "INCH", 0.0254};
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
  StepWriter(const StepOptions& options, const Run& run) : options_(options), monitor_(monitor_of(run)) {
    begin();
  }

  std::string part(const Brep& brep) {
    add_shape(brep, options_.name, product(options_.name));
    return file_.finish();
  }

  std::string assembly(std::span<const StepShape> shapes, std::span<const StepPart> parts) {
    struct Made {
      Product product;
      std::size_t shape;
    };
    std::vector<Made> made;
    for (const StepShape& shape : shapes) {
      const Product own = product(shape.name);
      made.push_back({own, add_shape(shape.brep, shape.name, own)});
    }
    const Product whole = product(options_.name);
    context_ = context(1e-7);
    std::string items;
    StepText::list(items, placement({}));
    std::vector<std::size_t> places;
    for (const StepPart& part : parts) {
      places.push_back(placement(part.pose));
      StepText::list(items, places.back());
    }
    const std::size_t all = file_.add("SHAPE_REPRESENTATION(", step_string(options_.name), ",(", items, "),",
                                      StepRef{context_}, ")");
    file_.add("SHAPE_DEFINITION_REPRESENTATION(", StepRef{whole.shape}, ",", StepRef{all}, ")");
    for (std::size_t k = 0; k < parts.size(); ++k) {
      monitor_.checkpoint();
      const StepPart& part = parts[k];
      require_value(part.shape < made.size(), "an assembly's part names a shape that it does not have");
      place(part, made[part.shape].product, made[part.shape].shape, whole, all, places[k], k + 1);
    }
    return file_.finish();
  }

 private:
  struct Product {
    std::size_t definition, shape;
  };

  void begin() {
    file_.begin(options_.name,
                options_.ap214 ? "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }"
                               : "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }");
    const std::size_t application =
        file_.add("APPLICATION_CONTEXT('",
                  options_.ap214 ? "core data for automotive mechanical design processes"
                                 : "managed model based 3d engineering",
                  "')");
    file_.add("APPLICATION_PROTOCOL_DEFINITION('international standard','",
              options_.ap214 ? "automotive_design" : "ap242_managed_model_based_3d_engineering",
              options_.ap214 ? "',2000," : "',2014,", StepRef{application}, ")");
    product_context_ = file_.add("PRODUCT_CONTEXT('',", StepRef{application}, ",'mechanical')");
    definition_context_ =
        file_.add("PRODUCT_DEFINITION_CONTEXT('part definition',", StepRef{application}, ",'design')");
    length_ = length_unit();
    angle_ = file_.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
    solid_angle_ = file_.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
    axes_ = placement({});
  }
  std::size_t length_unit() {
    const UnitWords words = words_of(options_.unit);
    if (words.si != nullptr) return file_.add(words.si);
    const std::size_t metre = file_.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))");
    std::string factor;
    append_step_real(factor, words.metres);
    const std::size_t length =
        file_.add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(", factor, "),", StepRef{metre}, ")");
    const std::size_t dimension = file_.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)");
    return file_.add("(CONVERSION_BASED_UNIT('", words.name, "',", StepRef{length},
                     ")LENGTH_UNIT()NAMED_UNIT(", StepRef{dimension}, "))");
  }
  Product product(const std::string& text) {
    const std::string name = step_string(text);
    const std::size_t product =
        file_.add("PRODUCT(", name, ",", name, ",'',(", StepRef{product_context_}, "))");
    file_.add("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(", StepRef{product}, "))");
    const std::size_t formation = file_.add("PRODUCT_DEFINITION_FORMATION('','',", StepRef{product}, ")");
    const std::size_t definition = file_.add("PRODUCT_DEFINITION('design','',", StepRef{formation}, ",",
                                             StepRef{definition_context_}, ")");
    return {definition, file_.add("PRODUCT_DEFINITION_SHAPE('','',", StepRef{definition}, ")")};
  }
  // What readers take for one point.
  std::size_t context(double uncertainty) {
    std::string least;
    append_step_real(least, uncertainty);
    const std::size_t uncertain =
        file_.add("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(", least, "),", StepRef{length_},
                  ",'distance_accuracy_value','largest gap between faces')");
    return file_.add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((",
                     StepRef{uncertain}, "))GLOBAL_UNIT_ASSIGNED_CONTEXT((", StepRef{length_}, ",",
                     StepRef{angle_}, ",", StepRef{solid_angle_}, "))REPRESENTATION_CONTEXT('',''))");
  }
  // Above the gaps between faces and edges.
  [[nodiscard]] double uncertainty() const {
    Box3 box;
    for (const Point3& p : brep_->vertices) box.add(p);
    return std::max({16 * brep_->gap_bound, 1e-9 * longest_side(box), 1e-300});
  }
  std::size_t placement(const Motion& pose) {
    return axes(Point3{} + pose.offset(), pose.rotate({0, 0, 1}), pose.rotate({1, 0, 0}));
  }
  std::size_t axes(const Point3& origin, const Vector3& z, const Vector3& x) {
    return axes(file_.point(origin), z, x);
  }
  std::size_t axes(std::size_t origin, const Vector3& z, const Vector3& x) {
    const std::size_t along_z = file_.direction(z), along_x = file_.direction(x);
    return file_.add("AXIS2_PLACEMENT_3D('',", StepRef{origin}, ",", StepRef{along_z}, ",", StepRef{along_x},
                     ")");
  }

  // The shape of a product; returns its representation.
  std::size_t add_shape(const Brep& brep, const std::string& name, const Product& product) {
    brep_ = &brep;
    vertex_points_.clear();
    vertices_.clear();
    edges_.clear();
    faces_.clear();
    context_ = context(uncertainty());
    for (const Point3& p : brep.vertices) {
      vertex_points_.push_back(file_.point(p));
      vertices_.push_back(file_.add("VERTEX_POINT('',", StepRef{vertex_points_.back()}, ")"));
    }
    for (const Brep::Edge& edge : brep.edges) {
      monitor_.checkpoint();
      add_edge(edge);
    }
    for (const Brep::Face& face : brep.faces) {
      monitor_.checkpoint();
      add_face(face);
    }
    return represent(name, product);
  }

  static Vector3 unit(const Vector3& v) {
    const Vector3 w = (1 / max_abs(v)) * v;
    return (1 / length(w)) * w;
  }

  std::size_t curve_of(const Brep::Edge& edge) {
    const std::vector<Point3>& points = edge.curve.points;
    const Vector3 along = points.back() - points.front();
    if (points.size() > 2 || !(length(along) > 0)) return spline(edge.curve);
    std::string size;
    append_step_real(size, length(along));
    const std::size_t vector = file_.add("VECTOR('',", StepRef{file_.direction(unit(along))}, ",", size, ")");
    return file_.add("LINE('',", StepRef{vertex_points_[edge.vertices[0]]}, ",", StepRef{vector}, ")");
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
    const std::size_t curve = curve_of(edge);
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
    const std::size_t surface = surface_of(face);
    faces_.push_back(file_.add("ADVANCED_FACE('',(", StepRef{bound}, "),", StepRef{surface}, ",.T.)"));
  }

  // A facet is part of a plane, unless it has no area.
  std::size_t surface_of(const Brep::Face& face) {
    const SplineSurface& s = face.surface;
    if (face.triangle() && s.degree == 1) {
      const Vector3 along = s.points[1] - s.points[0], normal = cross(along, s.points[3] - s.points[0]);
      if (length(normal) > 0 && is_finite(normal)) {
        const Brep::Edge& edge = brep_->edges[face.loop[0].edge];
        const std::size_t origin = vertex_points_[edge.vertices[face.loop[0].reversed ? 1 : 0]];
        return file_.add("PLANE('',", StepRef{axes(origin, unit(normal), unit(along))}, ")");
      }
    }
    std::string rows;
    for (std::size_t i = 0; i < s.columns(); ++i) {
      std::string row;
      for (std::size_t j = 0; j < s.rows(); ++j) file_.list(row, file_.point(s.points[i + s.columns() * j]));
      rows += (i > 0 ? ",(" : "(") + row + ")";
    }
    const KnotList u(s.u_knots), v(s.v_knots);
    const std::string degree = std::to_string(s.degree);
    return file_.add("B_SPLINE_SURFACE_WITH_KNOTS('',", degree, ",", degree, ",(", rows,
                     "),.UNSPECIFIED.,.F.,.F.,.F.,(", u.multiplicities, "),(", v.multiplicities, "),(",
                     u.knots, "),(", v.knots, "),.UNSPECIFIED.)");
  }

  std::size_t shell(const Brep::Shell& shell) {
    std::string faces;
    for (std::uint32_t f = shell.begin; f < shell.end; ++f) file_.list(faces, faces_[f]);
    return file_.add(shell.closed ? "CLOSED_SHELL" : "OPEN_SHELL", "('',(", faces, "))");
  }

  std::size_t represent(const std::string& text, const Product& product) {
    std::string solids, sheets;
    std::vector<std::string> voids(brep_->shells.size());
    for (const Brep::Shell& s : brep_->shells) {
      if (s.void_of)
        file_.list(voids[*s.void_of], file_.add("ORIENTED_CLOSED_SHELL('',*,", StepRef{shell(s)}, ",.T.)"));
    }
    const std::string name = step_string(text);
    for (std::size_t i = 0; i < brep_->shells.size(); ++i) {
      const Brep::Shell& s = brep_->shells[i];
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
    std::size_t shape = 0;
    for (const auto& [how, items] : {std::pair("ADVANCED_BREP_SHAPE_REPRESENTATION", &solids),
                                     std::pair("MANIFOLD_SURFACE_SHAPE_REPRESENTATION", &sheets)}) {
      if (items->empty()) continue;
      const std::size_t here =
          file_.add(how, "('',(", StepRef{axes_}, ",", *items, "),", StepRef{context_}, ")");
      file_.add("SHAPE_DEFINITION_REPRESENTATION(", StepRef{product.shape}, ",", StepRef{here}, ")");
      // Of a product that has both the solids stand for it in assemblies, and the sheets belong to them.
      if (shape != 0)
        file_.add("SHAPE_REPRESENTATION_RELATIONSHIP('','',", StepRef{shape}, ",", StepRef{here}, ")");
      if (shape == 0) shape = here;
    }
    return shape;
  }

  void place(const StepPart& part, const Product& own, std::size_t shape, const Product& whole,
             std::size_t all, std::size_t there, std::size_t number) {
    const std::size_t transform =
        file_.add("ITEM_DEFINED_TRANSFORMATION('','',", StepRef{axes_}, ",", StepRef{there}, ")");
    const std::size_t relation = file_.add("(REPRESENTATION_RELATIONSHIP('','',", StepRef{shape}, ",",
                                           StepRef{all}, ")REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(",
                                           StepRef{transform}, ")SHAPE_REPRESENTATION_RELATIONSHIP())");
    const std::size_t occurrence =
        file_.add("NEXT_ASSEMBLY_USAGE_OCCURRENCE('", std::to_string(number), "',", step_string(part.name),
                  ",'',", StepRef{whole.definition}, ",", StepRef{own.definition}, ",$)");
    const std::size_t definition =
        file_.add("PRODUCT_DEFINITION_SHAPE('Placement','',", StepRef{occurrence}, ")");
    file_.add("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(", StepRef{relation}, ",", StepRef{definition}, ")");
  }

  const StepOptions& options_;
  const WorkMonitor& monitor_;
  StepText file_;
  std::size_t product_context_ = 0, definition_context_ = 0, length_ = 0, angle_ = 0, solid_angle_ = 0,
              axes_ = 0;
  // Of the shape that is written.
  const Brep* brep_ = nullptr;
  std::size_t context_ = 0;
  std::vector<std::size_t> vertex_points_, vertices_, edges_, faces_;
};

}  // namespace

std::string format_step(const Brep& brep, const StepOptions& options, const Run& run) {
  return StepWriter(options, run).part(brep);
}

std::string format_step(std::span<const StepShape> shapes, std::span<const StepPart> parts,
                        const StepOptions& options, const Run& run) {
  return StepWriter(options, run).assembly(shapes, parts);
}

std::size_t write_step(const Brep& brep, const std::string& path, const StepOptions& options,
                       const Run& run) {
  const std::string text = format_step(brep, options, run);
  AtomicFile file(path);
  file.write(text);
  file.commit();
  return text.size();
}

}  // namespace snug
