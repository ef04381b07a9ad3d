#pragma once

#include "compare/cube/design_study.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

namespace springproof::compare {

/// Stiffnesses, what was minimised, lattice moduli, stability, errors on the cube and warnings of one design.
void write_design_text(std::ostream& out, const DesignAttempt& attempt);

/// One line per design; then, when measured, the cube's errors, a column per measure.
void write_comparison_text(std::ostream& out, const std::vector<DesignAttempt>& attempts);

/// The document of `design --json` without its "schema": method, stiffness_N_per_m, volume_stiffness_MPa,
/// residual (null for a closed form), moduli (MPa), warnings, stability (null for a cell that is no cube),
/// cube (when measured); or method and refused.
nlohmann::ordered_json attempt_to_json(const DesignAttempt& attempt);

/// C11, C12, C44, zener, youngs_modulus, poissons_ratio, shear_modulus; what is not finite becomes null.
nlohmann::ordered_json moduli_to_json(const msm::LatticeModuli& moduli);

/// Worst error on the cube against the strain to which the lattice is stable: pareto.csv, .svg, .png.
void plot_pareto_front(const std::string& folder, const std::vector<DesignAttempt>& attempts);

} // namespace springproof::compare
