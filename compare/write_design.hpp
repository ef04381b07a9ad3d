#pragma once

#include "msm/design/design.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>

namespace compare {

/// Stiffnesses, what was minimised, lattice moduli and warnings of one design, for a reader.
void write_design_text(std::ostream& out, const std::string& method, const msm::DesignResult& design);

/// The document of `design --json` without its "schema": method, stiffness_N_per_m, volume_stiffness_MPa,
/// residual (null for a closed form), moduli (MPa), warnings.
nlohmann::ordered_json design_to_json(const std::string& method, const msm::DesignResult& design);

/// C11, C12, C44, zener, youngs_modulus, poissons_ratio, shear_modulus; what is not finite becomes null.
nlohmann::ordered_json moduli_to_json(const msm::LatticeModuli& moduli);

} // namespace compare
