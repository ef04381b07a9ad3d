#pragma once

#include "cases/case/case.hpp"
#include "msm/lattice.hpp"

#include <optional>

/// The multi-load method: springs, and a volume term if wanted, fitted to a material's stresses along several
/// homogeneous deformations at once. The lattice's stress is linear in its stiffnesses at a given
/// deformation, so that the fit is a bounded linear least-squares problem with one minimum.
namespace springproof::msm {

/// A homogeneous state of the reference material.
struct MaterialState {
  Eigen::Matrix3d deformation_gradient;
  Eigen::Matrix3d cauchy_stress; ///< MPa
};

/// The material on a path at a logarithmic strain (simple shear: the amount of shear). Linear elasticity is s
/// = lambda tr(e) I + 2 mu e with e = ln V; Ogden's is taken as incompressible, its pressure such that the
/// free direction has no stress (simple shear: the direction across the plane of shear).
/// @throws InputError for E <= 0 or nu outside (-1, 0.5)
MaterialState material_state(const cases::Material& material, cases::LoadPath path, double strain);

struct MultiLoadSettings {
  std::vector<cases::LoadPath> paths; ///< at least one
  std::vector<double> weights;        ///< one per path, >= 0, not all 0
  double lowest_strain, highest_strain;
  bool has_volume_term;
  double incompressible_lambda; ///< MPa: Lame's constant that an incompressible material's volume term gives
                                ///< the lattice
  std::optional<double> split = std::nullopt; ///< t = (4K_d/3)/(K_f + 4K_d/3), held; nothing: fitted
  std::optional<Exponents> exponents{};       ///< of power-log springs, held; nothing: Hooke's
};

struct MultiLoadFit {
  CellStiffness stiffness;
  double objective; ///< sum of weight * error² over the paths
  /// |s_lattice - s_material| / |s_material| over each path's states; with a volume term and an
  /// incompressible material, of the deviators, for the pressure is then the volume term's.
  std::vector<double> errors;
};

/// Minimises sum of weight * error² over stiffnesses >= 0 with Ceres.
/// @param edge  of the cubical cell, mm
/// @throws InputError for settings without a meaning    @throws SolveError when the minimisation fails
MultiLoadFit multi_load_method(const cases::Material& material, double edge,
                               const MultiLoadSettings& settings);

/// The same for power-log springs, whose exponents are fitted with the stiffnesses: the squares of
/// exponent_prior (p - exponent) are added to the objective. Where the lattice is then unstable over the
/// strain range (is_stable_over), the exponents go together towards 1/2, with which the tension has no
/// second-order part, as Hooke's, as far as makes it stable; if nothing does, they stay.
/// @param exponent  near which they are held: closed_form_exponent()
/// @throws  as multi_load_method()
MultiLoadFit multi_load_with_exponents(const cases::Material& material, double edge,
                                       const MultiLoadSettings& settings, double exponent);

} // namespace springproof::msm
