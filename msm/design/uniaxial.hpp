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

/// Left side minus right side of eq. 5.3, N/mm; x = Lx/L0, z = Lz/L0.
template<class Number>
Number lateral_imbalance(const Number* k, const Number& x, double z) {
  using std::sqrt;
  const Number face = sqrt(2.0) * x / sqrt(x * x + z * z);           // sqrt2 sin a
  const Number internal = sqrt(3.0) * x / sqrt(2.0 * x * x + z * z); // sqrt6/2 sin b
  return x * (k[0] + 2.0 * k[1] + k[2]) - (k[0] + (1.0 + face) * k[1] + internal * k[2]);
}

/// Its derivative with respect to x.
template<class Number>
Number lateral_imbalance_slope(const Number* k, const Number& x, double z) {
  using std::sqrt;
  const Number face_length = sqrt(x * x + z * z), internal_length = sqrt(2.0 * x * x + z * z);
  const Number face = sqrt(2.0) * z * z / (face_length * face_length * face_length);
  const Number internal = sqrt(3.0) * z * z / (internal_length * internal_length * internal_length);
  return k[0] + 2.0 * k[1] + k[2] - face * k[1] - internal * k[2];
}

/// Cauchy stress of the cell, 4 F_z/Lx² with F_z of eq. 5.4, MPa.  @param k  N/mm
template<class Number>
Number axial_stress(const Number* k, const Number& x, double z, double edge) {
  using std::sqrt;
  const Number cos_face = z / sqrt(x * x + z * z);
  const Number cos_internal = z / sqrt(2.0 * x * x + z * z);
  const Number force_per_edge = z * (k[0] + 2.0 * k[1] + k[2]) -
                                (k[0] + 2.0 * sqrt(2.0) * cos_face * k[1] + sqrt(3.0) * cos_internal * k[2]);
  return 4.0 * force_per_edge / (edge * x * x);
}

} // namespace springproof::msm
