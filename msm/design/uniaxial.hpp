#pragma once

#include "cases/case/case.hpp"
#include "cases/case/names.hpp"
#include "msm/lattice.hpp"

#include <functional>

namespace springproof::msm {

/// Uniaxial test of a material or a cell: logarithmic axial strain, Cauchy stress (MPa), logarithmic lateral
/// strain.
struct UniaxialCurve {
  std::vector<double> axial_strain, stress, lateral_strain;
};

struct StrainRange {
  double lowest = 0, highest;
  int n_values = 20; ///< equally spaced, both ends included
};

/// Cauchy stress, MPa, of a stretch.
using StressLaw = std::function<double(double stretch)>;

/// s = sum_i (2 mu_i/alpha_i) (l^alpha_i - l^(-alpha_i/2)), incompressible; neo-Hookean is alpha = 2,
/// Mooney-Rivlin alpha = 2, -2. Source: thesis eq. 5.10 with c_(2i-1) = 2 mu_i/alpha_i, c_2i = alpha_i.
StressLaw ogden_law(const cases::Ogden& ogden);

/// s = 2 (l² - 1/l) sum_i i C_i (I1 - 3)^(i-1),  I1 = l² + 2/l, incompressible.  @param coefficients  C_1,
/// C_2, ... MPa
StressLaw yeoh_law(const std::vector<double>& coefficients);

/// The curves of a law whose lateral strain is -nu times the axial one.  @throws InputError for an empty
/// range
UniaxialCurve sample(const StressLaw& law, double poissons_ratio, const StrainRange& range);

SPRINGPROOF_ENUMERATION(CurveStrain,
                        engineering, ///< change of length over the length at rest
                        logarithmic,
                        stretch ///< length over the length at rest
)
SPRINGPROOF_ENUMERATION(CurveStress,
                        nominal, ///< force over the area at rest
                        cauchy   ///< over the deformed area
)
SPRINGPROOF_ENUMERATION(CurveUnit, Pa, kPa, MPa)

/// What the columns of a measured curve are.
struct CurveColumns {
  CurveStrain strain = CurveStrain::logarithmic; ///< along the axis, and lateral
  CurveStress stress = CurveStress::cauchy;
  CurveUnit unit = CurveUnit::MPa; ///< unit of the stresses
  /// Replaces lateral strains. Absent: they are in the third column, or else the material is
  /// incompressible.
  std::optional<double> poissons_ratio{};
};

/// A measured curve: columns strain, stress [, lateral strain], commas or blanks; lines that begin with #
/// and a heading (the first line alone may be one) are skipped.
/// @param text  the file's content   @param name  name of the file, for messages
/// @throws InputError with the line: no numbers, a missing column, strains that do not increase or that are
/// beyond e^2, nothing but zeros
UniaxialCurve read_curve(const std::string& text, const std::string& name, const CurveColumns& columns = {});

/// Equilibrium width of a stretched cell divided by its rest edge, Lx/L0: thesis eq. 5.3, solved by Newton's
/// method within a bracket.  @param stretch  Lz/L0 > 0    @throws SolveError when no positive width is in
/// equilibrium
double lateral_stretch(const CellStiffness& stiffness, double stretch);

/// Springs' response to the thesis's uniaxial test of one cell (eqs 5.3 to 5.8), at the given axial strains.
/// The volume term is not part of it.  @param edge  L0, mm
UniaxialCurve uniaxial_response(const CellStiffness& stiffness, double edge,
                                const std::vector<double>& axial_strain);

/// Cauchy stress of the cell, 4 F_z/Lx² with F_z of eq. 5.4, MPa.  @param x, z  Lx/L0, Lz/L0
double axial_stress(const CellStiffness& stiffness, double x, double z, double edge);

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
