#pragma once

#include "msm/design/design.hpp"

#include <string>
#include <vector>

/// The figures of the thesis's chapters 4 and 5 about designs, as data (.csv) and pictures (.svg, .png) in a
/// folder.
namespace springproof::compare {

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
