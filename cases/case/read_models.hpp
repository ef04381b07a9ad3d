#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

/// What either model is made with: [fem] and [msm].
namespace springproof::cases {

/// Reads them into a case whose body, [dynamics] and materials are read.
/// @throws InputError, also if a material has no meaning in the element, or the springs' design does not
/// exist for it
void read_models(Table& root, Case& result);

/// The design that we recommend for a body of these materials, which is the one of [msm] without `design` and
/// of `design` without --method. Transversely isotropic: "transverse". Otherwise "matched" where its lattice
/// is stable over the strains of its exponents: logarithmic strain with nu from 0.25 to 0.35, and Ogden; else
/// "hybrid", and with nu < 0, which that has not, "moduli".
/// @param materials  at least one    @param poissons_ratio  of the design, in place of the materials'
Design default_design(const std::vector<Material>& materials,
                      std::optional<double> poissons_ratio = std::nullopt);

} // namespace springproof::cases
