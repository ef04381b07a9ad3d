#include "compare/ranking/ranking.hpp"

#include "cases/case/names.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/ranking/pace.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/springs.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

namespace springproof::compare {

namespace {

RankedDesign rank_one(const cases::Scene& scene, const Answers& fem) {
  RankedDesign ranked{cases::name_of(scene.definition.msm.design)};
  Answers answers = fem;
  try {
    check_memory(scene.definition.file, estimate(size_of(scene), {cases::Side::msm}), memory_limit());
    answers.msm = solve_springs(scene, 1, answers.design);
  } catch (const cases::InputError& error) {
    ranked.refusal = error.what();
    return ranked;
  }
  const Comparison comparison = comparison_of(scene, answers);
  ranked.is_sound = comparison.is_sound();
  ranked.gates = comparison.gates;
  const cases::Solution& solution = answers.msm.solution;
  ranked.milliseconds = 1e3 * answers.msm.seconds();
  ranked.milliseconds_a_step = milliseconds_a_step(answers.msm);
  if (answers.design) {
    ranked.springs = springs_text(*answers.design);
    if (answers.design->misfit) ranked.misfit = answers.design->misfit->largest;
  }
  if (!answers.msm.converged()) {
    ranked.failure = fmt::format("{} (reached: {:.2f} of the load)", solution.message, solution.load_reached);
    return ranked;
  }
  const bool is_settled = solution.trajectory || solution.outcome == cases::Outcome::stable_equilibrium;
  ranked.is_stable = is_settled && solution.inverted_cells == 0; // of a motion's end nobody asks
  ranked.measures = comparison.measures;
  add_errors(ranked, comparison);
  return ranked;
}

void check_measures(const cases::Scene& scene) {
  if (scene.definition.measures.empty())
    throw cases::InputError(scene.definition.file +
                            ": --designs ranks by the errors of measures, and the case "
                            "has no [[measure]]");
}

} // namespace

void add_errors(RankedDesign& ranked, const Comparison& comparison) {
  const std::vector<cases::Measure>& asked = comparison.scene.definition.measures;
  const bool has_others = std::any_of(asked.begin(), asked.end(), [](const cases::Measure& m) {
    return !cases::is<cases::measures::Volume>(m);
  });
  for (std::size_t m = 0; m < comparison.measures.size(); ++m) {
    const MeasuredValue& measured = comparison.measures[m];
    if (!measured.error_percent) continue;
    const double error = std::abs(*measured.error_percent);
    const bool is_volume = m < asked.size() && cases::is<cases::measures::Volume>(asked[m]);
    if (is_volume) ranked.worst_volume = std::max(ranked.worst_volume.value_or(0), error);
    if ((is_volume && has_others) || (ranked.worst && !(error > *ranked.worst))) continue;
    ranked.worst = error;
    ranked.worst_at = measured.name;
    ranked.worst_bar = measured.error_uncertainty_percent;
  }
  if (!ranked.worst) ranked.failure = "no measure has an error: the references are 0";
}

std::vector<const RankedDesign*> Ranking::best() const {
  std::vector<const RankedDesign*> found;
  for (const RankedDesign& ranked : designs) {
    if (!ranked.worst || !ranked.is_stable) continue;
    if (found.empty() || *ranked.worst - ranked.worst_bar.value_or(0) <
                             *found.front()->worst + found.front()->worst_bar.value_or(0))
      found.push_back(&ranked);
  }
  return found;
}

const RankedDesign* Ranking::recommended() const {
  const std::vector<const RankedDesign*> all = best();
  const auto place = [](const RankedDesign* ranked) {
    return std::tuple(!ranked->has_moduli(), ranked->milliseconds);
  };
  const auto first =
      std::min_element(all.begin(), all.end(),
                       [&](const RankedDesign* a, const RankedDesign* b) { return place(a) < place(b); });
  return first == all.end() ? nullptr : *first;
}

bool Ranking::is_sound() const {
  const bool has_answer =
      std::any_of(designs.begin(), designs.end(), [](const RankedDesign& r) { return r.worst.has_value(); });
  return fem.converged() && is_case_sound && has_answer;
}

void sort_by_error(std::vector<RankedDesign>& designs) {
  const auto place = [](const RankedDesign& ranked) {
    const int group = ranked.worst ? 0 : ranked.refusal.empty() ? 1 : 2;
    return std::tuple(group, ranked.worst.value_or(0));
  };
  std::stable_sort(designs.begin(), designs.end(),
                   [&](const RankedDesign& a, const RankedDesign& b) { return place(a) < place(b); });
}

Ranking rank_designs(const cases::Scene& scene, const std::vector<cases::Design>& designs, int meshes) {
  check_measures(scene);
  return rank_designs(scene, designs, gathered(solve(scene, {cases::Side::fem, meshes}, solve_fem)));
}

Ranking rank_designs(const cases::Scene& scene, const std::vector<cases::Design>& designs,
                     const Answers& fem) {
  check_measures(scene);
  Ranking ranking{scene.definition.name, fem.resolved, fem.fem};
  ranking.fem.solution.displacement.clear();
  ranking.fem.solution.cell_volume.clear();
  ranking.fem.solution.fields.reset();
  if (mpi_rank() != 0 || !fem.fem.converged()) return ranking;
  const Comparison without_designs = comparison_of(scene, fem);
  ranking.gates = without_designs.gates;
  ranking.is_case_sound = without_designs.is_sound();
  for (const cases::Design design : designs) {
    ranking.designs.push_back(rank_one(with_design(scene, design), fem));
    const RankedDesign& ranked = ranking.designs.back();
    if (design != scene.definition.msm.design) continue;
    ranking.is_case_sound = ranked.is_sound;
    if (ranked.refusal.empty()) ranking.gates = ranked.gates;
  }
  sort_by_error(ranking.designs);
  return ranking;
}

} // namespace springproof::compare
