#pragma once

#include "compare/solve/solve.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>

/// The error that steps in time leave, beside the one that a mesh leaves (mesh_study.hpp).
namespace springproof::compare {

/// A model's value of a measure with the case's step and with half of it.
struct HalvedStep {
  double value, half_step; ///< with the case's step and half of it, in the measure's unit
  double extrapolated;     ///< Richardson's, by the order p of the study: f0 = f2 + (f2 - f1)/(2^p - 1)
  std::optional<double> error_percent; ///< `value` against that; none where it is 0 but for rounding
};

struct TimeError {
  std::string measure, unit;
  std::optional<HalvedStep> fem,
      msm; ///< absent where the model failed, was not asked for, or has no such value
};

struct TimeStudy {
  /// Order of the scheme; 1 where a load jumps on the way: a step that meets the jump has one side's load for
  /// a part of the step, which moves the jump by that part.
  int order = 1;
  bool has_jumps = false;
  std::vector<TimeError> errors;       ///< one per measure
  std::vector<std::string> failures{}; ///< a sentence for each model that failed with half the step
};

/// Solves a dynamic case once more with half its step. Collective over MPI_COMM_WORLD.
/// @param answers  those to the case as it is
/// @throws InputError if the case has no [dynamics]
TimeStudy study_time(const cases::Scene& scene, const Answers& answers, const Request& request,
                     SolveFem solve_fem);

void write_time_study_text(std::ostream& out, const TimeStudy& study);

/// {"order", "load_jumps", "failures": [...], "measures": [{"measure", "unit", "fem": {"value", "half_step",
/// "extrapolated", "error_percent"} or null, "msm"}]}
nlohmann::ordered_json time_study_to_json(const TimeStudy& study);

} // namespace springproof::compare
