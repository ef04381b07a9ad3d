#include "compare/ranking/ranking.hpp"

#include "cases/case/names.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/springs.hpp"
#include "compare/write/springs_text.hpp"
#include "compare/write/write_gates.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

namespace springproof::compare {

namespace {

/// Worst errors of the measures that have one.
void add_errors(RankedDesign& ranked, const Comparison& comparison) {
  const std::vector<cases::Measure>& asked = comparison.scene.definition.measures;
  const bool has_others = std::any_of(asked.begin(), asked.end(), [](const cases::Measure& m) {
    return m.kind != cases::MeasureKind::volume;
  });
  for (std::size_t m = 0; m < comparison.measures.size(); ++m) {
    const MeasuredValue& measured = comparison.measures[m];
    if (!measured.error_percent) continue;
    const double error = std::abs(*measured.error_percent);
    const bool is_volume = m < asked.size() && asked[m].kind == cases::MeasureKind::volume;
    if (is_volume) ranked.worst_volume = std::max(ranked.worst_volume.value_or(0), error);
    if ((is_volume && has_others) || (ranked.worst && !(error > *ranked.worst))) continue;
    ranked.worst = error;
    ranked.worst_at = measured.name;
    ranked.worst_bar = measured.error_uncertainty_percent;
  }
  if (!ranked.worst) ranked.failure = "no measure has an error: the references are 0";
}

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
  ranked.gates = comparison.gates;
  const cases::Solution& solution = answers.msm.solution;
  ranked.milliseconds = 1e3 * answers.msm.seconds();
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

std::string two_digits(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

std::string worst_text(const RankedDesign& ranked) {
  return two_digits(ranked.worst) + (ranked.worst_bar ? fmt::format(" +- {:.2g}", *ranked.worst_bar) : "");
}

void check_measures(const cases::Scene& scene) {
  if (scene.definition.measures.empty())
    throw cases::InputError(scene.definition.file +
                            ": --designs ranks by the errors of measures, and the case "
                            "has no [[measure]]");
}

/// What the errors are against.
std::string reference_text(const Ranking& ranking) {
  const bool has_limit = std::any_of(ranking.designs.begin(), ranking.designs.end(),
                                     [](const RankedDesign& r) { return r.worst_bar.has_value(); });
  return fmt::format("{}{} {}{}", has_limit ? "the limit of " : "",
                     cases::name_of(ranking.resolved.formulation), cases::name_of(ranking.resolved.element),
                     has_limit ? "" : " on the same mesh");
}

/// The finite elements' own error on the mesh of the springs, after "which": the largest that there may be,
/// of the measures whose limit is known. What has no limit is unknown, whatever another measure's error.
std::string error_of_fem_text(const RankedDesign& ranked) {
  std::size_t n = 0, n_known = 0;
  double worst = 0, bar = 0;
  for (const MeasuredValue& measured : ranked.measures) {
    if (!measured.fem) continue;
    ++n;
    if (!measured.fem_error_percent || !measured.fem_limit) continue;
    const double error = std::abs(*measured.fem_error_percent);
    const double own = 100 * measured.fem_limit->uncertainty / std::abs(measured.fem_limit->value);
    if (n_known++ > 0 && !(error + own > worst + bar)) continue;
    worst = error;
    bar = own;
  }
  if (n_known == 0) return "whose own error on this mesh is not known";
  return fmt::format("which themselves err by up to {:.2f} +- {:.2g} % on this mesh{}", worst, bar,
                     n_known < n ? fmt::format(" in the {} of {} measures whose limit is known", n_known, n)
                                 : "");
}

bool has_moduli(const RankedDesign& ranked) {
  return ranked.misfit && *ranked.misfit <= msm::told_moduli_misfit;
}

/// What the reference's uncertainty does not tell from the smallest error, and what speaks for the
/// recommended design.  @param all  Ranking::best()
std::string others_text(const std::vector<const RankedDesign*>& all, const RankedDesign& own) {
  if (all.size() < 2) return "";
  std::vector<std::string> names, without_moduli;
  std::size_t n_alike = 0;
  for (const RankedDesign* one : all) {
    if (one != all.front()) names.push_back(one->name);
    if (has_moduli(*one) == has_moduli(own))
      ++n_alike;
    else
      without_moduli.push_back(one->name);
  }
  std::vector<std::string> reasons;
  if (!without_moduli.empty())
    reasons.push_back(fmt::format("the lattice of {} has the material's moduli, unlike that of {}", own.name,
                                  fmt::join(without_moduli, ", ")));
  if (n_alike > 1)
    reasons.push_back(
        fmt::format("{} is the fastest of {}", own.name, without_moduli.empty() ? "them" : "the rest"));
  return fmt::format(" The uncertainty of the reference does not tell {} from {}: {}.",
                     &own == all.front() ? "it" : "the smallest error, of " + all.front()->name + ",",
                     fmt::join(names, ", "), fmt::join(reasons, ", and "));
}

} // namespace

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
    return std::tuple(!has_moduli(*ranked), ranked->milliseconds);
  };
  const auto first =
      std::min_element(all.begin(), all.end(),
                       [&](const RankedDesign* a, const RankedDesign* b) { return place(a) < place(b); });
  return first == all.end() ? nullptr : *first;
}

bool Ranking::is_sound() const {
  return recommended() && std::all_of(gates.begin(), gates.end(),
                                      [](const Gate& gate) { return gate.met() || gate.is_left_out; });
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
  for (const cases::Design design : designs) {
    ranking.designs.push_back(rank_one(with_design(scene, design), fem));
    if (design == scene.definition.msm.design) ranking.gates = ranking.designs.back().gates;
  }
  if (ranking.gates.empty()) ranking.gates = comparison_of(scene, fem).gates;
  sort_by_error(ranking.designs);
  return ranking;
}

std::string verdict_of(const Comparison& comparison) {
  const Answers& answers = comparison.answers;
  for (const auto& [name, side] :
       {std::pair("finite elements", &answers.fem), std::pair("springs", &answers.msm)}) {
    if (side->solution.status == cases::Status::failed)
      return "There is nothing to compare: " + side->solution.message; // which names the model
    if (side->solution.status == cases::Status::skipped)
      return fmt::format("There is nothing to compare: the {} were not solved.", name);
  }
  if (comparison.measures.empty()) return "Both models are in equilibrium; the case has no measure.";
  RankedDesign own{cases::name_of(comparison.scene.definition.msm.design)};
  own.measures = comparison.measures;
  add_errors(own, comparison);
  if (!own.worst) return "Both models are in equilibrium; " + own.failure + ".";
  return fmt::format("The springs err by up to {} % ({}){} against {}, {}.", worst_text(own), own.worst_at,
                     own.worst_volume ? fmt::format(", in volume by up to {} %", two_digits(own.worst_volume))
                                      : "",
                     own.worst_bar ? "the limit of the finite elements" : "finite elements on the same mesh",
                     error_of_fem_text(own));
}

std::string advice_of(const Ranking& ranking) {
  if (!ranking.fem.converged())
    return fmt::format("There is no reference: finite elements: {}", ranking.fem.solution.message);
  const RankedDesign* best = ranking.recommended();
  if (!best) return "No design has a stable equilibrium under the whole load here.";
  const double milliseconds = 1e3 * ranking.fem.seconds();
  return fmt::format(
      "Use {} here: errors up to {} % ({}){}, stable, in {:.1f} ms, {} than the {:.1f} ms of the finite "
      "elements, {}.{}{}",
      best->name, worst_text(*best), best->worst_at,
      best->worst_volume ? fmt::format(", volume within {} %", two_digits(best->worst_volume)) : "",
      best->milliseconds, best->milliseconds < milliseconds ? "less" : "not less", milliseconds,
      error_of_fem_text(*best), others_text(ranking.best(), *best),
      has_moduli(*best) || !best->misfit ? ""
                                         : " Its lattice has other moduli than the material's: what it errs "
                                           "by elsewhere is another matter.");
}

void write_ranking_text(std::ostream& out, const Ranking& ranking) {
  print(out, "{}: designs by their worst error against {}\n", ranking.case_name, reference_text(ranking));
  print(out, "  {:<17}{:>14}  {:<12}{:>9}{:>8}{:>8}{:>9}  {}\n", "design", "worst %", "where", "volume %",
        "stable", "moduli", "ms", "springs");
  const RankedDesign* best = ranking.recommended();
  for (const RankedDesign& ranked : ranking.designs)
    if (ranked.worst)
      print(out, "{} {:<17}{:>14}  {:<12}{:>9}{:>8}{:>8}{:>9.1f}  {}\n", &ranked == best ? ">" : " ",
            ranked.name, worst_text(ranked), ranked.worst_at, two_digits(ranked.worst_volume),
            ranked.is_stable ? "yes" : "NO",
            !ranked.misfit       ? "-"
            : has_moduli(ranked) ? "yes"
                                 : "NO",
            ranked.milliseconds, ranked.springs);
    else
      print(out, "  {:<17}{}: {}\n", ranked.name, ranked.refusal.empty() ? "failed" : "refused",
            ranked.refusal.empty() ? ranked.failure : ranked.refusal);
  print(out, "  {}\n", advice_of(ranking));
  write_expectations_text(out, ranking.gates);
}

nlohmann::ordered_json ranking_to_json(const Ranking& ranking) {
  using Json = nlohmann::ordered_json;
  const auto text_or_null = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); };
  Json designs = Json::array();
  for (const RankedDesign& ranked : ranking.designs) {
    Json errors = Json::object();
    for (const MeasuredValue& measured : ranked.measures) errors[measured.name] = measured.error_percent;
    const bool is_solved = ranked.refusal.empty();
    designs.push_back({{"design", ranked.name},
                       {"refused", text_or_null(ranked.refusal)},
                       {"failed", text_or_null(ranked.failure)},
                       {"worst_error_percent", ranked.worst},
                       {"worst_error_uncertainty_percent", ranked.worst_bar},
                       {"worst_at", text_or_null(ranked.worst_at)},
                       {"worst_volume_error_percent", ranked.worst_volume},
                       {"stable", is_solved ? Json(ranked.is_stable) : Json(nullptr)},
                       {"has_moduli", ranked.misfit ? Json(has_moduli(ranked)) : Json(nullptr)},
                       {"milliseconds", is_solved ? Json(ranked.milliseconds) : Json(nullptr)},
                       {"springs", text_or_null(ranked.springs)},
                       {"errors_percent", errors}});
  }
  const RankedDesign* best = ranking.recommended();
  return {{"name", ranking.case_name},
          {"fem",
           {{"formulation", cases::name_of(ranking.resolved.formulation)},
            {"element", cases::name_of(ranking.resolved.element)},
            {"status", cases::name_of(ranking.fem.solution.status)},
            {"message", ranking.fem.solution.message},
            {"milliseconds", 1e3 * ranking.fem.seconds()}}},
          {"reference", reference_text(ranking)},
          {"designs", designs},
          {"recommended", best ? Json(best->name) : Json(nullptr)},
          {"advice", advice_of(ranking)},
          {"expectations", expectations_to_json(ranking.gates)}};
}

} // namespace springproof::compare
