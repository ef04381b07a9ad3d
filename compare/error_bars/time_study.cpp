#include "compare/error_bars/time_study.hpp"

#include "compare/measure/measure.hpp"
#include "compare/provenance/print.hpp"
#include "mechanics/dynamics/scheme.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace springproof::compare {

namespace {

cases::Scene with_half_the_step(cases::Scene scene) {
  cases::Dynamics& dynamics = *scene.definition.dynamics;
  dynamics.step /= 2;
  dynamics.write_every *= 2; // the same bodies
  return scene;
}

std::optional<HalvedStep> halved_step(const cases::Measure& measure, const cases::Scene& scene,
                                      const Answer& whole, const Answer& half) {
  if (!whole.converged() || !half.converged()) return std::nullopt;
  const auto value = value_of(measure, scene, whole.solution),
             with_half = value_of(measure, scene, half.solution);
  if (!value || !with_half) return std::nullopt;
  const int order = mechanics::order_of(scene.definition.dynamics->scheme);
  const double extrapolated = *with_half + (*with_half - *value) / (std::pow(2, order) - 1);
  return HalvedStep{*value, *with_half, extrapolated,
                    error_percent(extrapolated, *value, zero_of(measure, scene, whole.solution))};
}

nlohmann::ordered_json halved_to_json(const std::optional<HalvedStep>& halved) {
  if (!halved) return nullptr;
  return {{"value", halved->value},
          {"half_step", halved->with_half},
          {"extrapolated", halved->extrapolated},
          {"error_percent", halved->error_percent ? nlohmann::ordered_json(*halved->error_percent)
                                                  : nlohmann::ordered_json()}};
}

} // namespace

std::vector<TimeError> study_time(const cases::Scene& scene, const Answers& answers, const Request& request,
                                  SolveFem solve_fem) {
  if (!scene.definition.dynamics)
    throw cases::InputError(scene.definition.file +
                            ": --converge-time halves the steps of [dynamics], which is "
                            "missing");
  Request single = request;
  single.meshes = 0;
  single.peer.clear();
  const Answers halves = solve(with_half_the_step(scene), single, solve_fem);
  std::vector<TimeError> study;
  for (const cases::Measure& measure : scene.definition.measures)
    study.push_back({measure.name, unit_of(measure), halved_step(measure, scene, answers.fem, halves.fem),
                     halved_step(measure, scene, answers.msm, halves.msm)});
  return study;
}

void write_time_study_text(std::ostream& out, const std::vector<TimeError>& study) {
  const auto text = [](const std::optional<HalvedStep>& halved) {
    return halved && halved->error_percent ? fmt::format("{:+.2g}", *halved->error_percent)
                                           : std::string("-");
  };
  print(out, "  {:<24} {:>14} {:>14}\n", "error of the steps, %", "fem", "msm");
  for (const TimeError& error : study)
    print(out, "  {:<24} {:>14} {:>14}\n", error.measure, text(error.fem), text(error.msm));
}

nlohmann::ordered_json time_study_to_json(const std::vector<TimeError>& study) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const TimeError& error : study)
    all.push_back({{"measure", error.measure},
                   {"unit", error.unit},
                   {"fem", halved_to_json(error.fem)},
                   {"msm", halved_to_json(error.msm)}});
  return all;
}

} // namespace springproof::compare
