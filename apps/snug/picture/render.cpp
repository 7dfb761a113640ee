#include <picture/render.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>

#include <picture/hierarchy.h>
#include <picture/lettering.h>
#include <picture/shading.h>
#include <support/direction.h>
#include <support/error.h>

namespace snug {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Point3 origin;
// Of a surface that lets light through.
constexpr int max_layers = 24;
// Rays for the light from all around, of each sample, and how far they go, in units of the picture; the least share
// of that light; how wide the key light is, as a tangent.
constexpr int ambient_rays = 2;
constexpr double ambient_reach = 0.5, darkest = 0.25, key_radius = 0.12;

// Everything below is in camera coordinates: x right, y up, z the depth, the eye at the origin. A sight is a
// point (x, y) of the plane z = 1, and a position on it is its depth.

struct Sight {
  double x, y;
};

struct Face {
  Vector3 corner[3];
  Vector3 normal[3];
  Vector3 flat_normal;
  std::uint32_t material;
  bool smooth;
};

struct Stroke {
  // End points on the picture, in pixels, y downwards, and 1 / depth there, which is linear along the stroke.
  double ax, ay, bx, by;
  double a_nearness, b_nearness;
  double half_width;
  double pull;  // factor of the depth: the stroke as if nearer
  Radiance colour;
};

struct Hit {
  enum class Kind : std::uint8_t { face, line, surface };
  std::uint32_t sample;
  std::uint32_t object;  // of a surface, among Scratch::surface_hits
  Kind kind;
  double depth;
  double weight_a, weight_b;  // of the first two corners of a face
};

struct SurfaceHit {
  std::uint32_t surface;
  QuickHit hit;
};

struct Layer {
  double depth;
  Radiance light;
  double opacity;
  friend auto operator<=>(const Layer&, const Layer&) = default;
};

bool in_unit(double x) { return 0 <= x && x <= 1; }
bool in_unit(const Colour& c) { return in_unit(c.red) && in_unit(c.green) && in_unit(c.blue); }
bool is_unit(Vector3 v) { return std::fabs(length_sq(v) - 1) < 1e-9; }

void expect_sound(const PictureScene& scene, const Camera& camera, const RenderOptions& options) {
  require_value(options.width >= 1 && options.height >= 1, "render: width and height must be at least 1");
  require_value(1 <= options.samples && options.samples <= 16, "render: samples must be from 1 to 16");
  require_value(in_unit(options.background.top) && in_unit(options.background.foot),
                "render: colours of the background must be from 0 to 1");
  require_value(is_finite(camera.eye) && std::isfinite(camera.tangent) && camera.tangent > 0,
                "render: the camera's eye must be finite, and its tangent positive");
  require_value(is_unit(camera.right) && is_unit(camera.up) && is_unit(camera.forward) &&
                    length(cross(camera.right, camera.up) + camera.forward) < 1e-9,
                "render: the camera's axes must be of length 1 and at right angles; frame() makes such");
  for (const Material& m : scene.materials) {
    require_value(in_unit(m.colour) && in_unit(m.opacity) && in_unit(m.gloss),
                  "render: colour, opacity and gloss of a material must be from 0 to 1");
  }
  for (const ShadedTriangle& t : scene.triangles) {
    require_value(t.material < scene.materials.size(),
                  "render: a triangle is of a material that is not there");
    for (const Point3& p : t.corner) require_value(is_finite(p), "render: a triangle is not finite");
    for (const Vector3& n : t.normal) require_value(is_finite(n), "render: a normal is not finite");
  }
  for (const Label& label : scene.labels) {
    require_value(
        std::isfinite(label.height_in_pixels) && label.height_in_pixels > 0 && in_unit(label.colour),
        "render: the height of a label must be positive, and its colour from 0 to 1");
  }
  if (scene.bar) {
    const double height = scene.bar->height_in_pixels;
    require_value(std::isfinite(height) && height > 0 && in_unit(scene.bar->text) && scene.bar->colour,
                  "render: a bar has colours, and letters of a positive height and a colour from 0 to 1");
  }
  for (const Line& line : scene.lines) {
    require_value(is_finite(line.a) && is_finite(line.b), "render: a line is not finite");
    require_value(std::isfinite(line.width_in_pixels) && line.width_in_pixels > 0 && in_unit(line.colour),
                  "render: the width of a line must be positive, and its colour from 0 to 1");
  }
}

// Which of the two triangles beside an edge has the rays that meet the edge exactly: they see it in opposite
// directions.
bool owns(double dx, double dy) { return dy > 0 || (dy == 0 && dx > 0); }

struct Crossing {
  double depth, weight_a, weight_b;
  bool counterclockwise;
};

// Sheared so that the ray is the z axis, the corners are points of the plane and the ray is its origin. The
// value of an edge changes only its sign when the neighbour computes it, so no ray passes between two
// triangles [Woop13].
bool crosses(const Sight& ray, const Face& face, Crossing& crossing) {
  const Vector3 &p = face.corner[0], &q = face.corner[1], &r = face.corner[2];
  const double px = p.x - ray.x * p.z, py = p.y - ray.y * p.z;
  const double qx = q.x - ray.x * q.z, qy = q.y - ray.y * q.z;
  const double rx = r.x - ray.x * r.z, ry = r.y - ray.y * r.z;
  const double u = qx * ry - qy * rx, v = rx * py - ry * px, w = px * qy - py * qx;
  if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0))) return false;
  const double sum = u + v + w;
  if (sum == 0) return false;
  const double turn = sum > 0 ? 1 : -1;
  if ((u == 0 && !owns(turn * (rx - qx), turn * (ry - qy))) ||
      (v == 0 && !owns(turn * (px - rx), turn * (py - ry))) ||
      (w == 0 && !owns(turn * (qx - px), turn * (qy - py))))
    return false;
  crossing.weight_a = u / sum;
  crossing.weight_b = v / sum;
  crossing.depth = (u * p.z + v * q.z + w * r.z) / sum;
  crossing.counterclockwise = sum > 0;
  return crossing.depth > 0;
}

class Renderer {
 public:
  Renderer(const PictureScene& scene, const Camera& camera, const RenderOptions& options);

  // Scratch memory of one thread.
  struct Scratch {
    BeamHierarchy::Stack stack;
    std::vector<Sight> rays;
    std::vector<double> opaque_depth;  // of the nearest opaque hit of each sample
    std::vector<Hit> hits;
    std::vector<SurfaceHit> surface_hits;
    std::vector<snug::Ray> mesh_rays;
    std::vector<QuickHit> quick_hits;
    std::array<double, 2> light_offset{};  // of this pixel
    unsigned light_rays = 0;               // sent so far in this pixel
    std::vector<Layer> layers;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> strokes;  // (column, stroke) of one row
    std::uint64_t rays_that_hit = 0;                               // so far
  };
  void draw_row(int row, Scratch& scratch, std::uint8_t* out) const;

 private:
  struct Sample {
    double x, y;  // in the pixel
  };

  void add_line(const Line& line, double near_depth);
  void write(std::string_view text, double left, double foot, double size, const Colour& colour);
  void add_label(const Label& label);
  void add_bar(const ColourBar& bar);
  void sort_strokes_into_rows();
  [[nodiscard]] Vector3 turned(Vector3 v) const {
    return {dot(v, camera_.right), dot(v, camera_.up), dot(v, camera_.forward)};
  }
  [[nodiscard]] double ray_x(double column) const { return (2 * column - options_.width) * half_pixel_; }
  [[nodiscard]] double ray_y(double row) const { return (options_.height - 2 * row) * half_pixel_; }
  void gather_strokes(int row, Scratch& scratch) const;
  void hit_faces(int column, int row, Scratch& scratch) const;
  void hit_surface(std::uint32_t index, Scratch& scratch) const;
  void hit_stroke(std::uint32_t index, int column, int row, Scratch& scratch) const;
  [[nodiscard]] Layer layer_of(const Hit& hit, const Sight& ray, Scratch& scratch) const;
  [[nodiscard]] Layer layer_of_surface(const Hit& hit, const Sight& ray, Scratch& scratch) const;
  [[nodiscard]] bool blocked(Point3 from, Vector3 direction, double reach) const;
  [[nodiscard]] Reached light_reaching(Point3 at, Vector3 normal, Scratch& scratch) const;
  [[nodiscard]] Radiance composite(const Radiance& background, Scratch& scratch) const;

  const PictureScene& scene_;
  const Camera& camera_;
  const RenderOptions& options_;
  double half_pixel_;  // of the plane z = 1
  std::vector<Sample> samples_;
  std::vector<Finish> finishes_;
  std::vector<Face> faces_;
  std::vector<Stroke> strokes_;
  std::vector<std::size_t>
      row_begin_;  // strokes of a row: row_strokes_[row_begin_[row] .. row_begin_[row + 1]]
  std::vector<std::uint32_t> row_strokes_;
  BeamHierarchy hierarchy_{std::span<const Box3>{}};
};

Renderer::Renderer(const PictureScene& scene, const Camera& camera, const RenderOptions& options)
    : scene_(scene), camera_(camera), options_(options), half_pixel_(camera.tangent / options.height) {
  // Each of the n * n samples has its own row and its own column among n * n: edges along the pixel grid,
  // too, get all n * n shades [Kensler13, without jitter].
  const int n = options.samples;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) samples_.push_back({(i + (j + 0.5) / n) / n, (j + (i + 0.5) / n) / n});
  for (const Material& m : scene.materials) finishes_.push_back(finish_of(m));

  std::vector<Box3> boxes;
  boxes.reserve(scene.triangles.size());
  faces_.reserve(scene.triangles.size());
  for (const ShadedTriangle& t : scene.triangles) {
    Face face{};
    Box3 box;
    face.smooth = true;
    for (int i = 0; i < 3; ++i) {
      face.corner[i] = turned(t.corner[i] - camera.eye);
      const double largest = max_abs(t.normal[i]);
      face.smooth = face.smooth && largest > 0;
      if (largest > 0) {
        const Vector3& given = t.normal[i];  // divided: 1 / largest may overflow
        face.normal[i] = normalized(turned({given.x / largest, given.y / largest, given.z / largest}));
      }
      box.add(origin + face.corner[i]);
    }
    const Vector3 area = cross(face.corner[1] - face.corner[0], face.corner[2] - face.corner[0]);
    if (!(length_sq(area) > 0)) continue;
    face.flat_normal = normalized(area);
    face.material = t.material;
    faces_.push_back(face);
    boxes.push_back(box);
  }
  hierarchy_ = BeamHierarchy(boxes);

  double reach = 0;
  for (const Line& line : scene.lines)
    reach = std::max(reach, std::max(length(line.a - camera.eye), length(line.b - camera.eye)));
  for (const Line& line : scene.lines) add_line(line, 1e-4 * reach);
  for (const Label& label : scene.labels) add_label(label);
  if (scene.bar) add_bar(*scene.bar);
  sort_strokes_into_rows();
}

void Renderer::add_line(const Line& line, double near_depth) {
  Vector3 a = turned(line.a - camera_.eye), b = turned(line.b - camera_.eye);
  if (!(near_depth > 0) || (a.z < near_depth && b.z < near_depth)) return;  // zero: all lines are in the eye
  const auto cut = [near_depth](Vector3 behind, Vector3 ahead) {
    return behind + ((near_depth - behind.z) / (ahead.z - behind.z)) * (ahead - behind);
  };
  if (a.z < near_depth) a = cut(a, b);
  if (b.z < near_depth) b = cut(b, a);
  const auto column = [this](Vector3 p) { return (p.x / p.z / half_pixel_ + options_.width) / 2; };
  const auto row = [this](Vector3 p) { return (options_.height - p.y / p.z / half_pixel_) / 2; };
  const double half_width = line.width_in_pixels / 2;
  strokes_.push_back({column(a), row(a), column(b), row(b), 1 / a.z, 1 / b.z, half_width,
                      1 - std::min(0.5, 3 * half_width * 2 * half_pixel_), light_of(line.colour)});
}

// On a rim, so that it is read on everything.
void Renderer::write(std::string_view text, double left, double foot, double size, const Colour& colour) {
  constexpr double in_front = 1e12;  // one over a depth
  const bool bright = colour.red + colour.green + colour.blue > 1.5;
  const std::vector<LetterStroke> letters = lettering(text);
  for (const bool rim : {true, false}) {
    const Colour shown = !rim ? colour : bright ? Colour{0, 0, 0} : Colour{1, 1, 1};
    for (const LetterStroke& stroke : letters) {
      const double nearness = rim ? in_front : 2 * in_front;
      strokes_.push_back({left + size * stroke.from[0], foot - size * stroke.from[1],
                          left + size * stroke.to[0], foot - size * stroke.to[1], nearness, nearness,
                          (rim ? 0.17 : 0.08) * size, 1, light_of(shown)});
    }
  }
}

void Renderer::add_label(const Label& label) {
  // Long lines are smaller, and fit.
  const double size = std::min(label.height_in_pixels, options_.width / (2 + lettering_width(label.text)));
  write(label.text, size, options_.height - size * (1 + 1.7 * label.lines_up), size, label.colour);
}

// Along the lower border, its words above it: the ends at its ends, the name between them.
void Renderer::add_bar(const ColourBar& bar) {
  constexpr double in_front = 1e12;
  const double words = lettering_width(bar.least) + lettering_width(bar.name) + lettering_width(bar.largest);
  const double size = std::min(bar.height_in_pixels, options_.width / (5 + words));
  const double left = size, right = options_.width - size, top = options_.height - 1.3 * size,
               foot = options_.height - 0.7 * size, line = options_.height - 1.8 * size;
  for (double x = left; x + 1 <= right; x += 1) {
    const Colour colour = bar.colour((x + 0.5 - left) / (right - left));
    strokes_.push_back({x + 0.5, top, x + 0.5, foot, in_front, in_front, 0.5, 1, light_of(colour)});
  }
  const double end = right - size * lettering_width(bar.largest);
  write(bar.least, left, line, size, bar.text);
  write(bar.name, (left + size * lettering_width(bar.least) + end - size * lettering_width(bar.name)) / 2,
        line, size, bar.text);
  write(bar.largest, end, line, size, bar.text);
}

void Renderer::sort_strokes_into_rows() {
  const auto rows = static_cast<double>(options_.height);
  const auto span_of = [rows](const Stroke& s) {
    const double top = std::min(s.ay, s.by) - s.half_width, foot = std::max(s.ay, s.by) + s.half_width;
    return std::pair(static_cast<std::size_t>(std::clamp(std::floor(top), 0.0, rows)),
                     static_cast<std::size_t>(std::clamp(std::floor(foot) + 1, 0.0, rows)));
  };
  row_begin_.assign(static_cast<std::size_t>(options_.height) + 1, 0);
  for (const Stroke& s : strokes_)
    for (auto [row, end] = span_of(s); row < end; ++row) ++row_begin_[row + 1];
  for (std::size_t row = 1; row < row_begin_.size(); ++row) row_begin_[row] += row_begin_[row - 1];
  row_strokes_.resize(row_begin_.back());
  std::vector<std::size_t> next = row_begin_;
  for (std::uint32_t i = 0; i < strokes_.size(); ++i)
    for (auto [row, end] = span_of(strokes_[i]); row < end; ++row) row_strokes_[next[row]++] = i;
}

// The columns that the strokes of the row may touch, sorted.
void Renderer::gather_strokes(int row, Scratch& scratch) const {
  scratch.strokes.clear();
  const auto r = static_cast<std::size_t>(row);
  for (std::size_t i = row_begin_[r]; i < row_begin_[r + 1]; ++i) {
    const Stroke& s = strokes_[row_strokes_[i]];
    double from = 0, to = 1;  // the part of the stroke's axis that is near the row
    if (const double dy = s.by - s.ay; dy != 0) {
      const double t0 = (row - s.half_width - s.ay) / dy, t1 = (row + 1 + s.half_width - s.ay) / dy;
      from = std::clamp(std::min(t0, t1), 0.0, 1.0);
      to = std::clamp(std::max(t0, t1), 0.0, 1.0);
    }
    const double x0 = s.ax + from * (s.bx - s.ax), x1 = s.ax + to * (s.bx - s.ax);
    const double columns = options_.width;
    const double first = std::clamp(std::floor(std::min(x0, x1) - s.half_width), 0.0, columns);
    const double end = std::clamp(std::floor(std::max(x0, x1) + s.half_width) + 1, 0.0, columns);
    for (auto column = static_cast<std::uint32_t>(first); column < static_cast<std::uint32_t>(end); ++column)
      scratch.strokes.emplace_back(column, row_strokes_[i]);
  }
  std::sort(scratch.strokes.begin(), scratch.strokes.end());
}

void Renderer::hit_faces(int column, int row, Scratch& scratch) const {
  const Beam beam{ray_x(column), ray_x(column + 1), ray_y(row + 1), ray_y(row)};
  const auto farthest = [&scratch] {
    return *std::max_element(scratch.opaque_depth.begin(), scratch.opaque_depth.end());
  };
  double limit = farthest();
  hierarchy_.search(beam, limit, scratch.stack, [&](std::uint32_t index) {
    const Face& face = faces_[index];
    const Material& material = scene_.materials[face.material];
    bool nearer = false;
    for (std::uint32_t sample = 0; sample < scratch.rays.size(); ++sample) {
      Crossing crossing;
      if (!crosses(scratch.rays[sample], face, crossing)) continue;
      if (crossing.depth > scratch.opaque_depth[sample]) continue;
      if (!crossing.counterclockwise && !material.two_sided) continue;
      scratch.hits.push_back(
          {sample, index, Hit::Kind::face, crossing.depth, crossing.weight_a, crossing.weight_b});
      if (material.opacity < 1) continue;
      scratch.opaque_depth[sample] = crossing.depth;
      nearer = true;
    }
    if (nearer) limit = farthest();
    return limit;
  });
}

// Two fractions that have nothing to do with those of the pixels around.
std::array<double, 2> scattered(int column, int row) {
  std::array<double, 2> result{};
  auto bits = static_cast<std::uint64_t>(row) << 32 | static_cast<std::uint32_t>(column);
  for (double& share : result) {
    // The finaliser of SplitMix64.
    bits += 0x9e3779b97f4a7c15u;
    std::uint64_t z = bits;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    share = static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  }
  return result;
}

// A displacement of the picture, in coordinates of a surface.
Vector3 in_mesh(const SceneSurface& surface, Vector3 displacement) {
  return times(surface.to_mesh, displacement);
}

// A ray of the picture as one of a surface, with the same parameter; without what is cut away, and empty where
// nothing is left.
std::optional<snug::Ray> ray_of(const SceneSurface& surface, const std::optional<CutPlane>& cut, Point3 from,
                                Vector3 direction, double begin, double end) {
  if (cut) {
    const double height = dot(cut->normal, from - origin) - cut->offset, slope = dot(cut->normal, direction);
    if (slope > 0) end = std::min(end, -height / slope);
    if (slope < 0) begin = std::max(begin, -height / slope);
    if (slope == 0 && height > 0) return std::nullopt;
  }
  if (!(begin <= end)) return std::nullopt;
  return snug::Ray{surface.origin + in_mesh(surface, from - origin), in_mesh(surface, direction), begin, end};
}

// All hits that no opaque one hides; of a surface that lets light through also those behind.
void Renderer::hit_surface(std::uint32_t index, Scratch& scratch) const {
  const SceneSurface& surface = scene_.surfaces[index];
  const bool opaque = scene_.materials[surface.material].opacity >= 1;
  std::vector<std::uint32_t> samples(scratch.rays.size());
  std::vector<double> begins(scratch.rays.size(), 0);
  for (std::uint32_t i = 0; i < samples.size(); ++i) samples[i] = i;
  for (int layer = 0; !samples.empty() && layer < max_layers; ++layer) {
    scratch.mesh_rays.clear();
    std::vector<std::uint32_t> asked;
    for (const std::uint32_t sample : samples) {
      const Sight& sight = scratch.rays[sample];
      const Vector3 direction = camera_.forward + sight.x * camera_.right + sight.y * camera_.up;
      const auto ray =
          ray_of(surface, scene_.cut, camera_.eye, direction, begins[sample], scratch.opaque_depth[sample]);
      if (!ray) continue;
      scratch.mesh_rays.push_back(*ray);
      asked.push_back(sample);
    }
    scratch.quick_hits.resize(scratch.mesh_rays.size());
    surface.surface->cast(scratch.mesh_rays, scratch.quick_hits, {.threads = 1});
    samples.clear();
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const QuickHit& hit = scratch.quick_hits[i];
      if (!std::isfinite(hit.t)) continue;
      const std::uint32_t sample = asked[i];
      scratch.hits.push_back(
          {sample, static_cast<std::uint32_t>(scratch.surface_hits.size()), Hit::Kind::surface, hit.t, 0, 0});
      scratch.surface_hits.push_back({index, hit});
      if (opaque) {
        scratch.opaque_depth[sample] = hit.t;
      } else {
        begins[sample] = hit.t * (1 + 1e-9) + 2 * options_.surface_tolerance;
        samples.push_back(sample);
      }
    }
  }
}

bool Renderer::blocked(Point3 from, Vector3 direction, double reach) const {
  for (const SceneSurface& surface : scene_.surfaces) {
    if (scene_.materials[surface.material].opacity < 1) continue;
    const auto ray = ray_of(surface, scene_.cut, from, direction, 0, reach);
    if (ray && surface.surface->blocked(*ray)) return true;
  }
  return false;
}

// By rays from a place towards the key light, which is large, and to all sides; which ones they are depends on the
// place in the picture alone.
Reached Renderer::light_reaching(Point3 at, Vector3 normal, Scratch& scratch) const {
  const Point3 from = at + (4 * options_.surface_tolerance + 1e-4) * normal;
  const Vector3 side = normalized(
                    cross(std::fabs(normal.x) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0}, normal)),
                other = cross(normal, side);
  const auto next = [&] {
    // Places that fill the square evenly, one after the other, each pixel's from another one on.
    const auto n = static_cast<double>(++scratch.light_rays);
    const double u = scratch.light_offset[0] + 0.7548776662466927 * n,
                 v = scratch.light_offset[1] + 0.5698402909980532 * n;
    return std::pair(u - std::floor(u), 2 * std::numbers::pi * (v - std::floor(v)));
  };
  Reached reached;
  reached.traced = true;
  int open = 0;
  for (int i = 0; i < ambient_rays; ++i) {
    const auto [share, angle] = next();
    const double across = std::sqrt(share);
    const Vector3 direction = std::sqrt(1 - share) * normal + (across * std::cos(angle)) * side +
                              (across * std::sin(angle)) * other;
    open += !blocked(from, direction, ambient_reach);
  }
  reached.ambient = darkest + (1 - darkest) * open / ambient_rays;
  const Vector3 light = key_direction();
  const Vector3 towards = light.x * camera_.right + light.y * camera_.up + light.z * camera_.forward;
  if (dot(towards, normal) > 0) {
    const auto [share, angle] = next();
    const Vector3 first =
        normalized(cross(towards, std::fabs(towards.x) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0}));
    const double across = key_radius * std::sqrt(share);
    const Vector3 direction =
        towards + (across * std::cos(angle)) * first + (across * std::sin(angle)) * cross(towards, first);
    if (blocked(from, direction, infinity)) reached.key = 0;
  }
  return reached;
}

Layer Renderer::layer_of_surface(const Hit& hit, const Sight& ray, Scratch& scratch) const {
  const auto& [index, found] = scratch.surface_hits[hit.object];
  const SceneSurface& surface = scene_.surfaces[index];
  const Material& material = scene_.materials[surface.material];
  Finish finish = finishes_[surface.material];
  if (surface.colour) finish.albedo = light_of(surface.colour(found));
  if (!finish.lit) return {hit.depth, finish.albedo, material.opacity};
  const Vector3 direction = camera_.forward + ray.x * camera_.right + ray.y * camera_.up;
  const Vector3 to_eye = -normalized(Vector3{ray.x, ray.y, 1});
  Vector3 normal = normalized(times(surface.turn, found.normal));
  if (dot(normal, direction) > 0) normal = -normal;
  const Reached reached = options_.shadows && material.opacity >= 1
                              ? light_reaching(camera_.eye + hit.depth * direction, normal, scratch)
                              : Reached{};
  Vector3 seen = turned(normal);
  if (const double facing = dot(seen, to_eye); facing < 0) {
    const Vector3 edge_on = seen - facing * to_eye;
    seen = length_sq(edge_on) > 0 ? normalized(edge_on) : to_eye;
  }
  return {hit.depth, shade(finish, seen, to_eye, reached), material.opacity};
}

void Renderer::hit_stroke(std::uint32_t index, int column, int row, Scratch& scratch) const {
  const Stroke& s = strokes_[index];
  const double dx = s.bx - s.ax, dy = s.by - s.ay, length_squared = dx * dx + dy * dy;
  for (std::uint32_t sample = 0; sample < samples_.size(); ++sample) {
    const double x = column + samples_[sample].x - s.ax, y = row + samples_[sample].y - s.ay;
    const double t = length_squared > 0 ? std::clamp((x * dx + y * dy) / length_squared, 0.0, 1.0) : 0.0;
    const double ex = x - t * dx, ey = y - t * dy;
    if (ex * ex + ey * ey > s.half_width * s.half_width) continue;
    const double depth = s.pull / (s.a_nearness + t * (s.b_nearness - s.a_nearness));
    if (depth > scratch.opaque_depth[sample]) continue;
    scratch.hits.push_back({sample, index, Hit::Kind::line, depth, 0, 0});
    scratch.opaque_depth[sample] = depth;
  }
}

Layer Renderer::layer_of(const Hit& hit, const Sight& ray, Scratch& scratch) const {
  if (hit.kind == Hit::Kind::line) return {hit.depth, strokes_[hit.object].colour, 1};
  if (hit.kind == Hit::Kind::surface) return layer_of_surface(hit, ray, scratch);
  const Face& face = faces_[hit.object];
  const Finish& finish = finishes_[face.material];
  const double opacity = scene_.materials[face.material].opacity;
  if (!finish.lit) return {hit.depth, finish.albedo, opacity};

  const Vector3 sight{ray.x, ray.y, 1};
  const Vector3 to_eye = -normalized(sight);
  const Vector3 facet = dot(face.flat_normal, to_eye) < 0 ? -face.flat_normal : face.flat_normal;
  Vector3 normal = facet;
  if (face.smooth) {
    const Vector3 mean = hit.weight_a * face.normal[0] + hit.weight_b * face.normal[1] +
                         (1 - hit.weight_a - hit.weight_b) * face.normal[2];
    if (length_sq(mean) > 0) normal = dot(mean, facet) < 0 ? -mean : mean;
  }
  normal = normalized(normal);
  // Close to a silhouette an interpolated normal may face away: it is turned until it is seen edge on.
  if (const double facing = dot(normal, to_eye); facing < 0) {
    const Vector3 edge_on = normal - facing * to_eye;
    normal = length_sq(edge_on) > 0 ? normalized(edge_on) : to_eye;
  }
  return {hit.depth, shade(finish, normal, to_eye), opacity};
}

// The mean over the samples. Layers of equal depth are ordered by their looks, not by their place in the
// scene.
Radiance Renderer::composite(const Radiance& background, Scratch& scratch) const {
  std::vector<Hit>& hits = scratch.hits;
  std::erase_if(hits, [&](const Hit& hit) { return hit.depth > scratch.opaque_depth[hit.sample]; });
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
    return a.sample != b.sample ? a.sample < b.sample : a.depth < b.depth;
  });
  Radiance sum;
  auto hit = hits.begin();
  for (std::uint32_t sample = 0; sample < samples_.size(); ++sample) {
    scratch.layers.clear();
    for (; hit != hits.end() && hit->sample == sample; ++hit)
      scratch.layers.push_back(layer_of(*hit, scratch.rays[sample], scratch));
    std::sort(scratch.layers.begin(), scratch.layers.end(),
              [](const Layer& a, const Layer& b) { return (a <=> b) == std::partial_ordering::less; });
    if (!scratch.layers.empty()) ++scratch.rays_that_hit;
    double passing = 1;
    for (const Layer& layer : scratch.layers) {
      sum = sum + (passing * layer.opacity) * layer.light;
      passing *= 1 - layer.opacity;
    }
    sum = sum + passing * background;
  }
  return (1 / static_cast<double>(samples_.size())) * sum;
}

void Renderer::draw_row(int row, Scratch& scratch, std::uint8_t* out) const {
  const double down = (row + 0.5) / options_.height;
  const auto blend = [down](double top, double foot) { return top + down * (foot - top); };
  const auto &top = options_.background.top, &foot = options_.background.foot;
  const Radiance background =
      light_of({blend(top.red, foot.red), blend(top.green, foot.green), blend(top.blue, foot.blue)});
  gather_strokes(row, scratch);
  auto stroke = scratch.strokes.begin();
  for (int column = 0; column < options_.width; ++column) {
    scratch.hits.clear();
    scratch.surface_hits.clear();
    scratch.light_rays = 0;
    scratch.light_offset = scattered(column, row);
    scratch.opaque_depth.assign(samples_.size(), infinity);
    scratch.rays.clear();
    for (const Sample& s : samples_) scratch.rays.push_back({ray_x(column + s.x), ray_y(row + s.y)});
    for (; stroke != scratch.strokes.end() && stroke->first == static_cast<std::uint32_t>(column); ++stroke)
      hit_stroke(stroke->second, column, row, scratch);
    for (std::uint32_t i = 0; i < scene_.surfaces.size(); ++i) hit_surface(i, scratch);
    hit_faces(column, row, scratch);
    const Radiance mean = composite(background, scratch);
    for (const double light : {mean.red, mean.green, mean.blue})
      *out++ = static_cast<std::uint8_t>(std::lround(255 * srgb_from_light(std::clamp(light, 0.0, 1.0))));
  }
}

}  // namespace

CountedImage render_counted(const PictureScene& scene, const Camera& camera, const RenderOptions& options) {
  expect_sound(scene, camera, options);
  const Renderer renderer(scene, camera, options);
  const auto rows = static_cast<std::size_t>(options.height);
  const std::size_t row_bytes = std::size_t{3} * options.width;
  Image image{options.width, options.height, std::vector<std::uint8_t>(rows * row_bytes)};

  std::mutex mutex;  // guards the next three, and the calls of progress
  std::size_t done = 0;
  std::vector<std::unique_ptr<Renderer::Scratch>>
      spare;  // of ranges that are done; as many as are drawn at once
  std::exception_ptr failure;
  const auto take = [&] {
    const std::lock_guard lock(mutex);
    if (spare.empty()) return std::make_unique<Renderer::Scratch>();
    std::unique_ptr<Renderer::Scratch> scratch = std::move(spare.back());
    spare.pop_back();
    return scratch;
  };
  const auto finish_row = [&] {
    const std::lock_guard lock(mutex);
    ++done;
    if (failure != nullptr || !options.progress) return;
    // Before the lock is gone: no other thread may report after this one was told to end.
    try {
      options.progress(static_cast<double>(done) / static_cast<double>(rows));
    } catch (...) {
      failure = std::current_exception();
    }
  };
  const auto failed = [&] {
    const std::lock_guard lock(mutex);
    return failure != nullptr;
  };
  const auto body = [&](std::size_t begin, std::size_t end) {
    try {
      std::unique_ptr<Renderer::Scratch> scratch = take();
      for (std::size_t row = begin; row < end && !failed(); ++row) {
        renderer.draw_row(static_cast<int>(row), *scratch, image.rgb.data() + row * row_bytes);
        finish_row();
      }
      const std::lock_guard lock(mutex);
      spare.push_back(std::move(scratch));
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  if (options.parallel_for)
    options.parallel_for(rows, body);
  else
    body(0, rows);
  if (failure) std::rethrow_exception(failure);
  require_value(done == rows, "render: parallel_for did not call the body for all rows once");
  std::uint64_t hits = 0;
  for (const auto& scratch : spare) hits += scratch->rays_that_hit;
  const std::uint64_t rays_a_pixel = static_cast<std::uint64_t>(options.samples) * options.samples;
  return {std::move(image), rays_a_pixel * options.width * rows, hits};
}

Image render(const PictureScene& scene, const Camera& camera, const RenderOptions& options) {
  return render_counted(scene, camera, options).image;
}

}  // namespace snug
