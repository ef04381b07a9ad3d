#pragma once

#include "msm/design/lattice_moduli.hpp"

#include <optional>
#include <string>

/// How far a lattice's small-strain moduli are from its material's.
namespace springproof::msm {

struct ModuliMisfit {
  /// Of the engineering constants by axis: |E_lattice/E - 1|, |G_lattice/G - 1|, and what the lateral strain
  /// of a uniaxial test errs by as a part of its axial strain, |nu_lattice - nu|. Infinite when some strain
  /// has no energy.
  double largest;
  std::string text; ///< both sets of constants, in a sentence
};

/// What is told of: a body's error follows its moduli's one to one, and 5 % is what a mesh may err by.
constexpr double told_moduli_misfit = 0.05;

/// @param lattice  MPa    @param material  MPa, positive definite
ModuliMisfit moduli_misfit(const Elasticity& lattice, const Elasticity& material);

/// Of a material at rest; nothing for a fibre that lies along no axis, and where E is not above 0.
std::optional<Elasticity> elasticity_at_rest(const cases::Material& material);

} // namespace springproof::msm
