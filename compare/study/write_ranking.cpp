#include "compare/study/write_ranking.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/study/verdict.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// What the errors are against.
std::string reference_text(const Ranking& ranking) {
  const bool has_limit = std::any_of(ranking.designs.begin(), ranking.designs.end(),
                                     [](const Trial& r) { return r.worst_bar.has_value(); });
  return fmt::format("{}{} {}{}", has_limit ? "the limit of " : "",
                     cases::name_of(ranking.resolved.formulation), cases::name_of(ranking.resolved.element),
                     has_limit ? "" : " on the same mesh");
}

Json trial_to_json(const Trial& trial) {
  Json errors = Json::object();
  for (const MeasuredValue& measured : trial.measures) errors[measured.name] = measured.error_percent;
  const auto if_solved = [&](const auto& value) {
    return trial.refusal.empty() ? Json(value) : Json(nullptr);
  };
  return {{"design", trial.name},
          {"refused", text_or_null(trial.refusal)},
          {"failed", text_or_null(trial.failure)},
          {"worst_error_percent", trial.worst},
          {"worst_error_uncertainty_percent", trial.worst_bar},
          {"worst_at", text_or_null(trial.worst_at)},
          {"worst_volume_error_percent", trial.worst_volume},
          {"stable", if_solved(trial.is_stable)},
          {"has_moduli", trial.misfit ? Json(trial.has_moduli()) : Json(nullptr)},
          {"milliseconds", if_solved(trial.milliseconds)},
          {"milliseconds_a_step", trial.milliseconds_a_step},
          {"springs", text_or_null(trial.springs)},
          {"errors_percent", errors}};
}

void write_designs_table(std::ostream& out, const Ranking& ranking) {
  const Trial* best = ranking.recommended();
  const bool moves = std::any_of(ranking.designs.begin(), ranking.designs.end(),
                                 [](const Trial& r) { return r.milliseconds_a_step.has_value(); });
  Json rows = Json::array();
  for (const Trial& trial : ranking.designs) {
    if (!trial.worst) continue;
    rows.push_back(trial_to_json(trial));
    rows.back()["  design"] = (&trial == best ? "> " : "  ") + trial.name;
    rows.back()["worst %"] = worst_text(trial);
  }
  const Column time =
      moves ? Column{"ms a step", "milliseconds_a_step", "{:.1f}"} : Column{"ms", "milliseconds", "{:.1f}"};
  write_table(out,
              {{"  design"},
               {"worst %"},
               {"measure", "worst_at", "{:<}"},
               {"volume %", "worst_volume_error_percent", "{:.2f}"},
               {"stable"},
               {"moduli", "has_moduli"},
               time},
              rows);
}

} // namespace

void write_ranking_text(std::ostream& out, const Ranking& ranking) {
  write_wrapped(
      out,
      fmt::format("{}: designs by their worst error against {}", ranking.case_name, reference_text(ranking)),
      2);
  if (ranking.fem.converged()) write_designs_table(out, ranking);
  for (const Trial& ranked : ranking.designs)
    if (!ranked.worst)
      write_wrapped(out,
                    fmt::format("    {} {}: {}", ranked.name, ranked.refusal.empty() ? "failed" : "refused",
                                ranked.refusal.empty() ? ranked.failure : ranked.refusal),
                    6);
  if (ranking.recommended())
    write_wrapped(out, "  >: recommended; moduli: whether the lattice has those of the material", 4);
  write_expectations_text(out, ranking.gates);
  write_wrapped(out, advice_of(ranking), 2);
}

void write_ranking_csv(std::ostream& out, const std::vector<Ranking>& rankings) {
  Json rows = Json::array();
  for (const Ranking& ranking : rankings) {
    const Trial* best = ranking.recommended();
    for (const Trial& trial : ranking.designs) {
      rows.push_back(trial_to_json(trial));
      rows.back()["case"] = ranking.case_name;
      rows.back()["recommended"] = &trial == best;
    }
  }
  const std::string of_errors =
      "worst_error_percent worst_error_uncertainty_percent worst_at worst_volume_error_percent ";
  write_csv(out,
            columns_of("case design recommended " + of_errors +
                       "stable has_moduli milliseconds milliseconds_a_step springs refused failed"),
            rows);
}

Json ranking_to_json(const Ranking& ranking) {
  const Trial* best = ranking.recommended();
  return {{"name", ranking.case_name},
          {"fem",
           {{"formulation", cases::name_of(ranking.resolved.formulation)},
            {"element", cases::name_of(ranking.resolved.element)},
            {"status", cases::name_of(ranking.fem.solution.status)},
            {"message", ranking.fem.solution.message},
            {"milliseconds", 1e3 * ranking.fem.seconds()}}},
          {"reference", reference_text(ranking)},
          {"designs", json_list(ranking.designs, trial_to_json)},
          {"recommended", best ? Json(best->name) : Json(nullptr)},
          {"advice", advice_of(ranking)},
          {"expectations", expectations_to_json(ranking.gates)}};
}

Json rankings_to_json(const std::vector<Ranking>& rankings) {
  return {{"schema", 1}, {"cases", json_list(rankings, ranking_to_json)}};
}

void write_rankings(const std::string& folder, const std::vector<Ranking>& rankings) {
  write_file(folder + "/ranking.txt", [&](std::ostream& out) {
    for (const Ranking& ranking : rankings) write_ranking_text(out, ranking);
  });
  write_file(folder + "/ranking.csv", [&](std::ostream& out) { write_ranking_csv(out, rankings); });
  write_json_file(folder + "/ranking.json", rankings_to_json(rankings));
}

} // namespace springproof::compare
