#include <snug/patch/quarters.h>

#include <algorithm>

namespace snug {
namespace {

// Rows of a net after other points; returns their common error and raises `largest`.
double append_rows(const Stencils& rows, const ControlNet& net, std::vector<kernels::NetPoint>& to,
                   double& largest) {
  const std::size_t begin = to.size();
  const double from_largest = net.largest;
  to.resize(begin + rows.row_count());
  largest = std::max(largest, kernels::refine_net(rows, net.points.data(), to.data() + begin));
  return rows.result_error(from_largest, net.error);
}

}  // namespace

ControlNet control_net(const Patch& patch) {
  ControlNet net{patch.kind, {}, patch.largest, patch.error};
  net.points.reserve(patch.points.size());
  for (const Vector3& p : patch.points) net.points.push_back({p.x, p.y, p.z, 0});
  return net;
}

LatticeNet with_ghosts(ControlNet& net) {
  const KindLattice& lattice = net.kind->lattice();
  double error = net.error;
  if (lattice.ghosts.row_count() > 0)
    error = std::max(error, append_rows(lattice.ghosts, net, net.points, net.largest));
  return {net.points, lattice.places, net.largest, error};
}

NetQuarters::NetQuarters(const ControlNet& net) : step_(net.kind->step()) {
  points_.reserve(step_.stencils.row_count() + step_.ghosts.row_count());
  plain_error_ = error_ = append_rows(step_.stencils, net, points_, largest_);
  if (step_.ghosts.row_count() > 0)
    error_ = std::max(error_, append_rows(step_.ghosts, net, points_, largest_));
}

ControlNet NetQuarters::net(std::size_t k) const {
  const KindStep::Piece& piece = step_.pieces[k];
  ControlNet net{piece.kind, {}, largest_, plain_error_};
  net.points.reserve(piece.control.size());
  for (const std::uint32_t i : piece.control) net.points.push_back(points_[i]);
  return net;
}

}  // namespace snug
