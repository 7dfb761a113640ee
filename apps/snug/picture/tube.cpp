#include <picture/tube.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <support/direction.h>

namespace snug {
namespace {

constexpr double pi = std::numbers::pi;

// A circle around a point of the chain.
struct Ring {
  Point3 centre;
  Vector3 along, across;  // of length 1 and perpendicular
};

Ring first_ring(Point3 centre, Vector3 along) {
  const double x = std::abs(along.x), y = std::abs(along.y), z = std::abs(along.z);
  const Vector3 axis = x <= y && x <= z ? Vector3{1, 0, 0} : y <= z ? Vector3{0, 1, 0} : Vector3{0, 0, 1};
  return {centre, along, normalized(cross(along, axis))};
}

// The next ring, turned about its chord as little as possible.
Ring next_ring(const Ring& last, Point3 centre, Vector3 along) {
  return {centre, along, normalized(last.across - dot(last.across, along) * along)};
}

unsigned ball_belts(unsigned sides) { return sides / 2; }
std::size_t ball_triangles(unsigned sides) { return std::size_t{2} * sides * (ball_belts(sides) - 1); }

// Adds triangles whose corners are on a sphere or on rings of the same radius.
class Builder {
 public:
  Builder(PictureScene& scene, double radius, unsigned sides, std::uint32_t material)
      : scene_(&scene), radius_(radius), sides_(sides), material_(material) {
    for (unsigned i = 0; i < sides; ++i) {
      cosines_.push_back(std::cos(2 * pi * i / sides));
      sines_.push_back(std::sin(2 * pi * i / sides));
    }
  }

  // Corner i of `from` meets corner i + shift of `to`.
  void join(const Ring& from, const Ring& to, unsigned shift) {
    for (unsigned i = 0; i < sides_; ++i) {
      const Vector3 a = radial(from, i), b = radial(from, i + 1), c = radial(to, i + 1 + shift),
                    d = radial(to, i + shift);
      add(from.centre, a, from.centre, b, to.centre, c);
      add(from.centre, a, to.centre, c, to.centre, d);
    }
  }

  // By how many corners a ring is ahead of another one around the same chord.
  [[nodiscard]] unsigned shift(const Ring& from, const Ring& to) const {
    const double ahead =
        std::atan2(dot(to.across, cross(from.along, from.across)), dot(to.across, from.across));
    const auto corners = std::lround(-ahead * sides_ / (2 * pi));
    return static_cast<unsigned>((corners + static_cast<long>(sides_)) % static_cast<long>(sides_));
  }

  void add_ball(Point3 centre) {
    const unsigned belts = ball_belts(sides_);
    const auto direction = [&](unsigned belt, unsigned i) {
      const double height = std::cos(pi * belt / belts), width = std::sin(pi * belt / belts);
      const unsigned side = i % sides_;
      if (belt == 0 || belt == belts) return Vector3{0, height, 0};
      return Vector3{width * cosines_[side], height, -width * sines_[side]};
    };
    for (unsigned belt = 0; belt < belts; ++belt) {
      for (unsigned i = 0; i < sides_; ++i) {
        const Vector3 a = direction(belt, i), b = direction(belt + 1, i), c = direction(belt + 1, i + 1),
                      d = direction(belt, i + 1);
        if (belt + 1 < belts) add(centre, a, centre, b, centre, c);
        if (belt > 0) add(centre, a, centre, c, centre, d);
      }
    }
  }

 private:
  [[nodiscard]] Vector3 radial(const Ring& ring, unsigned i) const {
    const unsigned side = i % sides_;
    return cosines_[side] * ring.across + sines_[side] * cross(ring.along, ring.across);
  }
  void add(Point3 p, Vector3 a, Point3 q, Vector3 b, Point3 r, Vector3 c) {
    scene_->triangles.push_back({{p + radius_ * a, q + radius_ * b, r + radius_ * c}, {a, b, c}, material_});
  }

  PictureScene* scene_;
  double radius_;
  unsigned sides_;
  std::uint32_t material_;
  std::vector<double> cosines_, sines_;
};

}  // namespace

Tube::Tube(std::span<const Point3> chain, double radius) : radius_(radius), points_{chain.front()} {
  const double least = radius / 50;
  for (const Point3& p : chain.subspan(1)) {
    if (length(p - points_.back()) >= least) points_.push_back(p);
  }
  // The end stays where it is.
  if (points_.size() > 1) {
    points_.back() = chain.back();
    if (points_.size() > 2 && length(points_.back() - points_[points_.size() - 2]) < least) {
      points_.erase(points_.end() - 2);
    }
  }
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    directions_.push_back(normalized(points_[i + 1] - points_[i]));
  }
  closed_ = chord_count() > 1 && points_.front() == points_.back();
}

bool Tube::has_ball(std::size_t point, unsigned sides) const {
  const std::size_t chords = chord_count();
  const bool end = point == 0 || point == chords;
  if (end && !closed_) return true;
  const Vector3 before = directions_[end ? chords - 1 : point - 1], after = directions_[point % chords];
  return dot(before, after) < std::cos(2 * pi / sides);
}

std::size_t Tube::triangle_count(unsigned sides) const {
  std::size_t count = chord_count() * 2 * sides;
  for (std::size_t i = closed_ ? 1 : 0; i < points_.size(); ++i) {
    if (has_ball(i, sides)) count += ball_triangles(sides);
  }
  return count;
}

void Tube::add_to(PictureScene& scene, unsigned sides, std::uint32_t material) const {
  Builder builder(scene, radius_, sides, material);
  const std::size_t chords = chord_count();
  for (std::size_t i = closed_ ? 1 : 0; i < points_.size(); ++i) {
    if (has_ball(i, sides)) builder.add_ball(points_[i]);
  }
  // Two chords without a ball between them share the ring across the bisector.
  const auto along = [&](std::size_t point, std::size_t chord) {
    if (has_ball(point, sides)) return directions_[chord];
    const std::size_t before = point == 0 ? chords - 1 : point - 1;
    return normalized(directions_[before] + directions_[point % chords]);
  };
  Ring first, last;
  for (std::size_t chord = 0; chord < chords; ++chord) {
    if (chord == 0 || has_ball(chord, sides)) last = first_ring(points_[chord], along(chord, chord));
    if (chord == 0) first = last;
    const Ring next = next_ring(last, points_[chord + 1], along(chord + 1, chord));
    const bool closes = chord + 1 == chords && !has_ball(chords, sides);
    closes ? builder.join(last, first, builder.shift(next, first)) : builder.join(last, next, 0);
    last = next;
  }
}

void Tube::add_outline(std::vector<Point3>& points) const {
  for (const Point3& p : points_) {
    for (int corner = 0; corner < 8; ++corner) {
      const auto side = [&](int axis) { return corner & axis ? radius_ : -radius_; };
      points.push_back(p + Vector3{side(1), side(2), side(4)});
    }
  }
}

}  // namespace snug
