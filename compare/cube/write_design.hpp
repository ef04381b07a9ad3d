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

} // namespace springproof::compare
