#include "compare/ranking/write_ranking.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/ranking/advice.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// What the errors are against.
std::string reference_text(const Ranking& ranking) {
  const bool has_limit = std::any_of(ranking.designs.begin(), ranking.designs.end(),
                                     [](const RankedDesign& r) { return r.worst_bar.has_value(); });
  return fmt::format("{}{} {}{}", has_limit ? "the limit of " : "",
                     cases::name_of(ranking.resolved.formulation), cases::name_of(ranking.resolved.element),
                     has_limit ? "" : " on the same mesh");
}

std::string moduli_text(const RankedDesign& ranked) {
  if (!ranked.misfit) return "-";
  return ranked.has_moduli() ? "yes" : "no";
}

void write_table(std::ostream& out, const Ranking& ranking) {
  const RankedDesign* best = ranking.recommended();
  const bool moves = std::any_of(ranking.designs.begin(), ranking.designs.end(),
                                 [](const RankedDesign& r) { return r.milliseconds_a_step.has_value(); });
  TextTable table({{"  design"},
                   {"worst %"},
                   {"measure", "", "{:<}"},
                   {"volume %"},
                   {"stable"},
                   {"moduli"},
                   {moves ? "ms a step" : "ms"}});
  for (const RankedDesign& ranked : ranking.designs)
    if (ranked.worst)
      table.add({(&ranked == best ? "> " : "  ") + ranked.name, worst_text(ranked), ranked.worst_at,
                 two_digits(ranked.worst_volume), ranked.is_stable ? "yes" : "no", moduli_text(ranked),
                 fmt::format("{:.1f}", ranked.milliseconds_a_step.value_or(ranked.milliseconds))});
  table.write(out);
}

} // namespace

void write_ranking_text(std::ostream& out, const Ranking& ranking) {
  write_wrapped(
      out,
      fmt::format("{}: designs by their worst error against {}", ranking.case_name, reference_text(ranking)),
      2);
  if (ranking.fem.converged()) write_table(out, ranking);
  for (const RankedDesign& ranked : ranking.designs)
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
  CsvWriter csv(out, 10);
  csv.row("case", "design", "recommended", "worst_error_percent", "worst_error_uncertainty_percent",
          "worst_at", "worst_volume_error_percent", "stable", "has_moduli", "milliseconds",
          "milliseconds_a_step", "springs", "refused", "failed");
  for (const Ranking& ranking : rankings)
    for (const RankedDesign& ranked : ranking.designs) {
      const bool is_solved = ranked.refusal.empty();
      const auto if_solved = [&](const auto& value) {
        return is_solved ? std::optional(value) : std::nullopt;
      };
      csv.row(ranking.case_name, ranked.name, &ranked == ranking.recommended() ? 1 : 0, ranked.worst,
              ranked.worst_bar, ranked.worst_at, ranked.worst_volume, if_solved(ranked.is_stable ? 1 : 0),
              ranked.misfit ? std::optional(ranked.has_moduli() ? 1 : 0) : std::nullopt,
              if_solved(ranked.milliseconds), ranked.milliseconds_a_step, ranked.springs, ranked.refusal,
              ranked.failure);
    }
}

nlohmann::ordered_json ranking_to_json(const Ranking& ranking) {
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
                       {"has_moduli", ranked.misfit ? Json(ranked.has_moduli()) : Json(nullptr)},
                       {"milliseconds", is_solved ? Json(ranked.milliseconds) : Json(nullptr)},
                       {"milliseconds_a_step", ranked.milliseconds_a_step},
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

nlohmann::ordered_json rankings_to_json(const std::vector<Ranking>& rankings) {
  nlohmann::ordered_json document{{"schema", 1}, {"cases", nlohmann::ordered_json::array()}};
  for (const Ranking& ranking : rankings) document["cases"].push_back(ranking_to_json(ranking));
  return document;
}

void write_rankings(const std::string& folder, const std::vector<Ranking>& rankings) {
  write_file(folder + "/ranking.txt", [&](std::ostream& out) {
    for (const Ranking& ranking : rankings) write_ranking_text(out, ranking);
  });
  write_file(folder + "/ranking.csv", [&](std::ostream& out) { write_ranking_csv(out, rankings); });
  write_file(folder + "/ranking.json",
             [&](std::ostream& out) { out << json_text(rankings_to_json(rankings)); });
}

} // namespace springproof::compare
