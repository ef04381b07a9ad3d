#include "msm/design/transverse.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace springproof::msm {

namespace {

/// c11, c12, c13, c33, c44, c66.
using ModuliVector = Eigen::Matrix<double, 6, 1>;
/// Elasticity in an orthonormal basis of the strains (Mandel's: shear strains times sqrt(2)).
using Mandel = Eigen::Matrix<double, 6, 6>;

Mandel elasticity(const ModuliVector& c) {
  Mandel result = Mandel::Zero();
  result.topLeftCorner<3, 3>() << c[0], c[1], c[2], c[1], c[0], c[2], c[2], c[2], c[3];
  result.diagonal().tail<3>() << 2 * c[4], 2 * c[4], 2 * c[5];
  return result;
}

} // namespace

NearestModuli nearest_lattice_moduli(const mechanics::TransverseModuli& m) {
  ModuliVector material, relation; // of a lattice: relation . moduli = 0
  material << m.c11, m.c12, m.c13, m.c33, m.c44, m.c66;
  relation << 0, 1, -1, 0, 1, -1;
  const Mandel root = Eigen::SelfAdjointEigenSolver<Mandel>(elasticity(material)).operatorInverseSqrt();
  Eigen::Matrix<double, 36, 6>
      relative; // columns: what a unit of each modulus adds to C^-1/2 C_lattice C^-1/2
  for (int c = 0; c < 6; ++c) relative.col(c) = (root * elasticity(ModuliVector::Unit(c)) * root).reshaped();
  // least |relative change|² with relation . (material + change) = 0
  const Mandel normal = relative.transpose() * relative;
  const ModuliVector towards = normal.ldlt().solve(relation);
  const ModuliVector change = -relation.dot(material) / relation.dot(towards) * towards;
  const ModuliVector c = material + change;
  const Mandel errors = root * elasticity(change) * root;
  NearestModuli nearest{{c[0], c[1], c[2], c[3], c[4], c[5], 0}, errors.norm(), 0};
  nearest.moduli.bulk_modulus =
      1 / elasticity(c).topLeftCorner<3, 3>().ldlt().solve(Eigen::Vector3d::Ones()).sum();
  nearest.misfit = Eigen::SelfAdjointEigenSolver<Mandel>(errors).eigenvalues().cwiseAbs().maxCoeff();
  return nearest;
}

AxisStiffness stiffness_by_axis(const mechanics::TransverseModuli& c, double split, int fibre, double edge) {
  const double volume = c.c13 - c.c44, internal = split * std::min(c.c44, c.c66);
  AxisStiffness result{};
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_fibre = axis == fibre;
    const double whole_edge =
        is_fibre ? c.c33 - volume - 2 * c.c44 + internal : c.c11 - volume - c.c66 - c.c44 + internal;
    result.springs[static_cast<std::size_t>(axis)] = edge * whole_edge / 4;
    result.springs[static_cast<std::size_t>(3 + axis)] = edge * ((is_fibre ? c.c66 : c.c44) - internal) / 2;
  }
  result.springs[6] = edge * 3 * internal / 4;
  result.volume = volume;
  return result;
}

} // namespace springproof::msm
