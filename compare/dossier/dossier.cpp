#include "compare/dossier/dossier.hpp"

#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "cases/case/toml_table.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/peers/calculix.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

struct UncertainKey {
  std::string key;
  double deviation;
};

UncertainKey read_key(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto deviation = equals == std::string::npos
                             ? std::nullopt
                             : cases::number_in<double>(std::string_view(text).substr(equals + 1));
  if (equals == 0 || !deviation || *deviation <= 0)
    throw cases::InputError(
        fmt::format("--uncertain: is \"{}\", must be KEY=SIGMA, a key of the cases and its "
                    "standard uncertainty > 0: material.youngs_modulus=0.01",
                    text));
  return {text.substr(0, equals), *deviation};
}

std::string setting_of(const UncertainKey& key, double value) {
  return fmt::format("{}={:.17g}", key.key, value);
}

/// A case as it is solved with one key more or less: on the case's own mesh alone.
Question changed(const FitCases& all, const FitState& state, const UncertainKey& key, double value,
                 const cases::Fem& resolved) {
  cases::Scene scene = scene_of(all, state, {setting_of(key, value)});
  scene.definition.fem = resolved;
  scene.definition.fem.has_auto_formulation = scene.definition.fem.has_auto_accuracy = false;
  return {std::move(scene), {}};
}

double value_in_file(const FitCases& all, const FitState& state, const UncertainKey& key) {
  std::vector<std::string> settings = all.settings;
  settings.insert(settings.end(), state.settings.begin(), state.settings.end());
  const auto value = cases::parse_file(state.file, settings).at_path(key.key).value<double>();
  if (!value)
    throw cases::InputError(fmt::format(
        "--uncertain: {}: {} has no number there, must be a key with a number", key.key, state.file));
  return *value;
}

/// @throws InputError unless the case takes the key's value with one standard uncertainty less and more
void check_both_ends(const FitCases& all, const FitState& state, const UncertainKey& key) {
  const double value = value_in_file(all, state, key);
  for (const double sign : {-1., 1.}) {
    const double end = value + sign * key.deviation;
    try {
      scene_of(all, state, {setting_of(key, end)});
    } catch (const cases::InputError& error) {
      throw cases::InputError(fmt::format(
          "--uncertain: {}: is {:g} with the standard uncertainty {:g}, and {} does not take {:g} "
          "({}); give a smaller standard uncertainty",
          key.key, value, key.deviation, state.file, end, error.what()));
    }
  }
}

/// @throws InputError for data that a dossier has no place for
FitData read_measured(const DossierRequest& request) {
  if (request.measured.empty()) return {};
  FitData data = read_fit_data(cases::read_text_file(request.measured), request.measured, request.cases);
  for (const FitState& state : data.states)
    if (state.surface)
      throw cases::InputError(request.measured +
                              ": surface: is no datum of a dossier, must be a measure or a marker; fit takes "
                              "surfaces, so leave the column out here");
  return data;
}

std::vector<std::optional<double>> half_differences(const Question& less, const Answers& of_less,
                                                    const Question& more, const Answers& of_more,
                                                    cases::Side side) {
  std::vector<std::optional<double>> all;
  const auto solution = [&](const Answers& answers) -> const cases::Solution& {
    return (side == cases::Side::fem ? answers.fem : answers.msm).solution;
  };
  for (std::size_t m = 0; m < less.scene.definition.measures.size(); ++m) {
    all.emplace_back();
    if (solution(of_less).status != cases::Status::converged ||
        solution(of_more).status != cases::Status::converged)
      continue;
    const auto a = value_of(less.scene.definition.measures[m], less.scene, solution(of_less)),
               b = value_of(more.scene.definition.measures[m], more.scene, solution(of_more));
    if (a && b && std::isfinite(*a) && std::isfinite(*b)) all.back() = (*b - *a) / 2;
  }
  return all;
}

/// The states of the data after the cases as they are given, each once.
struct States {
  std::vector<FitState> all;              ///< the cases' first
  std::vector<std::size_t> of_data_state; ///< place in `all`
};

States states_of(const FitCases& cases, const FitData& data) {
  States states;
  for (const std::string& file : cases.files) states.all.push_back({file, {}, false});
  for (const FitState& state : data.states) {
    const auto found = std::find_if(states.all.begin(), states.all.end(), [&](const FitState& one) {
      return state.markers.empty() && state.settings.empty() && one.settings.empty() &&
             one.file == state.file;
    });
    states.of_data_state.push_back(static_cast<std::size_t>(found - states.all.begin()));
    if (found == states.all.end()) states.all.push_back(state);
  }
  return states;
}

void add_inputs(const DossierRequest& request, const std::vector<UncertainKey>& keys, const States& states,
                std::vector<StudiedCase>& studied, const AnswerQuestions& answer) {
  std::vector<Question> questions;
  for (std::size_t s = 0; s < studied.size(); ++s)
    for (const UncertainKey& key : keys)
      for (const double sign : {-1., 1.})
        questions.push_back(changed(request.cases, states.all[s], key,
                                    value_in_file(request.cases, states.all[s], key) + sign * key.deviation,
                                    studied[s].comparison.answers.resolved));
  const std::vector<Answers> answers = answer(questions);
  std::size_t q = 0;
  for (std::size_t s = 0; s < studied.size(); ++s)
    for (const UncertainKey& key : keys) {
      InputEffect effect{key.key, value_in_file(request.cases, states.all[s], key), key.deviation, {}, {}};
      effect.fem =
          half_differences(questions[q], answers[q], questions[q + 1], answers[q + 1], cases::Side::fem);
      effect.msm =
          half_differences(questions[q], answers[q], questions[q + 1], answers[q + 1], cases::Side::msm);
      for (const Answers& one : {answers[q], answers[q + 1]})
        for (const Answer* side : {&one.fem, &one.msm})
          if (!side->converged() && effect.reason.empty()) effect.reason = side->solution.message;
      q += 2;
      studied[s].inputs.push_back(std::move(effect));
    }
}

std::vector<Question> questions_of(const DossierRequest& request, const States& states) {
  // Reads the cases as every command does, with its checks of memory.
  Request asked;
  asked.meshes = request.meshes;
  std::vector<Question> questions = read_questions(request.cases.files, request.cases.settings, asked);
  for (std::size_t s = questions.size(); s < states.all.size(); ++s)
    questions.push_back({scene_of(request.cases, states.all[s]), asked});
  for (Question& question : questions) {
    cases::refuse_network(question.scene.definition, "a dossier", "run tells the error itself");
    question.scene.definition.has_fields = true; // strains, for how far the case goes
  }
  return questions;
}

} // namespace

bool Dossier::is_sound() const {
  const auto is_case_sound = [](const StudiedCase& one) { return one.comparison.is_sound(); };
  return all_met(code.cases) && std::all_of(cases.begin(), cases.end(), is_case_sound);
}

Dossier make_dossier(const DossierRequest& request, const AnswerQuestions& answer,
                     const AnswerQuestions& answer_own) {
  Dossier dossier{request.context, request.cases.settings, {}, {}, {}, !request.uncertain.empty()};
  const FitData data = read_measured(request);
  const States states = states_of(request.cases, data);
  std::vector<Question> questions = questions_of(request, states);
  std::vector<UncertainKey> keys;
  for (const std::string& text : request.uncertain) {
    UncertainKey key = read_key(text);
    for (const UncertainKey& other : keys)
      if (other.key == key.key)
        throw cases::InputError(
            fmt::format("--uncertain: {}: is there twice, must be named once with one deviation", key.key));
    keys.push_back(std::move(key));
    for (const FitState& state : states.all) check_both_ends(request.cases, state, keys.back());
  }
  dossier.code = verify_code(request.own_files, answer_own);
  std::vector<Answers> answers = answer(questions);
  const auto asks = [&](const char* peer) { return cases::contains(request.peers, peer); };
  for (std::size_t q = 0; q < questions.size(); ++q) {
    cases::Scene& scene = questions[q].scene;
    const bool is_given = q < request.cases.files.size();
    if (is_given && asks("ccx"))
      answers[q].peer = ask_calculix(with_fem(scene, answers[q].resolved), answers[q].fem);
    StudiedCase studied{comparison_of(std::move(scene), std::move(answers[q])), {}};
    studied.budgets = study_errors(studied.comparison, questions[q].request);
    if (is_given && asks("getfem")) studied.second_code = study_by_getfem(studied.comparison);
    dossier.cases.push_back(std::move(studied));
  }
  if (!keys.empty()) add_inputs(request, keys, states, dossier.cases, answer);
  if (!request.measured.empty()) {
    std::vector<const StudiedCase*> of_state;
    for (const std::size_t s : states.of_data_state) of_state.push_back(&dossier.cases[s]);
    dossier.validation = validate(request.measured, data, of_state);
  }
  dossier.cases.erase(dossier.cases.begin() + static_cast<std::ptrdiff_t>(request.cases.files.size()),
                      dossier.cases.end());
  return dossier;
}

} // namespace springproof::compare
