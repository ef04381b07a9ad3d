#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "cases/case/read_case.hpp"
#include "cases/case/toml_table.hpp"
#include "compare/fit/fit.hpp"
#include "compare/measure/measure.hpp"
#include "compare/solve/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace springproof::compare {

cases::Scene scene_of(const FitCases& all, const FitState& state, const std::vector<std::string>& values) {
  std::vector<std::string> settings = all.settings;
  settings.insert(settings.end(), state.settings.begin(), state.settings.end());
  settings.insert(settings.end(), values.begin(), values.end());
  cases::Case definition = cases::read_case(state.file, settings);
  definition.measures.insert(definition.measures.end(), state.markers.begin(), state.markers.end());
  return make_scene_within_memory(definition);
}

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Ends that numbers of these names have in case files.
FreeParameter parameter_of(const std::string& key, double start) {
  const std::string name = key.substr(key.rfind('.') + 1);
  const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
  if (has("poissons_ratio")) return {key, start, -1, 0.5};
  if (has("exponent")) return {key, start, -20, 20};
  if (name == "beta") return {key, start, -1e-9, 2};
  if (has("split")) return {key, start, -1e-9, 1}; // 0 is among its values
  if (start > 0 &&
      (is_of_client(key) || has("modulus") || has("stiffness") || has("damping") || has("density")))
    return {key, start, 0};
  return {key, start};
}

/// @param free  KEY or KEY=START
FreeParameter read_parameter(const FitCases& all, const std::string& free) {
  const auto checked = [](const FreeParameter& parameter) {
    for (const double end : {parameter.lowest, parameter.highest})
      if (std::isfinite(end) && end != 0 && !(std::abs(parameter.start - end) >= 1e-3))
        throw cases::InputError(
            fmt::format("--free: {0}: starts from {1:g}, its end, must start inside by 0.001 "
                        "or more: --free {0}=START",
                        parameter.name, parameter.start));
    return parameter;
  };
  const std::size_t equals = free.find('=');
  const std::string key = free.substr(0, equals);
  if (equals != std::string::npos) {
    const auto start = cases::number_in<double>(free.substr(equals + 1));
    if (!start)
      throw cases::InputError(fmt::format("--free: {}: starts from \"{}\", must be a finite number", key,
                                          free.substr(equals + 1)));
    return checked(parameter_of(key, *start));
  }
  const auto start = cases::parse_file(all.files.front(), all.settings).at_path(key).value<double>();
  if (!start)
    throw cases::InputError(
        fmt::format("--free: {}: {} has no number there; say where to start: --free {}=START", key,
                    all.files.front(), key));
  return checked(parameter_of(key, *start));
}

/// The moduli of the body's own material.
std::vector<std::string> moduli_of(const cases::Case& definition) {
  if (std::holds_alternative<cases::LinearElastic>(definition.material) && cases::has_cells(definition.body))
    return {"material.youngs_modulus", "material.poissons_ratio"};
  throw cases::InputError(fmt::format("--free: is missing: {} has no youngs_modulus; name the keys to be "
                                      "fitted, as they stand in the file",
                                      definition.file));
}

/// @param digits  17 are all
std::vector<std::string> values_of(const std::vector<FreeParameter>& parameters, const VectorXd& values,
                                   int digits = 17) {
  std::vector<std::string> settings;
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (!is_of_client(parameters[p].name))
      settings.push_back(
          fmt::format("{}={:.{}g}", parameters[p].name, values[static_cast<Index>(p)], digits));
  return settings;
}

const cases::Solution& solution_of(const Answers& answers, cases::Side side) {
  return (side == cases::Side::fem ? answers.fem : answers.msm).solution;
}

VectorXd flattened(const std::vector<Eigen::Vector3d>& field) {
  return Eigen::Map<const VectorXd>(field.front().data(), 3 * static_cast<Index>(field.size()));
}

/// All data in one vector: those of measures, then the field or the surface of each state.
struct Layout {
  explicit Layout(const FitData& data) {
    for (const Datum& datum : data.data) state_of.push_back(datum.state);
    for (std::size_t s = 0; s < data.states.size(); ++s) {
      begin.push_back(static_cast<Index>(state_of.size()));
      state_of.insert(state_of.end(), data.states[s].n_beside_data(), s);
    }
  }
  std::vector<std::size_t> state_of; ///< each value's state
  std::vector<Index> begin;          ///< where those of each state begin
};

/// Root mean square of the data of one measure: what their errors are in proportion to.
double size_of(const FitData& data, const std::string& measure) {
  double sum = 0;
  int n = 0;
  for (const Datum& datum : data.data)
    if (datum.measure.name == measure) {
      sum += datum.value * datum.value;
      ++n;
    }
  return sum > 0 ? std::sqrt(sum / n) : 1;
}

/// Markers are of one size together.
std::string group_of(const Datum& datum) {
  const std::size_t at = datum.measure.name.find(" at (");
  return datum.measure.where.key.size() == 2 && at != std::string::npos ? "markers" : datum.measure.name;
}

bool has_deviations(const FitData& data) {
  return std::any_of(data.data.begin(), data.data.end(),
                     [](const Datum& d) { return d.deviation.has_value(); }) ||
         std::any_of(data.states.begin(), data.states.end(),
                     [](const FitState& s) { return s.surface && s.surface->deviation; });
}

Observations observations_of(const FitData& data, const Layout& layout) {
  const auto n = static_cast<Index>(layout.state_of.size());
  Observations all{VectorXd(n), VectorXd(n), has_deviations(data)};
  FitData grouped = data;
  for (Datum& datum : grouped.data) datum.measure.name = group_of(datum);
  for (std::size_t d = 0; d < data.data.size(); ++d) {
    all.values[static_cast<Index>(d)] = data.data[d].value;
    all.deviations[static_cast<Index>(d)] =
        data.data[d].deviation.value_or(size_of(grouped, grouped.data[d].measure.name));
  }
  for (std::size_t s = 0; s < data.states.size(); ++s) {
    if (const auto& surface = data.states[s].surface) {
      const double size = surface->moved.norm() / std::sqrt(static_cast<double>(surface->moved.size()));
      all.values.segment(layout.begin[s], surface->moved.size()) = surface->moved;
      all.deviations.segment(layout.begin[s], surface->moved.size())
          .setConstant(surface->deviation.value_or(size > 0 ? size : 1));
    }
    if (data.states[s].field.empty()) continue;
    const VectorXd field = flattened(data.states[s].field);
    all.values.segment(layout.begin[s], field.size()) = field;
    // Every state counts alike, whatever its number of nodes.
    all.deviations.segment(layout.begin[s], field.size()).setConstant(field.norm());
  }
  return all;
}

/// A model's answers in place of the data.
class Model {
 public:
  Model(const FitCases& all, const FitData& data, std::vector<FreeParameter> parameters, cases::Side side,
        const AnswerQuestions& answer, const std::optional<Client>& client)
      : all_(all), data_(data), layout_(data), parameters_(std::move(parameters)), side_(side),
        answer_(answer), client_(client) {}

  std::vector<Prediction> operator()(const std::vector<VectorXd>& choices) const {
    std::vector<Prediction> predictions(choices.size());
    std::vector<Question> questions;
    std::vector<std::size_t> of_question;
    for (std::size_t c = 0; c < choices.size(); ++c) {
      try {
        std::vector<Question> of_choice;
        for (const FitState& state : data_.states) {
          of_choice.push_back({scene_of(all_, state, values_of(parameters_, choices[c])), Request{side_}});
          // The data are compared with the case's own mesh: finer ones would tell the fit nothing.
          of_choice.back().scene.definition.fem.has_auto_accuracy = false;
        }
        for (Question& question : of_choice) {
          questions.push_back(std::move(question));
          of_question.push_back(c);
        }
      } catch (const cases::InputError& error) {
        predictions[c].failure = error.what();
      }
    }
    if (questions.empty()) return predictions;
    std::vector<Answers> answers;
    if (client_)
      for (std::size_t q = 0; q < questions.size(); ++q)
        answers.push_back(
            ask_with_values(questions[q].scene, *client_, parameters_, choices[of_question[q]]));
    else
      answers = answer_(questions);
    for (std::size_t first = 0; first < questions.size(); first += data_.states.size())
      predictions[of_question[first]] = read(&questions[first], &answers[first]);
    return predictions;
  }

 private:
  /// Takes the data out of the answers to all states.
  Prediction read(const Question* questions, const Answers* answers) const {
    Prediction found{VectorXd(static_cast<Index>(layout_.state_of.size()))};
    for (std::size_t s = 0; s < data_.states.size(); ++s) {
      const cases::Solution& solution = solution_of(answers[s], side_);
      if (solution.status != cases::Status::converged)
        return {{}, fmt::format("{}: {}", questions[s].scene.definition.name, solution.message)};
      for (std::size_t d = 0; d < data_.data.size(); ++d) {
        if (data_.data[d].state != s) continue;
        const auto value = finite_value(data_.data[d].measure, questions[s].scene, solution);
        if (const auto* reason = std::get_if<std::string>(&value))
          return {{},
                  fmt::format("{}: {}: {}", questions[s].scene.definition.name, data_.data[d].measure.name,
                              *reason)};
        found.values[static_cast<Index>(d)] = std::get<double>(value);
      }
      if (const auto& surface = data_.states[s].surface) // how far from where it was, less what is missing
        found.values.segment(layout_.begin[s], surface->moved.size()) =
            surface->moved - distances_from(questions[s].scene, solution.displacement, surface->points);
      if (!data_.states[s].field.empty())
        found.values.segment(layout_.begin[s], 3 * static_cast<Index>(data_.states[s].field.size())) =
            flattened(solution.displacement);
    }
    return found;
  }

  const FitCases& all_;
  const FitData& data_;
  Layout layout_;
  std::vector<FreeParameter> parameters_;
  cases::Side side_;
  const AnswerQuestions& answer_;
  const std::optional<Client>& client_;
};

std::string place_of(const FitState& state) {
  const std::string file = state.file.substr(state.file.rfind('/') + 1);
  return state.settings.empty() ? file : fmt::format("{}", fmt::join(state.settings, ", "));
}

/// Data of the states that are held out, or of the others.
FitData part_of(const FitData& data, bool is_held_out) {
  FitData part;
  std::vector<std::size_t> number(data.states.size());
  for (std::size_t s = 0; s < data.states.size(); ++s) {
    number[s] = part.states.size();
    if (data.states[s].is_held_out == is_held_out) part.states.push_back(data.states[s]);
  }
  for (const Datum& datum : data.data)
    if (data.states[datum.state].is_held_out == is_held_out) {
      part.data.push_back(datum);
      part.data.back().state = number[datum.state];
    }
  return part;
}

/// The data beside the model, and their sums by measure.
void add_rows(Fit& fit, const FitData& data, const Layout& layout, const Observations& all,
              const VectorXd& predicted) {
  const bool is_held_out = data.states.front().is_held_out;
  const auto add_sum = [&](const std::string& name, const auto& belongs) {
    std::vector<bool> is_meant;
    for (std::size_t i = 0; i < layout.state_of.size(); ++i) is_meant.push_back(belongs(i));
    const auto n = static_cast<std::size_t>(std::count(is_meant.begin(), is_meant.end(), true));
    if (n > 0)
      fit.measures.push_back({name, n, prediction_error_percent(all, predicted, is_meant), is_held_out});
  };
  std::vector<std::string> names;
  for (std::size_t d = 0; d < data.data.size(); ++d) {
    const Datum& datum = data.data[d];
    fit.rows.push_back({place_of(data.states[datum.state]), datum.measure.name, unit_of(datum.measure),
                        datum.line, datum.value, predicted[static_cast<Index>(d)], is_held_out});
    if (!cases::contains(names, group_of(datum))) names.push_back(group_of(datum));
  }
  for (const std::string& name : names)
    add_sum(name, [&](std::size_t i) { return i < data.data.size() && group_of(data.data[i]) == name; });
  for (std::size_t s = 0; s < data.states.size(); ++s)
    add_sum(data.states[s].surface ? data.states[s].surface->file
                                   : place_of(data.states[s]) + ": displacement",
            [&](std::size_t i) { return i >= data.data.size() && layout.state_of[i] == s; });
}

/// Predicts the data of states that are held out, with the fitted values and with those of the start.
/// @param predict  predicts them
HeldOut predict_held_out(Fit& fit, const FitData& held, const Predict& predict, const VectorXd& start) {
  const Layout layout(held);
  const Observations observations = observations_of(held, layout);
  const std::vector<Prediction> found = predict({fit.found.parameters, start});
  for (const Prediction& one : found)
    if (!one.failure.empty()) return {"named", one.failure};
  add_rows(fit, held, layout, observations, found[0].values);
  const std::vector<bool> all(layout.state_of.size(), true);
  return {"named", "", prediction_error_percent(observations, found[0].values, all),
          prediction_error_percent(observations, found[1].values, all)};
}

/// Data of a state are held out together where there are states enough for it; else every datum by itself,
/// but a field or a surface as a whole: what is left of one would tell what is held out of it.
std::vector<int> groups_of(const FitData& data, const Layout& layout) {
  const bool has_states = data.states.size() > 2;
  std::vector<int> groups;
  std::map<std::size_t, int> number; // groups by the state, or by the place among the data
  for (std::size_t i = 0; i < layout.state_of.size(); ++i) {
    const bool is_alone = !has_states && i < data.data.size();
    const std::size_t of = is_alone ? i : data.data.size() + layout.state_of[i];
    groups.push_back(number.emplace(of, static_cast<int>(number.size())).first->second);
  }
  return groups;
}

HeldOut hold_out_in_turn(const LeastSquaresProblem& problem, const LeastSquares& found, const FitData& data,
                         const Layout& layout) {
  const std::vector<int> groups = groups_of(data, layout);
  const FitState& first = data.states.front();
  if (first.n_beside_data() > 0 && *std::max_element(groups.begin(), groups.end()) == 0)
    return {"", fmt::format("one {}; name cases with --hold-out", first.surface ? "surface" : "field")};
  return cross_validate(problem, found, groups);
}

} // namespace

Fit fit_cases(const FitCases& all, const FitData& data, const std::string& data_name,
              const std::vector<std::string>& free, cases::Side side, const AnswerQuestions& answer,
              const std::optional<Client>& client) {
  std::vector<FreeParameter> parameters;
  const cases::Case first = cases::read_case(all.files.front(), all.settings);
  for (const std::string& key : free.empty() ? moduli_of(first) : free)
    parameters.push_back(read_parameter(all, key));
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const std::string& key = parameters[p].name;
    for (std::size_t other = 0; other < p; ++other)
      if (parameters[other].name == key) throw cases::InputError("--free: " + key + ": is there twice");
    for (const FitState& state : data.states)
      for (const std::string& setting : state.settings)
        if (setting.rfind(key + "=", 0) == 0)
          throw cases::InputError(
              fmt::format("--free: {}: is a column of {}, and cannot be fitted", key, data_name));
  }
  check_client_parameters(parameters, client);
  const FitData fitted = part_of(data, false), held = part_of(data, true);
  if (held.states.empty() && !all.held_out.empty())
    throw cases::InputError(fmt::format("--hold-out: {} has no data of {}", data_name, all.held_out.front()));
  const Layout layout(fitted);
  const Observations observations = observations_of(fitted, layout);
  const std::size_t n = layout.state_of.size();
  if (n < parameters.size() || (n == parameters.size() && !observations.are_measured))
    throw cases::InputError(
        fmt::format("{}: has {} data to be fitted, must have {} for {} parameters: fit fewer with --free, or "
                    "give more data{}",
                    data_name, n, n < parameters.size() ? "at least as many" : "more", parameters.size(),
                    observations.are_measured ? "" : ", or standard deviations in a column sigma"));
  const LeastSquaresProblem problem(parameters, observations,
                                    Model(all, fitted, parameters, side, answer, client),
                                    client ? Smoothness::noisy : Smoothness::smooth);
  for (const FitState& state : data.states) scene_of(all, state, values_of(parameters, problem.start()));
  Fit fit{client                     ? client->name
          : side == cases::Side::fem ? "finite elements"
                                     : "springs",
          data_name, parameters, problem.fit(problem.start(), std::vector<bool>(n, true))};
  fit.n_data = n;
  fit.has_deviations = observations.are_measured;
  if (!fit.found.has_values()) return fit;
  add_rows(fit, fitted, layout, observations, fit.found.predicted);
  fit.held_out =
      held.states.empty()
          ? hold_out_in_turn(problem, fit.found, fitted, layout)
          : predict_held_out(fit, held, Model(all, held, parameters, side, answer, client), problem.start());
  fit.settings = values_of(parameters, fit.found.parameters, 10);
  fit.n_solves = problem.n_predicted() * fitted.states.size();
  return fit;
}

} // namespace springproof::compare
