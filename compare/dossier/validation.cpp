#include "cases/case/input_file.hpp"
#include "compare/dossier/dossier.hpp"

#include <cmath>
#include <fmt/format.h>
#include <sstream>

namespace springproof::compare {

NumericalBar numerical_bar(const ErrorBudget& budget, double value) {
  if (!budget.whole) return {std::nullopt, budget.reason};
  double percent = 0;
  for (const NamedPart& named : error_parts) {
    if (named.part == &ErrorBudget::law) continue;
    const ErrorPart& part = budget.*named.part;
    if (!part.percent) return {std::nullopt, fmt::format("its {}: {}", named.name, part.reason)};
    percent += std::abs(*part.percent) + part.uncertainty;
  }
  return {percent / 100 * std::abs(value / (1 + *budget.whole / 100)), ""};
}

void combine(ModelAgainstDatum& model, std::optional<double> deviation) {
  const auto square = [](double size) { return size * size; };
  double sum = 0;
  if (model.numerical.size) sum += square(*model.numerical.size);
  if (model.input) sum += square(2 * *model.input);
  if (deviation) sum += square(2 * *deviation);
  model.is_complete = model.numerical.size && model.input && deviation;
  model.uncertainty =
      model.numerical.size || model.input || deviation ? std::optional<double>(std::sqrt(sum)) : std::nullopt;
}

namespace {

/// Standard uncertainty of a measure by all uncertain keys.
std::optional<double> input_uncertainty(const StudiedCase& studied, std::size_t measure, cases::Side side) {
  if (studied.inputs.empty()) return std::nullopt;
  double sum = 0;
  for (const InputEffect& effect : studied.inputs) {
    const auto& all = side == cases::Side::fem ? effect.fem : effect.msm;
    if (measure >= all.size() || !all[measure]) return std::nullopt;
    sum += *all[measure] * *all[measure];
  }
  return std::sqrt(sum);
}

ModelAgainstDatum model_against(const Datum& datum, const StudiedCase& studied, cases::Side side) {
  ModelAgainstDatum model;
  const cases::Scene& scene = studied.comparison.scene;
  const Answers& answers = studied.comparison.answers;
  const bool is_fem = side == cases::Side::fem;
  const cases::Solution& solution = (is_fem ? answers.fem : answers.msm).solution;
  if (solution.status != cases::Status::converged) {
    model.reason = solution.message;
    return model;
  }
  const auto found = finite_value(datum.measure, scene, solution);
  if (const auto* reason = std::get_if<std::string>(&found)) {
    model.reason = *reason;
    return model;
  }
  model.value = std::get<double>(found);
  model.difference = *model.value - datum.value;
  model.numerical.reason = studied.budgets.note;
  for (const ErrorBudget& budget : is_fem ? studied.budgets.fem : studied.budgets.springs)
    if (budget.measure == datum.measure.name) model.numerical = numerical_bar(budget, *model.value);
  const std::vector<cases::Measure>& measures = scene.definition.measures;
  for (std::size_t m = 0; m < measures.size(); ++m)
    if (measures[m].name == datum.measure.name) model.input = input_uncertainty(studied, m, side);
  combine(model, datum.deviation);
  return model;
}

} // namespace

Validation validate(const std::string& file, const FitData& data,
                    const std::vector<const StudiedCase*>& of_state) {
  Validation validation{file, comments_of(cases::read_text_file(file))};
  for (const Datum& datum : data.data) {
    const StudiedCase& studied = *of_state[datum.state];
    ValidatedDatum row{studied.comparison.scene.definition.name,
                       data.states[datum.state].settings,
                       datum.measure.name,
                       unit_of(datum.measure),
                       datum.line,
                       datum.value,
                       datum.deviation};
    row.fem = model_against(datum, studied, cases::Side::fem);
    row.msm = model_against(datum, studied, cases::Side::msm);
    validation.data.push_back(std::move(row));
  }
  return validation;
}

std::string comments_of(const std::string& text) {
  std::string comments;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind('#', 0) != 0) break;
    comments += (comments.empty() ? "" : " ") + std::string(cases::without_blanks(line.substr(1)));
  }
  return comments;
}

} // namespace springproof::compare
