#include <snug/patch/limit_evaluator.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/patch/descent.h>
#include <support/contract.h>
#include <support/error.h>

namespace snug {
namespace {

using kernels::NetPoint;

Vector3 spatial(const NetPoint& p) { return {p[0], p[1], p[2]}; }

// One row, where there are few.
Vector3 applied(const Stencils::Row& row, const NetPoint* points) {
  Vector3 sum;
  for (std::size_t i = 0; i < row.sources.size(); ++i) {
    sum = sum + row.weights[i] * spatial(points[row.sources[i]]);
  }
  return sum;
}

constexpr std::size_t no_corner = 4;

std::size_t triangle_corner(double u, double v) {
  const std::size_t corner = corner_at({u, v});
  return corner == 3 ? no_corner : corner;
}

std::size_t quad_corner(double u, double v) {
  if (!(u == 0 || u == 1) || !(v == 0 || v == 1)) return no_corner;
  return v == 0 ? (u == 0 ? 0 : 1) : (u == 0 ? 3 : 2);
}

}  // namespace

struct LimitEvaluator::Position {
  double u, v;                     // on `piece`, or on its regular child
  std::uint32_t piece = 0;         // the last one that is kept
  std::uint8_t first = 0;          // corner of the piece, or of its regular child, that its kind calls 0
  bool stopped = false;            // at the depth limit, where the corner stands for all of the piece
  std::size_t corner = no_corner;  // of the piece's kind
  const std::uint32_t* lattice = nullptr;  // of a regular piece: places in the refined net
  double turned = 1;  // derivative of u and v along the given ones: plus or minus 2^level
  double drift = 0;   // upper bound of what roundings have moved u or v by
};

void LimitEvaluator::reset(const Patch& patch) {
  const Kind& kind = *patch.kind;
  SNUG_EXPECT(!kind.key().polygon);
  triangular_ = kind.rules().triangular();
  basis_ = kind.rules().basis;
  pieces_.clear();
  lattice_ = nullptr;
  origin_ = patch.origin;
  points_.resize(patch.points.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vector3& p = patch.points[i];
    points_[i] = {p.x, p.y, p.z, 0};
  }
  Piece& whole =
      pieces_.emplace_back(Piece{&kind, patch.path.level(), patch.first, {0, patch.largest, patch.error}});
  if (!kind.polynomial()) return;
  lattice_ = kind.lattice().places.data();
  whole.refined = whole.control;
  add_ghosts(kind.lattice().ghosts, whole.control, whole.refined);
  whole.value_error = BasisBounds::value_error(whole.refined.largest, whole.refined.error, 0);
}

LimitEvaluator::Net LimitEvaluator::add_rows(const Stencils& stencils, const Net& from) {
  const std::size_t first = points_.size();
  points_.resize(first + stencils.row_count());
  const double largest = kernels::refine_net(stencils, points_.data() + from.first, points_.data() + first);
  return {static_cast<std::uint32_t>(first), largest, stencils.result_error(from.largest, from.error)};
}

// Ghosts follow the other points of a net.
void LimitEvaluator::add_ghosts(const Stencils& ghosts, const Net& from, Net& to) {
  if (ghosts.row_count() == 0) return;
  const Net added = add_rows(ghosts, from);
  to.largest = std::max(to.largest, added.largest);
  to.error = std::max(to.error, added.error);
}

void LimitEvaluator::refine(Piece& piece) {
  piece.step = &piece.kind->step();
  piece.refined = add_rows(piece.step->stencils, piece.control);
  piece.plain_error = piece.refined.error;
  add_ghosts(piece.step->ghosts, piece.control, piece.refined);
  piece.value_error = BasisBounds::value_error(piece.refined.largest, piece.refined.error, 0);
}

std::uint32_t LimitEvaluator::make_child(std::uint32_t piece, unsigned child) {
  const Piece& parent = pieces_[piece];
  const KindStep::Piece& step = parent.step->pieces[child];
  const std::size_t first = points_.size();
  points_.resize(first + step.control.size());
  const NetPoint* const from = points_.data() + parent.refined.first;
  for (std::size_t i = 0; i < step.control.size(); ++i) points_[first + i] = from[step.control[i]];
  const Piece made{step.kind,
                   parent.level + 1,
                   static_cast<std::uint8_t>((step.first + parent.first) % 3),
                   {static_cast<std::uint32_t>(first), parent.refined.largest, parent.plain_error}};
  const auto number = static_cast<std::uint32_t>(pieces_.size());
  pieces_[piece].children[child] = number;
  pieces_.push_back(made);
  return number;
}

// Whether the parameter is an extraordinary corner of the piece, for all practical ends.
bool LimitEvaluator::stop_at_corner(Position& place) const {
  const Piece& piece = pieces_[place.piece];
  std::size_t corner = triangular_ ? triangle_corner(place.u, place.v) : quad_corner(place.u, place.v);
  const bool stop = piece.level >= PiecePath::max_level;
  if (corner == no_corner && !stop) return false;
  const auto of_kind = [&](std::size_t k) { return triangular_ ? (k + 3 - place.first) % 3 : k; };
  const auto regular = [&](std::size_t k) { return piece.kind->regular_corner(of_kind(k)); };
  if (stop) {
    place.stopped = true;
    for (corner = 0; corner + 1 < piece.kind->rules().corners && regular(corner);) ++corner;
  } else if (regular(corner)) {
    return false;
  }
  place.corner = of_kind(corner);
  return true;
}

// One step down, to a regular piece or to one that is kept.
void LimitEvaluator::descend(Position& place) {
  if (pieces_[place.piece].step == nullptr) refine(pieces_[place.piece]);
  unsigned child = 0;
  if (triangular_) {
    const Descent down = snug::descend(TriangleParameter{place.u, place.v});
    place.u = down.at.u;
    place.v = down.at.v;
    place.turned *= down.child == 3 ? -2 : 2;
    place.drift = 2 * place.drift + (down.child == 3 ? unit_roundoff : 0);
    child = down.child == 3 ? 3 : (down.child + 3 - place.first) % 3;
  } else {
    const bool right = place.u >= 0.5, upper = place.v >= 0.5;
    place.u = 2 * place.u - right;
    place.v = 2 * place.v - upper;
    place.turned *= 2;
    child = upper ? 3 - right : right;
  }
  const Piece& piece = pieces_[place.piece];
  const KindStep::Piece& step = piece.step->pieces[child];
  place.first = static_cast<std::uint8_t>((step.first + place.first) % 3);
  if (!step.lattice.empty()) {
    place.lattice = step.lattice.data();
  } else {
    const std::uint32_t kept = piece.children[child];
    place.piece = kept != 0 ? kept : make_child(place.piece, child);
  }
}

void LimitEvaluator::locate(Position& place) {
  SNUG_EXPECT(!pieces_.empty());
  if (triangular_) {
    const TriangleParameter at = checked({place.u, place.v});
    place.u = at.u;
    place.v = at.v;
  } else {
    require_value(place.u >= 0 && place.u <= 1 && place.v >= 0 && place.v <= 1,
                  "a parameter is outside its quad: u and v must be from 0 to 1");
  }
  place.first = pieces_[0].first;
  place.lattice = lattice_;
  while (place.lattice == nullptr && !stop_at_corner(place)) descend(place);
}

RelativePoint LimitEvaluator::corner_point(const Position& place) const {
  const Piece& piece = pieces_[place.piece];
  const Net& net = piece.control;
  const NetPoint* const points = points_.data() + net.first;
  const Stencils& limits = place.corner < 3 ? piece.kind->corner_limits() : piece.kind->far_corner().limit;
  RelativePoint point{applied(limits.row(place.corner % 3), points),
                      limits.result_error(net.largest, net.error)};
  if (place.stopped) {
    Box3 box;
    for (std::size_t i = 0; i < piece.kind->control_count(); ++i) box.add(Point3{} + spatial(points[i]));
    point.error += enlarged(longest_side(box)) + 2 * net.error;
  }
  return point;
}

LimitFrame LimitEvaluator::corner_frame(const Position& place) const {
  const Piece& piece = pieces_[place.piece];
  LimitFrame frame;
  frame.point = corner_point(place);
  frame.differentiable = false;
  const Stencils& rows = place.corner < 3 ? piece.kind->corner_tangents() : piece.kind->far_corner().tangents;
  for (std::size_t t = 0; t < 2; ++t) {
    const Stencils::Row row = rows.row(2 * (place.corner % 3) + t);
    frame.tangents[t] = applied(row, points_.data() + piece.control.first);
  }
  add_normal(frame);
  return frame;
}

double LimitEvaluator::regular_error(const Position& place) const {
  const Piece& piece = pieces_[place.piece];
  if (place.drift == 0) return piece.value_error;
  return BasisBounds::value_error(piece.refined.largest, piece.refined.error, 4 * place.drift);
}

void LimitEvaluator::put_on_lattice(const Position& place, kernels::LatticePlace& out) const {
  const double u = place.u, v = place.v, w = 1 - u - v;
  // In the kind's order of corners.
  out.w = place.first == 0 ? w : place.first == 1 ? u : v;
  out.u = place.first == 0 ? u : place.first == 1 ? v : w;
  out.v = place.first == 0 ? v : place.first == 1 ? w : u;
  out.net = pieces_[place.piece].refined.first;
  out.lattice = place.lattice;
}

void LimitEvaluator::points(std::span<const Place> at, std::span<BoundedPoint> out) {
  SNUG_EXPECT(at.size() == out.size());
  constexpr std::size_t most = 64;
  std::array<kernels::LatticePlace, most> found;
  std::array<NetPoint, most> sums;
  std::array<std::uint32_t, most> which;
  for (std::size_t begin = 0; begin < at.size(); begin += most) {
    std::size_t count = 0;
    for (std::size_t i = begin; i < std::min(at.size(), begin + most); ++i) {
      Position place{at[i].u, at[i].v};
      locate(place);
      if (place.lattice == nullptr) {
        out[i] = corner_point(place).from(origin_);
        continue;
      }
      out[i].error = regular_error(place);
      which[count] = static_cast<std::uint32_t>(i);
      put_on_lattice(place, found[count++]);
    }
    kernels::sum_values(basis_, points_.data(), {found.data(), count}, sums.data());
    for (std::size_t k = 0; k < count; ++k) {
      BoundedPoint& point = out[which[k]];
      point = RelativePoint{spatial(sums[k]), point.error}.from(origin_);
    }
  }
}

LimitFrame LimitEvaluator::regular_frame(const Position& place) const {
  const Net& net = pieces_[place.piece].refined;
  std::array<kernels::LatticePlace, 1> at;
  put_on_lattice(place, at[0]);
  kernels::BasisSums sums;
  kernels::sum_derivatives(basis_, points_.data(), at, &sums);
  LimitFrame frame;
  frame.point = {spatial(sums.value), regular_error(place)};
  std::array<Vector3, 2> along{spatial(sums.along_u), spatial(sums.along_v)};
  double error = BasisBounds::derivative_error(net.largest, net.error, 4 * place.drift);
  if (triangular_) {
    // Derivatives along the kind's edges 01 and 02; those along the patch's are differences of these.
    const std::array<Vector3, 3> towards{Vector3{}, along[0], along[1]};
    const auto corner = [&](std::size_t k) { return towards[(k + 3 - place.first) % 3]; };
    along = {corner(1) - corner(0), corner(2) - corner(0)};
    error *= 3;
  }
  frame.tangents = {place.turned * along[0], place.turned * along[1]};
  frame.differentiable = true;
  frame.tangent_error = enlarged(std::fabs(place.turned) * error);
  add_normal(frame);
  return frame;
}

LimitFrame LimitEvaluator::frame(const Place& at) {
  Position place{at.u, at.v};
  locate(place);
  return place.lattice != nullptr ? regular_frame(place) : corner_frame(place);
}

std::size_t LimitEvaluator::bytes() const {
  return sizeof(*this) + pieces_.capacity() * sizeof(Piece) + points_.capacity() * sizeof(NetPoint);
}

}  // namespace snug
