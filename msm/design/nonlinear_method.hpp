#pragma once

#include "msm/design/uniaxial.hpp"

namespace springproof::msm {

/// Objective of the nonlinear method, dimensionless:
///   phi = sum (s - s_ref)²/sum s_ref² + sum (e_x - e_x,ref)²/sum e_x,ref²  over the reference's strains.
/// Source: thesis eq. 5.9.  @param edge  L0, mm
double uniaxial_objective(const CellStiffness& stiffness, double edge, const UniaxialCurve& reference);

/// The objective's residuals (first the stresses, then the lateral strains; phi is their squared norm) and,
/// unless null, their derivatives with respect to (k_e, k_f, k_d), a row each, mm/N.
Eigen::VectorXd uniaxial_residuals(const CellStiffness& stiffness, double edge,
                                   const UniaxialCurve& reference, Eigen::MatrixX3d* jacobian = nullptr);

struct NonlinearFit {
  CellStiffness stiffness;
  double objective;                      ///< phi at the minimum
  std::vector<CellStiffness> minimisers; ///< one per start; equal when the minimiser is unique
};

/// The nonlinear method: the k >= 0 that minimise phi, by Ceres's trust region from several starts.
/// @throws InputError if a reference column is all zero    @throws SolveError if no start converges
NonlinearFit nonlinear_method(const UniaxialCurve& reference, double edge);

/// How well a uniaxial test tells the three stiffnesses apart: the Jacobian of the residuals with respect to
/// (k_e, k_f, k_d)/(E L0) at a design, E the reference's initial slope.
struct Identifiability {
  Eigen::Vector3d singular_values; ///< descending
  Eigen::Matrix3d directions;      ///< right singular vectors, columns: combinations of (k_e, k_f, k_d)
  double condition;                ///< largest over smallest singular value
};
Identifiability identifiability(const CellStiffness& stiffness, double edge, const UniaxialCurve& reference);

} // namespace springproof::msm
