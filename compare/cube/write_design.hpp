#pragma once

#include "compare/cube/cube_benchmark.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

namespace springproof::compare {

/// Stiffnesses, what was minimised, lattice moduli, stability, errors on the cube and warnings of one design.
void write_design_text(std::ostream& out, const DesignAttempt& attempt);

/// One line per design; then, when measured, the cube's errors under either load set, a column per measure.
void write_comparison_text(std::ostream& out, const std::vector<DesignAttempt>& attempts);

/// The document of `design --json` without its "schema": method, stiffness_N_per_m, volume_stiffness_MPa,
/// residual (null for a closed form), moduli (MPa; null where not finite), warnings, stability (null for a
/// cell that is no cube), cube (when measured); or method and refused.
nlohmann::ordered_json attempt_to_json(const DesignAttempt& attempt);

/// worst_error_percent, mean_error_percent, worst_volume_error_percent, stable.
nlohmann::ordered_json errors_to_json(const LoadSetErrors& errors);

/// Worst error on the cube against the strain to which the lattice is stable: pareto.csv, .svg, .png.
void plot_pareto_front(const std::string& folder, const std::vector<DesignAttempt>& attempts);

} // namespace springproof::compare
