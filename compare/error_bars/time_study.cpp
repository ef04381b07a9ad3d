#include "cases/scene/scene.hpp"
#include "compare/error_bars/convergence.hpp"
#include "compare/measure/measure.hpp"
#include "compare/provenance/print.hpp"
#include "compare/table/json.hpp"
#include "mechanics/dynamics/scheme.hpp"

#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

void to_json(Json& json, const HalvedStep& halved) {
  json = SPRINGPROOF_MEMBERS(halved, value, half_step, extrapolated, error_percent);
}

void to_json(Json& json, const TimeError& error) {
  json = SPRINGPROOF_MEMBERS(error, measure, unit, fem, msm);
}

namespace {

std::optional<HalvedStep> halved_step(const cases::Measure& measure, const cases::Scene& scene, int order,
                                      const Answer& whole, const Answer& half) {
  if (!whole.converged() || !half.converged()) return std::nullopt;
  const auto value = value_of(measure, scene, whole.solution),
             with_half = value_of(measure, scene, half.solution);
  if (!value || !with_half) return std::nullopt;
  const double extrapolated = *with_half + (*with_half - *value) / (std::pow(2, order) - 1);
  return HalvedStep{*value, *with_half, extrapolated,
                    error_percent(extrapolated, *value, zero_of(measure, scene, whole.solution))};
}

std::vector<std::string> failures_of(const Answers& halves) {
  std::vector<std::string> found;
  for (const auto& [side, answer] : {std::pair("fem", &halves.fem), std::pair("msm", &halves.msm)})
    if (const cases::Solution& solution = answer->solution; solution.status == cases::Status::failed)
      found.push_back(fmt::format("{} with half the step, at {:.4g} of the time: {}", side,
                                  solution.load_reached, solution.message));
  return found;
}

} // namespace

cases::Scene with_half_the_step(cases::Scene scene) {
  cases::Dynamics& dynamics = *scene.definition.dynamics;
  dynamics.step /= 2;
  dynamics.write_every *= 2; // the same bodies
  return scene;
}

void check_time_study(const cases::Scene& scene, const Request& request) {
  const cases::Case& definition = scene.definition;
  if (!definition.dynamics)
    throw cases::InputError(definition.file +
                            ": --converge-time halves the steps of [dynamics], which is missing");
  const auto refuse_if = [](bool is_there, const cases::Where& where, const char* key) {
    if (is_there)
      throw cases::InputError(where, fmt::format("{} must be left out with --converge-time: what its steps "
                                                 "leave unsolved follows no order in the step; "
                                                 "--error-budget tells both apart",
                                                 key));
  };
  const cases::Msm& msm = definition.msm;
  refuse_if(request.asks(cases::Side::msm) && msm.real_time, msm.where, "real_time");
  refuse_if(request.asks(cases::Side::msm) && msm.iterations_per_step, msm.where, "iterations_per_step");
  refuse_if(request.asks(cases::Side::fem) && definition.fem.real_time, definition.fem.where, "real_time");
}

int order_in_time(const cases::Scene& scene) {
  return cases::jumps_on_the_way(scene) || !scene.definition.tools.empty()
             ? 1
             : mechanics::order_of(scene.definition.dynamics->scheme);
}

TimeStudy study_time(const cases::Scene& scene, const Answers& answers, const Request& request,
                     SolveFem solve_fem) {
  check_time_study(scene, request);
  Request single = request;
  single.meshes = 0;
  single.peer.clear();
  const Answers halves = solve(with_half_the_step(scene), single, solve_fem);
  TimeStudy study;
  study.has_jumps = cases::jumps_on_the_way(scene);
  study.has_tools = !scene.definition.tools.empty();
  study.order = order_in_time(scene);
  study.failures = failures_of(halves);
  for (const cases::Measure& measure : scene.definition.measures)
    study.errors.push_back({measure.name, unit_of(measure),
                            halved_step(measure, scene, study.order, answers.fem, halves.fem),
                            halved_step(measure, scene, study.order, answers.msm, halves.msm)});
  return study;
}

void write_time_study_text(std::ostream& out, const TimeStudy& study) {
  const auto text = [](const std::optional<HalvedStep>& halved) {
    return halved && halved->error_percent ? fmt::format("{:+.2g}", *halved->error_percent)
                                           : std::string("-");
  };
  print(out, "  {:<24} {:>14} {:>14}{}\n", "error of the steps, %", "fem", "msm",
        study.has_jumps   ? "   (order 1: a load jumps on the way)"
        : study.has_tools ? "   (order 1: a tool meets the body)"
                          : "");
  for (const TimeError& error : study.errors)
    print(out, "  {:<24} {:>14} {:>14}\n", error.measure, text(error.fem), text(error.msm));
  for (const std::string& failure : study.failures) print(out, "  FAILED: {}\n", failure);
}

Json time_study_to_json(const TimeStudy& study) {
  return {{"order", study.order},
          {"load_jumps", study.has_jumps},
          {"failures", study.failures},
          {"measures", study.errors}};
}

} // namespace springproof::compare
