#include "compare/study/study.hpp"

#include "cases/case/names.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/springs.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <tuple>

namespace springproof::compare {

namespace {

void check_measures(const cases::Scene& scene) {
  cases::refuse_network(scene.definition, "other designs", "run without --designs solves its own springs");
  if (scene.definition.measures.empty())
    throw cases::InputError(scene.definition.file +
                            ": --designs ranks by the errors of measures, and the case "
                            "has no [[measure]]");
}

void add_errors(Trial& trial, const Comparison& comparison) {
  const std::vector<cases::Measure>& asked = comparison.scene.definition.measures;
  const auto is_volume = [](const cases::Measure& m) { return cases::is<cases::measures::Volume>(m); };
  const bool has_others = !std::all_of(asked.begin(), asked.end(), is_volume);
  WorstError errors, volumes;
  for (std::size_t m = 0; m < trial.measures.size(); ++m) {
    const auto& error = trial.measures[m].error_percent;
    const bool is_of_volume = m < asked.size() && is_volume(asked[m]);
    if (error && is_of_volume) volumes.add(*error);
    if (error && !(is_of_volume && has_others)) errors.add(*error, m);
  }
  trial.worst = errors.worst;
  trial.worst_volume = volumes.worst;
  if (errors.worst) {
    trial.worst_at = trial.measures[errors.place].name;
    trial.worst_bar = trial.measures[errors.place].error_uncertainty_percent;
  } else {
    trial.failure = "no measure has an error: the references are 0";
  }
}

std::vector<Standing> standings_of(const std::vector<Trial>& trials) {
  std::vector<Standing> all;
  for (const Trial& trial : trials)
    all.push_back({trial.is_stable ? trial.worst : std::nullopt, trial.worst_bar.value_or(0),
                   trial.has_moduli(), trial.milliseconds});
  return all;
}

} // namespace

bool is_stable(const cases::Solution& springs) {
  const bool has_moved = springs.trajectory || (springs.from_equilibrium && springs.from_equilibrium->rest);
  return springs.status == cases::Status::converged && springs.inverted_cells == 0 &&
         (has_moved || springs.outcome == cases::Outcome::stable_equilibrium);
}

std::optional<double> milliseconds_a_step(const Answer& answer) {
  const auto& motion = answer.solution.trajectory;
  const auto& from = answer.solution.from_equilibrium;
  if (answer.converged() && from && from->rest)
    return 1e3 * answer.solve_seconds / static_cast<double>(from->rest->steps);
  if (!answer.converged() || !motion || motion->time.size() < 2) return std::nullopt;
  return 1e3 * answer.solve_seconds / static_cast<double>(motion->time.size() - 1);
}

Trial trial_of(const Comparison& comparison) {
  const Answer& springs = comparison.answers.msm;
  Trial trial{cases::name_of(comparison.scene.definition.msm.design)};
  trial.is_sound = comparison.is_sound();
  trial.gates = comparison.gates;
  trial.milliseconds = 1e3 * springs.seconds();
  trial.milliseconds_a_step = milliseconds_a_step(springs);
  if (const auto& design = comparison.answers.design) {
    trial.springs = springs_text(*design);
    if (design->misfit) trial.misfit = design->misfit->largest;
  }
  if (!springs.converged()) {
    trial.failure = fmt::format("{} (reached: {:.2f} of the load)", springs.solution.message,
                                springs.solution.load_reached);
    return trial;
  }
  trial.is_stable = is_stable(springs.solution);
  trial.measures = comparison.measures;
  add_errors(trial, comparison);
  return trial;
}

Comparison compare_sides(cases::Scene scene, const Answers& fem, const Answers& springs) {
  Answers both = fem;
  both.msm = springs.msm;
  both.design = springs.design;
  return comparison_of(std::move(scene), std::move(both));
}

Answers solve_reference(const cases::Scene& scene, int meshes) {
  if (scene.definition.fem.real_time)
    throw cases::InputError(scene.definition.fem.where,
                            "real_time must be left out here: springs and programs are held against solved "
                            "finite elements; run has elements that are stepped");
  return gathered(solve(scene, {cases::Side::fem, meshes}, solve_fem));
}

Comparison try_springs(const cases::Scene& scene, const Answers& fem) {
  check_memory(scene.definition.file, estimate(size_of(scene), {cases::Side::msm}), memory_limit());
  Answers springs;
  springs.msm = solve_springs(scene, 1, springs.design);
  return compare_sides(scene, fem, springs);
}

std::vector<std::size_t> best_of(const std::vector<Standing>& trials) {
  std::vector<std::size_t> order;
  for (std::size_t t = 0; t < trials.size(); ++t)
    if (trials[t].worst) order.push_back(t);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return *trials[a].worst < *trials[b].worst; });
  if (order.empty()) return order;
  const double reach = *trials[order.front()].worst + trials[order.front()].bar;
  const auto is_beyond = [&](std::size_t t) { return !(*trials[t].worst - trials[t].bar < reach); };
  order.erase(std::remove_if(order.begin() + 1, order.end(), is_beyond), order.end());
  return order;
}

std::optional<std::size_t> recommended_of(const std::vector<Standing>& trials) {
  const std::vector<std::size_t> best = best_of(trials);
  const auto place = [&](std::size_t t) { return std::tuple(!trials[t].has_moduli, trials[t].milliseconds); };
  const auto first = std::min_element(best.begin(), best.end(),
                                      [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  return first == best.end() ? std::nullopt : std::optional(*first);
}

std::vector<const Trial*> Ranking::best() const {
  std::vector<const Trial*> found;
  for (const std::size_t t : best_of(standings_of(designs))) found.push_back(&designs[t]);
  return found;
}

const Trial* Ranking::recommended() const {
  const auto found = recommended_of(standings_of(designs));
  return found ? &designs[*found] : nullptr;
}

bool Ranking::is_sound() const {
  const bool has_answer =
      std::any_of(designs.begin(), designs.end(), [](const Trial& trial) { return trial.worst.has_value(); });
  return fem.converged() && is_case_sound && has_answer;
}

void sort_by_error(std::vector<Trial>& designs) {
  const auto place = [](const Trial& trial) {
    const int group = trial.worst ? 0 : trial.refusal.empty() ? 1 : 2;
    return std::tuple(group, trial.worst.value_or(0));
  };
  std::stable_sort(designs.begin(), designs.end(),
                   [&](const Trial& a, const Trial& b) { return place(a) < place(b); });
}

Ranking rank_designs(const cases::Scene& scene, const std::vector<cases::Design>& designs, int meshes) {
  check_measures(scene);
  return rank_designs(scene, designs, solve_reference(scene, meshes));
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
    Trial trial{cases::name_of(design)};
    try {
      trial = trial_of(try_springs(with_design(scene, design), fem));
    } catch (const cases::InputError& error) {
      trial.refusal = error.what();
    }
    if (design == scene.definition.msm.design) {
      ranking.is_case_sound = trial.is_sound;
      if (trial.refusal.empty()) ranking.gates = trial.gates;
    }
    ranking.designs.push_back(std::move(trial));
  }
  sort_by_error(ranking.designs);
  return ranking;
}

} // namespace springproof::compare
