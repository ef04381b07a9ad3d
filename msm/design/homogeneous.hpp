#pragma once

#include "msm/lattice.hpp"

/// The infinite cubical lattice under a homogeneous deformation gradient F: thirteen springs per node and the
/// volume term. Every node is a centre of symmetry, so that an affine deformation is in equilibrium and the
/// energy is a closed form.
namespace springproof::msm {

/// Energy per rest volume, MPa:
///   W = (1/h³) sum over the 13 springs of K/2 (|F d| - |d|)² + k_v/2 (det F - 1)²
/// (or the power-log law's integrals),
/// with assembled K_e = 4 k_e, K_f = 2 k_f, K_d = k_d.  @param edge  h, mm
double lattice_energy_density(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f);

/// First Piola-Kirchhoff stress dW/dF, MPa.
Eigen::Matrix3d lattice_stress(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f);

/// Simple shear of xz by an amount.
Eigen::Matrix3d simple_shear(double amount);

/// Smallest eigenvalue of the dynamical matrix D(q) divided by |q h|², N/mm, over wave vectors q of the first
/// Brillouin zone. Positive: no small displacement of the infinite lattice, of any wavelength, lowers its
/// energy.
double smallest_wave_stiffness(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f);

/// How far a homogeneous lattice can be deformed before some wave loses its stiffness.
struct StabilityRange {
  double stretch; ///< largest stable l of uniaxial stretch with free sides; the search's end when stable to
                  ///< there
  double compression; ///< smallest stable l
  double shear;       ///< largest stable simple shear
};

/// The ends of the search, where a lattice counts as stable without limit.
constexpr StabilityRange search_ends = {3.0, 0.3, 2.0};

/// Found by walking along each path in steps of 2 % and bisecting the first step that is unstable, to 1e-4.
StabilityRange stability_range(const CellStiffness& stiffness, double edge);

/// Stretch of the sides at which they are free of stress, under an axial stretch along z.
/// @throws SolveError when there is none
double free_lateral_stretch(const CellStiffness& stiffness, double edge, double axial_stretch);

/// Whether the infinite lattice has no unstable wave at either end of the strains, in uniaxial tests along an
/// axis.
bool is_stable_over(const std::array<double, 2>& strain_range, const CellStiffness& stiffness, double edge);

} // namespace springproof::msm
