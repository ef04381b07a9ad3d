#pragma once

#include "msm/design/by_axis.hpp"
#include "msm/design/request.hpp"
#include "msm/design/small_strain.hpp"
#include "msm/design/uniaxial.hpp"

#include <optional>

/// Design: from a material to the stiffnesses of one cell. A method is a function, its line in design.cpp's
/// switch, and a row of cases/case/designs.cpp, which says what it is and what it takes.
namespace springproof::msm {

struct DesignResult {
  CellStiffness stiffness{};        ///< stiffnesses of the request's cell
  std::optional<double> residual{}; ///< the method's objective at its minimum; absent for a closed form
  LatticeModuli moduli{};
  std::vector<std::string> warnings{}; ///< why the design should not be trusted; empty for a sound one
  /// Cells of `stiffness`, or of terms: one kind for every cell, or two mirror images. design_for() of
  /// compare/solve says what every cell of a mesh has, or the scene's network.
  SpringBody springs{};
  std::optional<NearestModuli> by_fibre{}; ///< given by the transverse design, in place of the moduli's means
  /// Misfit of the lattice's moduli; absent beside by_fibre and where a curve stands for the material. From
  /// told_moduli_misfit on its text is one of the warnings.
  std::optional<ModuliMisfit> misfit{};

  /// Whether `stiffness` says what the springs are far from the boundary.
  bool is_of_four_stiffnesses() const {
    return springs.cells() || (springs.terms() && springs.terms()->boundary == Boundary::whole);
  }
};

/// Runs the method that request.options names, then examines its result.
/// @throws InputError when the material or a setting has no meaning for the method
DesignResult design(const DesignRequest& request);

/// Has a case's springs follow the law of designed ones.
void set_law(cases::Msm& options, const std::optional<Exponents>& exponents);

/// The designs that are made from such a material, isotropic or not, in the order of cases::all_designs().
std::vector<cases::Design> methods(const cases::Material& material);

/// The curves that the nonlinear method fits: the request's own, else the material's law (Ogden to strain
/// 0.4, linear elastic as s = E e to 0.1) with e_x = -nu e_z; 20 values from 0, as in the thesis.
/// @throws InputError unless 0 < nu <= 0.5
/// @param largest_strain  instead of those ends
UniaxialCurve uniaxial_reference(const DesignRequest& request,
                                 std::optional<double> largest_strain = std::nullopt);

} // namespace springproof::msm
