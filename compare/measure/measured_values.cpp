#include "compare/measure/measured_values.hpp"

#include "compare/measure/measure.hpp"

namespace springproof::compare {

std::vector<MeasuredValue> measure(const cases::Scene& scene, const Answers& answers) {
  std::vector<MeasuredValue> values;
  for (const cases::Measure& measure : scene.definition.measures) {
    const auto value_by = [&](const Answer& answer) -> std::optional<double> {
      if (answer.solution.status != cases::Status::converged) return std::nullopt;
      return evaluate(measure, scene, answer.solution);
    };
    MeasuredValue value{measure.name, unit_of(measure), value_by(answers.fem), value_by(answers.msm),
                        std::nullopt};
    if (answers.peer) value.peer = value_by(answers.peer->answer);
    if (value.fem && value.msm)
      value.error_percent = measure_error_percent(measure, scene, answers.fem.solution, answers.msm.solution);
    values.push_back(value);
  }
  return values;
}

} // namespace springproof::compare
