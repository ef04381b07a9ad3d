#include "msm/grid/cell_tangent.hpp"

#include "cases/mesh/hex_mesh.hpp"
#include "msm/spring.hpp"

#include <algorithm>

namespace springproof::msm::grid {

namespace {

using cases::index;

/// The springs between vertices v and w of a cell.
double stiffness_between(const CellSprings& cell, int v, int w) {
  const int step = v ^ w;
  switch (step) {
  case 1:
    return cell.edge[0];
  case 2:
    return cell.edge[1];
  case 4:
    return cell.edge[2];
  case 6:
    return cell.face_diagonal[0];
  case 5:
    return cell.face_diagonal[1];
  case 3:
    return cell.face_diagonal[2];
  default:
    return cell.internal_diagonal;
  }
}

std::optional<double> exponent_between(const std::optional<Exponents>& exponents, int v, int w) {
  if (!exponents) return std::nullopt;
  const int step = v ^ w, n_axes = (step & 1) + ((step >> 1) & 1) + (step >> 2);
  return n_axes == 1   ? exponents->edge
         : n_axes == 2 ? exponents->face_diagonal
                       : exponents->internal_diagonal;
}

} // namespace

CellTangent::CellTangent(const Body& body) : body_(body) {
  for (int step = 0; step < 8; ++step)
    rest_length_[index(step)] =
        Eigen::Vector3d(step & 1, (step >> 1) & 1, step >> 2).cwiseProduct(body.spacing).norm();
}

CellMatrix CellTangent::at(const CellSprings& cell, const CellPositions& displacement) const {
  CellPositions x = displacement;
  for (int v = 0; v < 8; ++v)
    for (int c = 0; c < 3; ++c) x[index(v)][c] += ((v >> c) & 1) * body_.spacing[c];
  CellMatrix sum;
  for (Corners& pair : sum) pair.setZero();
  const auto add = [&](int v, int w, const Eigen::Matrix3d& block) {
    for (int p = 0; p < n_pairs; ++p)
      sum[index(p)](v, w) += static_cast<float>(block(first_of_pair[p], second_of_pair[p]));
  };
  for (int v = 0; v < 8; ++v)
    for (int w = v + 1; w < 8; ++w) {
      const double stiffness = stiffness_between(cell, v, w);
      if (stiffness == 0) continue;
      const Eigen::Vector3d d = x[index(w)] - x[index(v)];
      const double rest = rest_length_[index(v ^ w)];
      if (!(d.squaredNorm() > 1e-12 * rest * rest)) continue;
      const Eigen::Matrix3d block = spring_stiffness(
          d, {stiffness, rest, exponent_between(body_.exponents, v, w)}, TransverseTerm::clamped);
      add(v, v, block);
      add(w, w, block);
      add(v, w, -block);
      add(w, v, -block);
    }
  if (cell.volume == 0) return sum;
  const double rest_volume = body_.spacing.prod();
  const auto gradient = trilinear_volume_gradient(x);
  // As the kernels have it: of a ratio of 0.1 at least, of logarithmic terms.
  const double slope = cell.volume / rest_volume *
                       (body_.exponents ? 1 / std::max(0.1, trilinear_volume(x) / rest_volume) : 1.0);
  for (int v = 0; v < 8; ++v)
    for (int w = 0; w < 8; ++w) add(v, w, slope * gradient[index(v)] * gradient[index(w)].transpose());
  return sum;
}

} // namespace springproof::msm::grid
