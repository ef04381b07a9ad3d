#include "msm/grid/cell_tangent.hpp"

#include "cases/mesh/mesh.hpp"
#include "msm/spring.hpp"

namespace springproof::msm::grid {

using cases::index;

double stiffness_across(const CellSprings& cell, int axes) {
  for (int a = 0; a < 3; ++a) {
    if (axes == 1 << a) return cell.edge[index(a)];
    if (axes == 7 - (1 << a)) return cell.face_diagonal[index(a)]; // all axes but a
  }
  return cell.internal_diagonal;
}

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
      const int axes = v ^ w;
      const double stiffness = stiffness_across(cell, axes);
      if (stiffness == 0) continue;
      const Eigen::Vector3d d = x[index(w)] - x[index(v)];
      const double rest = rest_length_[index(axes)];
      if (!(d.squaredNorm() > 1e-12 * rest * rest)) continue;
      const int n_axes = (axes & 1) + (axes >> 1 & 1) + (axes >> 2);
      const Eigen::Matrix3d block =
          spring_stiffness(d, {stiffness, rest, law_of(body_.exponents, n_axes)}, Clamp::yes);
      add(v, v, block);
      add(w, w, block);
      add(v, w, -block);
      add(w, v, -block);
    }
  for (int axis = 0; axis < 3; ++axis) {
    const double rest = body_.spacing[axis];
    const Midline midline{{}, axis, {cell.midline[index(axis)], rest, law_of(body_.exponents, 1)}};
    if (midline.spring.stiffness == 0 || !(midline.between_centres(x).squaredNorm() > 1e-12 * rest * rest))
      continue;
    const auto block = midline.tangent(x, Clamp::yes);
    for (int v = 0; v < 8; ++v)
      for (int w = 0; w < 8; ++w) add(v, w, block(index(v), index(w)));
  }
  if (cell.volume == 0) return sum;
  const double rest_volume = body_.spacing.prod();
  const auto gradient = volume_gradient(x);
  const double slope = with_law<double, Exact>(kind_of(body_.exponents), [&](auto law) {
    return typename decltype(law)::type::Volume{rest_volume}.template slope<Clamp::yes>(
        volume_of(x), cell.volume / rest_volume);
  });
  for (int v = 0; v < 8; ++v)
    for (int w = 0; w < 8; ++w) add(v, w, slope * gradient[index(v)] * gradient[index(w)].transpose());
  return sum;
}

} // namespace springproof::msm::grid
