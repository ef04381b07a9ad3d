#include "msm/tetrahedron.hpp"

#include <Eigen/Dense>

namespace springproof::msm {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d edges_from_first(const TetrahedronPositions& x) {
  Matrix3d edges;
  for (int c = 0; c < 3; ++c) edges.col(c) = x[static_cast<std::size_t>(c + 1)] - x[0];
  return edges;
}

/// Calls action(e, a, b, x_b - x_a) for every edge e = (a, b).
template<class Action>
void for_each_edge(const TetrahedronPositions& x, const Action& action) {
  for (std::size_t e = 0; e < tetrahedron_edges.size(); ++e) {
    const auto [a, b] = tetrahedron_edges[e];
    action(static_cast<Eigen::Index>(e), a, b,
           Vector3d(x[static_cast<std::size_t>(b)] - x[static_cast<std::size_t>(a)]));
  }
}

} // namespace

double tetrahedron_volume(const TetrahedronPositions& x) {
  return edges_from_first(x).determinant() / 6;
}

EdgeMatrix biquadratic_stiffness(const TetrahedronPositions& rest, double lambda, double mu) {
  const Matrix3d inverse = edges_from_first(rest).inverse(); // row c: the gradient of N_(c+1)
  Eigen::Matrix<double, 3, 4> gradient;
  gradient.rightCols<3>() = inverse.transpose();
  gradient.col(0) = -gradient.rightCols<3>().rowwise().sum();
  std::array<Matrix3d, 6> shapes;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [a, b] = tetrahedron_edges[e];
    const Matrix3d product = gradient.col(a) * gradient.col(b).transpose();
    shapes[e] = 0.5 * (product + product.transpose());
  }
  const double volume = std::abs(tetrahedron_volume(rest));
  EdgeMatrix stiffness;
  for (std::size_t e = 0; e < 6; ++e)
    for (std::size_t f = 0; f < 6; ++f)
      stiffness(static_cast<Eigen::Index>(e), static_cast<Eigen::Index>(f)) =
          volume / 4 *
          (2 * mu * shapes[e].cwiseProduct(shapes[f]).sum() + lambda * shapes[e].trace() * shapes[f].trace());
  return stiffness;
}

EdgeValues squared_length_changes(const TetrahedronPositions& x, const EdgeValues& rest_lengths) {
  EdgeValues changes;
  for_each_edge(x, [&](Eigen::Index e, int, int, const Vector3d& d) {
    const double length = d.norm(); // a difference of squares would lose the digits of small changes
    changes[e] = (length - rest_lengths[e]) * (length + rest_lengths[e]);
  });
  return changes;
}

double biquadratic_energy(const TetrahedronPositions& x, const EdgeValues& rest_lengths,
                          const EdgeMatrix& stiffness) {
  const EdgeValues changes = squared_length_changes(x, rest_lengths);
  return 0.5 * changes.dot(stiffness * changes);
}

EdgeValues biquadratic_tensions(const TetrahedronPositions& x, const EdgeValues& rest_lengths,
                                const EdgeMatrix& stiffness) {
  EdgeValues tensions = 2 * stiffness * squared_length_changes(x, rest_lengths);
  for_each_edge(x, [&](Eigen::Index e, int, int, const Vector3d& d) { tensions[e] *= d.norm(); });
  return tensions;
}

TetrahedronPositions biquadratic_forces(const TetrahedronPositions& x, const EdgeValues& rest_lengths,
                                        const EdgeMatrix& stiffness) {
  const EdgeValues tension = stiffness * squared_length_changes(x, rest_lengths);
  TetrahedronPositions forces;
  forces.fill(Vector3d::Zero());
  for_each_edge(x, [&](Eigen::Index e, int a, int b, const Vector3d& d) {
    forces[static_cast<std::size_t>(a)] += 2 * tension[e] * d; // dDelta/dx_b = 2 d
    forces[static_cast<std::size_t>(b)] -= 2 * tension[e] * d;
  });
  return forces;
}

TetrahedronMatrix biquadratic_tangent(const TetrahedronPositions& x, const EdgeValues& rest_lengths,
                                      const EdgeMatrix& stiffness, TransverseTerm term) {
  const EdgeValues tension = stiffness * squared_length_changes(x, rest_lengths);
  Eigen::Matrix<double, 12, 6> gradients = Eigen::Matrix<double, 12, 6>::Zero(); // gradients of Delta_e
  TetrahedronMatrix tangent = TetrahedronMatrix::Zero();
  for_each_edge(x, [&](Eigen::Index e, int a, int b, const Vector3d& d) {
    gradients.block<3, 1>(3 * a, e) = -2 * d;
    gradients.block<3, 1>(3 * b, e) = 2 * d;
    if (term == TransverseTerm::clamped && tension[e] < 0) return;
    const Matrix3d geometric = 2 * tension[e] * Matrix3d::Identity();
    tangent.block<3, 3>(3 * a, 3 * a) += geometric;
    tangent.block<3, 3>(3 * b, 3 * b) += geometric;
    tangent.block<3, 3>(3 * a, 3 * b) -= geometric;
    tangent.block<3, 3>(3 * b, 3 * a) -= geometric;
  });
  tangent += gradients * stiffness * gradients.transpose();
  return tangent;
}

} // namespace springproof::msm
