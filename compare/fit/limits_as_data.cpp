#include "cases/case/error.hpp"
#include "compare/error_bars/convergence.hpp"
#include "compare/fit/fit.hpp"

#include <fmt/format.h>

namespace springproof::compare {

FitData limits_as_data(const FitCases& all, const AnswerQuestions& answer) {
  FitData data;
  std::vector<Question> questions;
  Request request{cases::Side::fem};
  request.meshes = 3;
  for (const bool is_held_out : {false, true})
    for (const std::string& file : is_held_out ? all.held_out : all.files) {
      data.states.push_back({file, {}, is_held_out});
      data.states.back().markers.push_back({"displacement", cases::measures::DisplacementFieldL2{}});
      questions.push_back({scene_of(all, data.states.back(), {}), request});
      const cases::Case& definition = questions.back().scene.definition;
      cases::refuse_network(definition, "--to limit", "give data");
      if (definition.dynamics)
        throw cases::InputError(file +
                                ": --to limit: the case is a motion, which has no limit of its field; give "
                                "data");
      if (definition.fem.real_time)
        throw cases::InputError(definition.fem.where, "real_time must be left out with --to limit");
      data.states.back().markers.clear();
    }
  const std::vector<Answers> answers = answer(questions);
  for (std::size_t q = 0; q < questions.size(); ++q) {
    const Answers& found = answers[q];
    const std::string& file = data.states[q].file;
    if (!found.fem.converged())
      throw cases::SolveError(file + ": the finite elements failed: " + found.fem.solution.message);
    if (!found.refined) throw cases::InputError(file + ": --to limit: there are no refined finite elements");
    const MeshStudy study =
        study_meshes(questions[q].scene, *found.refined, questions[q].scene.definition.fem.refine);
    if (!study.field)
      throw cases::InputError(
          fmt::format("{}: --to limit: the finite elements have none: {}; give data, or spread "
                      "the load over an area",
                      file, study.measures.back().no_reference));
    data.states[q].field = study.field->value;
  }
  return data;
}

} // namespace springproof::compare
