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

std::size_t corner_at(bool triangular, TriangleParameter p) {
  return triangular ? triangle_corner(p.u, p.v) : quad_corner(p.u, p.v);
}

// Onto a quarter of a piece, which is counted from the piece's own corner 0.
Descent step_down(bool triangular, TriangleParameter p) {
  if (triangular) return descend(p);
  const bool right = p.u >= 0.5, upper = p.v >= 0.5;
  return {upper ? 3u - right : unsigned{right}, {2 * p.u - right, 2 * p.v - upper}};
}

}  // namespace

struct LimitEvaluator::Position {
  TriangleParameter at{};          // on `piece`, or on its regular child
  std::uint32_t piece = 0;         // the last one that is kept
  std::uint8_t first = 0;          // corner of the piece, or of its regular child, that its kind calls 0
  bool stopped = false;            // at the depth limit, where the corner stands for all of the piece
  std::size_t corner = no_corner;  // of the piece's kind
  const std::uint32_t* lattice = nullptr;  // of a regular piece: places in the refined net
  double turned = 1;  // derivative of u and v along the given ones: plus or minus 2^level
  double drift = 0;   // upper bound of what roundings have moved u or v by
};

struct LimitEvaluator::Batch {
  static constexpr std::size_t most = 128;
  std::array<double, most> u, v;
  std::array<std::uint32_t, most> numbers;  // of the answers
  std::array<std::uint8_t, most> quarters;  // of the piece, or which has_answer
  static constexpr std::uint8_t has_answer = 4;
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

LimitEvaluator::Position LimitEvaluator::start() const {
  SNUG_EXPECT(!pieces_.empty());
  Position place;
  place.first = pieces_[0].first;
  place.lattice = lattice_;
  return place;
}

TriangleParameter LimitEvaluator::on_patch(const Place& at) const {
  if (triangular_) return checked({at.u, at.v});
  require_value(at.u >= 0 && at.u <= 1 && at.v >= 0 && at.v <= 1,
                "a parameter is outside its quad: u and v must be from 0 to 1");
  return {at.u, at.v};
}

// Whether a parameter, `corner` of the piece if it is one, is an extraordinary corner for all practical ends.
bool LimitEvaluator::stop_at_corner(Position& place, std::size_t corner) const {
  const Piece& piece = pieces_[place.piece];
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

// Onto a quarter that step_down() named: a regular piece, or one that is kept.
void LimitEvaluator::enter(Position& place, unsigned quarter) {
  if (pieces_[place.piece].step == nullptr) refine(pieces_[place.piece]);
  const bool turns = triangular_ && quarter == 3;
  place.turned *= turns ? -2 : 2;
  place.drift = 2 * place.drift + (turns ? unit_roundoff : 0);
  const unsigned child = triangular_ && !turns ? (quarter + 3 - place.first) % 3 : quarter;
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

// Of the parameters from `begin` to `end` in room[side], all of one piece. Parameters of its quarters go to the other side,
// quarter by quarter.
void LimitEvaluator::answer(const Position& all, std::array<Batch, 2>& room, std::size_t side,
                            std::size_t begin, std::size_t end, std::span<BoundedPoint> out) {
  Batch &here = room[side], &below = room[1 - side];
  if (all.lattice != nullptr) {
    const kernels::LatticePoints piece{
        basis_,      all.first, points_.data() + pieces_[all.piece].refined.first,
        all.lattice, origin_,   regular_error(all)};
    kernels::points_on_lattice(piece, {&here.u[begin], &here.v[begin], &here.numbers[begin], end - begin},
                               out.data());
    return;
  }
  const bool stop = pieces_[all.piece].level >= PiecePath::max_level;
  std::array<std::size_t, Batch::has_answer + 1> counts{};
  for (std::size_t i = begin; i < end; ++i) {
    const TriangleParameter at{here.u[i], here.v[i]};
    const std::size_t corner = corner_at(triangular_, at);
    if (Position place = all; (stop || corner != no_corner) && stop_at_corner(place, corner)) {
      out[here.numbers[i]] = corner_point(place).from(origin_);
      here.quarters[i] = Batch::has_answer;
    } else {
      const Descent down = step_down(triangular_, at);
      here.u[i] = down.at.u;
      here.v[i] = down.at.v;
      here.quarters[i] = static_cast<std::uint8_t>(down.child);
    }
    ++counts[here.quarters[i]];
  }
  std::array<std::size_t, Batch::has_answer + 1> next{begin};
  for (std::size_t q = 0; q < Batch::has_answer; ++q) next[q + 1] = next[q] + counts[q];
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t to = next[here.quarters[i]]++;
    below.u[to] = here.u[i];
    below.v[to] = here.v[i];
    below.numbers[to] = here.numbers[i];
  }
  for (std::uint8_t q = 0; q < Batch::has_answer; ++q) {
    if (counts[q] == 0) continue;
    Position place = all;
    enter(place, q);
    answer(place, room, 1 - side, next[q] - counts[q], next[q], out);
  }
}

void LimitEvaluator::points(std::span<const Place> at, std::span<BoundedPoint> out) {
  SNUG_EXPECT(at.size() == out.size());
  std::array<Batch, 2> room;
  for (std::size_t begin = 0; begin < at.size(); begin += Batch::most) {
    const std::size_t count = std::min(at.size() - begin, Batch::most);
    for (std::size_t i = 0; i < count; ++i) {
      const TriangleParameter there = on_patch(at[begin + i]);
      room[0].u[i] = there.u;
      room[0].v[i] = there.v;
      room[0].numbers[i] = static_cast<std::uint32_t>(i);
    }
    answer(start(), room, 0, 0, count, out.subspan(begin, count));
  }
}

LimitFrame LimitEvaluator::regular_frame(const Position& place) const {
  const Net& net = pieces_[place.piece].refined;
  const auto [u, v] = place.at;
  const std::array<double, 5> turned{1 - u - v, u, v, 1 - u - v, u};
  const double* const of_kind = turned.data() + place.first;
  kernels::BasisSums sums;
  kernels::sum_derivatives(basis_, points_.data() + net.first,
                           {of_kind[0], of_kind[1], of_kind[2], place.lattice}, sums);
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
  Position place = start();
  place.at = on_patch(at);
  while (place.lattice == nullptr && !stop_at_corner(place, corner_at(triangular_, place.at))) {
    const Descent down = step_down(triangular_, place.at);
    place.at = down.at;
    enter(place, down.child);
  }
  return place.lattice != nullptr ? regular_frame(place) : corner_frame(place);
}

std::size_t LimitEvaluator::bytes() const {
  return sizeof(*this) + pieces_.capacity() * sizeof(Piece) + points_.capacity() * sizeof(NetPoint);
}

}  // namespace snug
