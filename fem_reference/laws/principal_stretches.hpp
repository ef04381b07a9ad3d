#pragma once

#include "fem_reference/laws/formulation.hpp"

namespace springproof::fem_reference {

/// An isotropic stress in principal axes, as a function of the logarithmic stretches x_i = ln lambda_i.
struct PrincipalStress {
  Eigen::Vector3d kirchhoff;  ///< tau_i, MPa
  Matrix3 slope;              ///< d tau_i/d x_j, MPa
  Eigen::Vector3d difference; ///< (tau_i - tau_j)/(lambda_i² - lambda_j²) for the pairs (1,2), (2,0), (0,1),
                              ///< at their limit when the stretches coincide
};

using PrincipalLaw = std::function<PrincipalStress(const Eigen::Vector3d& log_stretches, Wanted wanted)>;

/// The stress law of an isotropic material given in principal axes. With F = sum lambda_i n_i x N_i and
/// P_i = tau_i/lambda_i the only entries of A = dP/dF in the axes n, N are
///   A_iijj = dP_i/d lambda_j,   A_ijij = m_ij,   A_ijji = (lambda_j² m_ij - tau_j)/(lambda_i lambda_j),
/// m_ij = (tau_i - tau_j)/(lambda_i² - lambda_j²) (i != j), which stay exact when stretches coincide as long
/// as m_ij does.
StressLaw in_principal_stretches(PrincipalLaw law);

/// sinh(a d)/sinh(d), to rounding error for every d; a at d = 0.
double sinh_ratio(double a, double d);

} // namespace springproof::fem_reference
