#include "msm/lattice.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <tuple>

namespace springproof::msm {

namespace {

using cases::index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Calls action(a, b, c, d) for every vertex a of every face; b, c, d follow it around the face.
template<class Action>
void for_each_corner(const Action& action) {
  for (const auto& face : cases::cell_faces) {
    const auto vertex = [&](std::size_t i) { return static_cast<std::size_t>(face[i % 4]); };
    for (std::size_t i = 0; i < 4; ++i) action(vertex(i), vertex(i + 1), vertex(i + 2), vertex(i + 3));
  }
}

/// Calls action(a, b, c) for every vertex a of every face of a tetrahedron; b, c follow it around the face.
template<class Action>
void for_each_corner_of_tetrahedron(const Action& action) {
  constexpr std::array<std::array<std::size_t, 3>, 4> faces{{{0, 3, 2}, {0, 1, 3}, {0, 2, 1}, {1, 2, 3}}};
  for (const auto& [a, b, c] : faces) {
    action(a, b, c);
    action(b, c, a);
    action(c, a, b);
  }
}

/// The matrix whose product with v is v x w.
Matrix3d minus_cross(const Vector3d& w) {
  Matrix3d cross;
  cross << 0, w.z(), -w.y(), -w.z(), 0, w.x(), w.y(), -w.x(), 0;
  return cross;
}

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

Positions<8> volume_gradient(const Positions<8>& x) {
  Positions<8> gradient;
  gradient.fill(Vector3d::Zero());
  for_each_corner([&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    gradient[a] += (x[b].cross(x[c] + x[d]) + x[c].cross(x[d])) / 12;
  });
  return gradient;
}

Positions<4> volume_gradient(const Positions<4>& x) {
  Positions<4> gradient;
  gradient.fill(Vector3d::Zero());
  for_each_corner_of_tetrahedron(
      [&](std::size_t a, std::size_t b, std::size_t c) { gradient[a] += x[b].cross(x[c]) / 6; });
  return gradient;
}

cases::CellCorners volume_gradient(const cases::CellCorners& x) {
  const auto of = [&x](auto positions) {
    std::copy(x.begin(), x.end(), positions.begin());
    positions = volume_gradient(positions);
    return cases::CellCorners(positions.begin(), positions.end());
  };
  return x.size() == 4 ? of(Positions<4>()) : of(Positions<8>());
}

double volume_of(const Positions<8>& x) {
  const Positions<8> gradient = volume_gradient(x);
  double triple = 0; // Euler: a cubic form is a third of its gradient times its argument
  for (std::size_t a = 0; a < 8; ++a) triple += x[a].dot(gradient[a]);
  return triple / 3;
}

double volume_of(const Positions<4>& x) {
  return edges_from_first(x).determinant() / 6;
}

Blocks<8> volume_second_derivative(const Positions<8>& x) {
  Blocks<8> blocks;
  for (auto& row : blocks) row.fill(Matrix3d::Zero());
  for_each_corner([&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    for (const auto& [second, third, sign] :
         {std::tuple(b, c, 1), {b, d, 1}, {c, d, 1}, {c, b, -1}, {d, b, -1}, {d, c, -1}})
      blocks[a][second] += minus_cross(sign / 12. * x[third]);
  });
  return blocks;
}

Blocks<4> volume_second_derivative(const Positions<4>& x) {
  Blocks<4> blocks;
  for (auto& row : blocks) row.fill(Matrix3d::Zero());
  for_each_corner_of_tetrahedron([&](std::size_t a, std::size_t b, std::size_t c) {
    blocks[a][b] += minus_cross(x[c] / 6);
    blocks[a][c] -= minus_cross(x[b] / 6);
  });
  return blocks;
}

double VolumePatch::volume(const Points& x) const {
  double sum = 0;
  for (const std::array<int, 4>& places : tetrahedra) sum += volume_of(at_nodes(places, x)) / 4;
  return sum;
}

Points VolumePatch::gradient(const Points& x) const {
  Points sum(nodes.size(), Vector3d::Zero());
  for (const std::array<int, 4>& places : tetrahedra) {
    const Positions<4> own = volume_gradient(at_nodes(places, x));
    for (std::size_t v = 0; v < 4; ++v) sum[index(places[v])] += own[v] / 4;
  }
  return sum;
}

VolumeLaw VolumePatch::law_at(const Points& rest, const Points& displacement) const {
  Points middle = rest;
  for (std::size_t v = 0; v < middle.size(); ++v) middle[v] += displacement[v] / 2;
  const Points slope = gradient(middle);
  double change = volume(displacement) / 4; // exact: the volume is a cubic form
  for (std::size_t v = 0; v < slope.size(); ++v) change += slope[v].dot(displacement[v]);
  return volume_law(1 + change / rest_volume, is_logarithmic);
}

double VolumePatch::small_motion_energy(const Points& rest, const Points& motion) const {
  const Points slope = gradient(rest);
  double change = 0;
  for (std::size_t v = 0; v < slope.size(); ++v) change += slope[v].dot(motion[v]);
  return 0.5 * stiffness / rest_volume * change * change;
}

Points VolumePatch::forces(const Points& x) const {
  const double pressure = stiffness * law(x).pressure + remembered;
  Points all = gradient(x);
  for (Vector3d& force : all) force *= -pressure;
  return all;
}

Eigen::MatrixXd VolumePatch::tangent_matrix(const Points& x, Clamp clamp) const {
  const VolumeLaw at = law(x);
  const double pressure = stiffness * at.pressure + remembered;
  const Points slope = gradient(x);
  Eigen::VectorXd all(3 * slope.size());
  for (std::size_t v = 0; v < slope.size(); ++v) all.segment<3>(static_cast<Eigen::Index>(3 * v)) = slope[v];
  Eigen::MatrixXd matrix = stiffness / rest_volume * at.slope * all * all.transpose();
  if (clamp == Clamp::yes) return matrix;
  for (const std::array<int, 4>& places : tetrahedra) {
    const Blocks<4> second = volume_second_derivative(at_nodes(places, x));
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        matrix.block<3, 3>(3 * places[a], 3 * places[b]) += pressure / 4 * second[a][b];
  }
  return matrix;
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
  const double volume = std::abs(volume_of(rest));
  EdgeMatrix stiffness;
  for (std::size_t e = 0; e < 6; ++e)
    for (std::size_t f = 0; f < 6; ++f)
      stiffness(static_cast<Eigen::Index>(e), static_cast<Eigen::Index>(f)) =
          volume / 4 *
          (2 * mu * shapes[e].cwiseProduct(shapes[f]).sum() + lambda * shapes[e].trace() * shapes[f].trace());
  return stiffness;
}

Tetrahedron make_tetrahedron(const std::array<int, 4>& nodes, const TetrahedronPositions& rest, double lambda,
                             double mu) {
  Tetrahedron made{nodes, biquadratic_stiffness(rest, lambda, mu), {}};
  for_each_edge(rest, [&](Eigen::Index e, int, int, const Vector3d& d) { made.rest_lengths[e] = d.norm(); });
  return made;
}

EdgeValues Tetrahedron::squared_length_changes(const TetrahedronPositions& x) const {
  EdgeValues changes;
  for_each_edge(x, [&](Eigen::Index e, int, int, const Vector3d& d) {
    const double length = d.norm(); // a difference of squares would lose the digits of small changes
    changes[e] = (length - rest_lengths[e]) * (length + rest_lengths[e]);
  });
  return changes;
}

EdgeValues Tetrahedron::tensions(const TetrahedronPositions& x) const {
  EdgeValues all = 2 * density(x);
  for_each_edge(x, [&](Eigen::Index e, int, int, const Vector3d& d) { all[e] *= d.norm(); });
  return all;
}

double Tetrahedron::energy(const TetrahedronPositions& x) const {
  const EdgeValues changes = squared_length_changes(x);
  return 0.5 * changes.dot(stiffness * changes) + changes.dot(remembered);
}

double Tetrahedron::small_motion_energy(const TetrahedronPositions& rest,
                                        const TetrahedronPositions& motion) const {
  EdgeValues changes; // changes of squared lengths, to first order
  for_each_edge(rest, [&](Eigen::Index e, int a, int b, const Vector3d& d) {
    changes[e] = 2 * d.dot(motion[static_cast<std::size_t>(b)] - motion[static_cast<std::size_t>(a)]);
  });
  return 0.5 * changes.dot(stiffness * changes);
}

TetrahedronPositions Tetrahedron::forces(const TetrahedronPositions& x) const {
  const EdgeValues tension = density(x);
  TetrahedronPositions all;
  all.fill(Vector3d::Zero());
  for_each_edge(x, [&](Eigen::Index e, int a, int b, const Vector3d& d) {
    all[static_cast<std::size_t>(a)] += 2 * tension[e] * d; // dDelta/dx_b = 2 d
    all[static_cast<std::size_t>(b)] -= 2 * tension[e] * d;
  });
  return all;
}

TetrahedronMatrix Tetrahedron::tangent_matrix(const TetrahedronPositions& x, Clamp clamp) const {
  const EdgeValues tension = density(x);
  Eigen::Matrix<double, 12, 6> gradients = Eigen::Matrix<double, 12, 6>::Zero(); // gradients of Delta_e
  TetrahedronMatrix tangent = TetrahedronMatrix::Zero();
  for_each_edge(x, [&](Eigen::Index e, int a, int b, const Vector3d& d) {
    gradients.block<3, 1>(3 * a, e) = -2 * d;
    gradients.block<3, 1>(3 * b, e) = 2 * d;
    if (clamp == Clamp::yes && tension[e] < 0) return;
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
