#pragma once

#include "compare/solve/solve.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

/// The error that steps in time leave, beside the one that a mesh leaves (mesh_study.hpp).
namespace springproof::compare {

/// A model's value of a measure with the case's step and with half of it.
struct HalvedStep {
  double value, with_half; ///< in the measure's unit
  double extrapolated;     ///< Richardson's, by the order p of the scheme: f0 = f2 + (f2 - f1)/(2^p - 1)
  std::optional<double> error_percent; ///< of `value` against that; none where it is 0 but for rounding
};

struct TimeError {
  std::string measure, unit;
  std::optional<HalvedStep> fem,
      msm; ///< absent where the model failed, was not asked for, or has no such value
};

/// Solves a dynamic case once more with half its step. Collective over MPI_COMM_WORLD.
/// @param answers  to the case as it is
/// @throws InputError if the case has no [dynamics]
std::vector<TimeError> study_time(const cases::Scene& scene, const Answers& answers, const Request& request,
                                  SolveFem solve_fem);

void write_time_study_text(std::ostream& out, const std::vector<TimeError>& study);

/// [{"measure", "unit", "fem": {"value", "half_step", "extrapolated", "error_percent"} or null, "msm"}]
nlohmann::ordered_json time_study_to_json(const std::vector<TimeError>& study);

} // namespace springproof::compare
