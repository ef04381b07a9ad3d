#pragma once

#include "compare/cube/cube_benchmark.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

namespace springproof::compare {

/// Stiffnesses, what was minimised, lattice moduli, stability, errors on the cube and warnings of one design.
void write_design_text(std::ostream& out, const DesignAttempt& attempt);

/// One line per design; then, when measured, the cube's errors under either load set, a column per measure.
void write_comparison_text(std::ostream& out, const std::vector<DesignAttempt>& attempts);

/// Which of the measured designs to use for the request's material, its worst error and why, and what a case
/// takes that names no design; or why none is recommended.
std::string recommendation_text(const std::vector<DesignAttempt>& attempts,
                                const msm::DesignRequest& request);

/// The document of `design --json` without its "schema": method, stiffness_N_per_m, volume_stiffness_MPa,
/// residual (null for a closed form), moduli (MPa; null where not finite), warnings, stability (null for a
/// cell that is no cube), cube (when measured); or method and refused.
nlohmann::ordered_json attempt_to_json(const DesignAttempt& attempt);

/// What a case's own springs are: as attempt_to_json() has a design, with "design", its name, and
/// "kinds_of_cells", how many cells have springs of their own (0: all are alike). Null without a design of
/// ours. A network has no moduli: they are null.
nlohmann::ordered_json springs_of_case(const Comparison& comparison);

/// worst_error_percent, mean_error_percent, worst_volume_error_percent, stable.
nlohmann::ordered_json errors_to_json(const LoadSetErrors& errors);

/// Worst error on the cube against the strain to which the lattice is stable: pareto.csv, .svg, .png.
void plot_pareto_front(const std::string& folder, const std::vector<DesignAttempt>& attempts);

/// The figures of the thesis's chapters 4 and 5 about designs, as data (.csv) and pictures (.svg, .png) in a
/// folder.

/// Figures 4.6, 4.7 and 4.8: engineering stress over E and lateral strain of cells designed by the linear
/// method for the thesis's Poisson's ratios, pulled to 10 %, and the fit's residual.
void plot_linear_method(const std::string& folder, cases::Element element);

/// Figures 5.4, 5.6 and 5.7: stress and lateral strain of a pulled cell and of its reference.
/// @param name  the files' name    @param edge  L0, mm
void plot_uniaxial(const std::string& folder, const std::string& name, const msm::CellStiffness& design,
                   double edge, const msm::UniaxialCurve& reference);

/// A cell pulled along z with free sides.
struct PulledCell {
  std::string title;
  msm::CellStiffness stiffness;
  double edge;                      ///< L0, mm
  std::vector<double> axial_strain; ///< logarithmic
};

/// Figure 5.8: what each kind of spring contributes to the stress, a panel for each cell.
void plot_contributions(const std::string& folder, const std::string& name,
                        const std::vector<PulledCell>& cells);

/// Figure 5.5: the curves of all stiffnesses from 0 to 0.1 N/mm in steps of 0.02 whose lateral error, the
/// second term of eq. 5.9, is at most 0.01 against e_x = -e_z/2.
void plot_incompressible_family(const std::string& folder);

/// phi over the two best-determined directions of the nonlinear method's stiffnesses around its minimum, k >=
/// 0, with the minimum and other sets projected into the plane.
void plot_valley(const std::string& folder, const msm::CellStiffness& minimum, double edge,
                 const msm::UniaxialCurve& reference, const std::vector<msm::CellStiffness>& others);

/// Springs of a design, by its name.
struct NamedSprings {
  std::string name;
  msm::CellStiffness stiffness;
};

/// How the infinite lattices of designs follow a material: nominal stress over the material's Young's modulus
/// in uniaxial tests with free sides (logarithmic strains from -0.3 to 0.3) and under simple shear (amounts
/// to 0.6). Where a lattice's sides find no equilibrium its line ends.
/// @param edge  edge of the designs' cell, mm
void plot_stress_strain(const std::string& folder, const cases::Material& material,
                        const std::vector<NamedSprings>& designs, double edge);

} // namespace springproof::compare
