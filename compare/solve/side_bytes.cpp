#include "compare/solve/side_bytes.hpp"

#include "compare/solve/fields.hpp"

namespace cereal {

SPRINGPROOF_FIELDS(springproof::compare::Side, solution, setup_seconds, solve_seconds)
SPRINGPROOF_FIELDS(springproof::compare::MeshLimit, order, extrapolated, index_percent)
SPRINGPROOF_FIELDS(springproof::compare::StudiedMeasure, name, values, limit, discretisation_error_percent,
                   reason)
SPRINGPROOF_FIELDS(springproof::compare::MeshStudy, refine, unknowns, measures)
SPRINGPROOF_FIELDS(springproof::compare::Peer, program, side, largest_difference)

} // namespace cereal

namespace springproof::compare {

std::string to_bytes(const Comparison& comparison) {
  const cases::Fem& fem = comparison.scene.definition.fem; // what "auto" was taken to mean
  return to_bytes(comparison.fem, comparison.msm, comparison.design, comparison.mesh_study, comparison.peer,
                  comparison.choices, fem.formulation, fem.refine);
}

void from_bytes(const std::string& bytes, Comparison& comparison) {
  cases::Fem& fem = comparison.scene.definition.fem;
  from_bytes(bytes, comparison.fem, comparison.msm, comparison.design, comparison.mesh_study, comparison.peer,
             comparison.choices, fem.formulation, fem.refine);
}

} // namespace springproof::compare
