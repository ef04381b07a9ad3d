#include "compare/study/write_study.hpp"

#include "cases/case/names.hpp"
#include "compare/measure/measure.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace springproof::compare {

namespace {

/// "2.31", or "-" without a value.
std::string two_digits(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

/// "2.31 +- 0.4": the worst error with what the reference's uncertainty leaves of it.
std::string worst_text(const Trial& ranked) {
  return two_digits(ranked.worst) + (ranked.worst_bar ? fmt::format(" +- {:.2g}", *ranked.worst_bar) : "");
}

/// The finite elements' own error on the mesh of the springs: the largest that there may be, of the measures
/// whose limit is known. What has no limit is unknown, whatever another measure's error.
struct ErrorOfFem {
  double worst = 0, bar = 0;      ///< percent, points
  std::size_t n = 0, n_known = 0; ///< measures, and those whose limit is known
};

/// Nothing where no limit is known.
std::optional<ErrorOfFem> error_of_fem(const Trial& ranked) {
  ErrorOfFem found;
  for (const MeasuredValue& measured : ranked.measures) {
    if (!measured.fem) continue;
    ++found.n;
    if (!measured.fem_error_percent || !measured.fem_limit) continue;
    const double error = std::abs(*measured.fem_error_percent);
    const double bar = 100 * measured.fem_limit->uncertainty / std::abs(measured.fem_limit->value);
    if (found.n_known++ > 0 && !(error + bar > found.worst + found.bar)) continue;
    found.worst = error;
    found.bar = bar;
  }
  return found.n_known > 0 ? std::optional(found) : std::nullopt;
}

/// The same as a clause about the finite elements, "which ..." or "whose ...".
std::string error_of_fem_text(const Trial& ranked) {
  const auto found = error_of_fem(ranked);
  if (!found) return "whose own error on this mesh is not known";
  return fmt::format("which themselves err by up to {:.2f} +- {:.2g} % on this mesh{}", found->worst,
                     found->bar,
                     found->n_known < found->n ? fmt::format(" in the {} of {} measures whose limit is known",
                                                             found->n_known, found->n)
                                               : "");
}

/// What the reference's uncertainty does not tell from the smallest error, and what speaks for the
/// recommended design.  @param all  Ranking::best()
std::string others_text(const std::vector<const Trial*>& all, const Trial& own) {
  if (all.size() < 2) return "";
  std::vector<std::string> names, without_moduli;
  std::size_t n_alike = 0;
  for (const Trial* one : all) {
    if (one != all.front()) names.push_back(one->name);
    if (one->has_moduli() == own.has_moduli())
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

/// "8.1 ms a step: keeps 60 Hz".
std::string pace_text(double milliseconds_a_step) {
  return fmt::format("{:.2g} ms a step: {} 60 Hz", milliseconds_a_step,
                     milliseconds_a_step <= milliseconds_a_picture ? "keeps" : "does not keep");
}

/// How both models ended, for a case without errors.
std::string end_of(const Answers& answers) {
  if (answers.fem.solution.trajectory) return "Both models moved to the end";
  if (const auto& from = answers.msm.solution.from_equilibrium; from && from->rest)
    return "The springs came to rest";
  if (!answers.msm.solution.is_equilibrium()) return "The springs were stopped before their equilibrium";
  return "Both models are in equilibrium";
}

std::string worst_measure_text(const Trial& own, const Comparison& comparison) {
  const MeasuredValue* worst = find_named(comparison.measures, own.worst_at);
  return own.worst_at +
         (worst && is_norm(*worst, comparison.scene.definition) ? ", norm of the difference" : "");
}

/// The springs' seconds next to the finite elements'.
std::string ratio_text(double springs, double fem) {
  const auto times = [](double ratio) { return fmt::format("{:.{}f}", ratio, ratio < 9.95 ? 1 : 0); };
  if (springs <= fem) return fmt::format("the springs are {} times as fast", times(fem / springs));
  return fmt::format("the finite elements are {} times as fast", times(springs / fem));
}

/// Which of the two the error is of, as far as the numbers tell.
std::string mesh_text(const Trial& own) {
  const auto fem = error_of_fem(own);
  if (!own.worst || !own.worst_bar || !fem) return "";
  if (fem->worst - fem->bar > *own.worst + *own.worst_bar)
    return " They err less than the finite elements on this mesh do: a finer one shows what error is the "
           "springs' own.";
  if (fem->worst + fem->bar < *own.worst - *own.worst_bar)
    return " The springs err more than their mesh does.";
  return " The numbers do not tell the springs' error from their mesh's: refine it before you judge them.";
}

std::string missed_text(const std::vector<Gate>& gates) {
  const auto n = std::count_if(gates.begin(), gates.end(),
                               [](const Gate& gate) { return !gate.met() && !gate.is_left_out; });
  if (n == 0) return "";
  return fmt::format(" {} of {} expectations {} not met.", n, gates.size(), n == 1 ? "is" : "are");
}

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
  const std::string columns =
      "~~design worst~% measure=worst_at{:<} volume~%=worst_volume_error_percent{:.2f} "
      "stable moduli=has_moduli ";
  write_table(out,
              columns_of(columns + (moves ? "ms~a~step=milliseconds_a_step{:.1f}" : "ms=milliseconds{:.1f}")),
              rows);
}

} // namespace

std::string advice_of(const Ranking& ranking) {
  if (!ranking.fem.converged())
    return fmt::format("There is no reference: finite elements: {}", ranking.fem.solution.message);
  const Trial* best = ranking.recommended();
  if (!best) return "No design has a stable equilibrium under the whole load here.";
  const double milliseconds = 1e3 * ranking.fem.seconds();
  return fmt::format("Use {} here: errors up to {} % ({}){}, stable, in {:.1f} ms, {} than the {:.1f} ms of "
                     "the finite "
                     "elements, {}.{}{}",
                     best->name, worst_text(*best), best->worst_at,
                     best->worst_volume ? fmt::format(", volume within {} %", two_digits(best->worst_volume))
                                        : "",
                     best->milliseconds, best->milliseconds < milliseconds ? "less" : "not less",
                     milliseconds, error_of_fem_text(*best), others_text(ranking.best(), *best),
                     best->has_moduli() || !best->misfit
                         ? ""
                         : " Its lattice has other moduli than the material's: what it errs "
                           "by elsewhere is another matter.") +
         (best->milliseconds_a_step ? " It takes " + pace_text(*best->milliseconds_a_step) + "." : "");
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
  if (comparison.measures.empty()) return end_of(answers) + "; the case has no measure.";
  const Trial own = trial_of(comparison);
  if (!own.worst) return end_of(answers) + "; " + own.failure + ".";
  return fmt::format(
      "The springs are up to {} % ({}){} from {}, {}.{}", worst_text(own),
      worst_measure_text(own, comparison),
      own.worst_volume ? fmt::format(", in volume up to {} %,", two_digits(own.worst_volume)) : "",
      own.worst_bar ? "the truth, the limit of the finite elements" : "the finite elements on the same mesh",
      error_of_fem_text(own), mesh_text(own));
}

std::string time_of(const Comparison& comparison) {
  const Answers& answers = comparison.answers;
  std::vector<std::string> times;
  bool is_motion = false;
  for (const auto& [name, side] :
       {std::pair("the springs", &answers.msm), std::pair("the finite elements", &answers.fem)}) {
    const bool is_given = side == &answers.msm && !answers.msm_source.empty();
    if (!side->converged() || is_given) continue;
    const auto a_step = milliseconds_a_step(*side);
    is_motion = is_motion || a_step;
    times.push_back(name + (a_step ? " " + pace_text(*a_step) : fmt::format(" {:.2g} s", side->seconds())));
  }
  if (times.empty()) return "";
  const bool has_ratio =
      times.size() == 2 && !is_motion && answers.msm.seconds() > 0 && answers.fem.seconds() > 0;
  return fmt::format("Time: {}{}.", fmt::join(times, "; "),
                     has_ratio ? "; " + ratio_text(answers.msm.seconds(), answers.fem.seconds()) : "");
}

void write_next_commands(std::ostream& out, const std::vector<NextCommand>& next) {
  if (!next.empty()) print(out, "What to type next:\n");
  for (const auto& [line, what] : next) {
    const std::string text = "  " + line, comment = "# " + what;
    if (n_characters(text) + 3 + n_characters(comment) <= screen_width)
      print(out, "{}   {}\n", text, comment);
    else
      print(out, "  {}\n{}\n", comment, text);
  }
}

void write_verdict_text(std::ostream& out, const Comparison& comparison,
                        const std::vector<NextCommand>& next) {
  std::string text = "Verdict: " + verdict_of(comparison);
  if (text.back() != '.') text += "."; // behind a solver's message
  text += missed_text(comparison.gates);
  if (!comparison.doubts().empty()) text += " The answer is in doubt, as said above.";
  if (const std::string time = time_of(comparison); !time.empty()) text += " " + time;
  write_wrapped(out, text, 2);
  write_next_commands(out, next);
}

namespace {

/// Why designs have no error, those with one reason together.
void write_reasons(std::ostream& out, const std::vector<Trial>& designs) {
  std::vector<std::pair<std::string, std::string>> names; // those with each reason
  for (const Trial& trial : designs) {
    if (trial.worst) continue;
    const std::string reason =
        trial.refusal.empty() ? "failed: " + trial.failure : "refused: " + trial.refusal;
    const auto same =
        std::find_if(names.begin(), names.end(), [&](const auto& known) { return known.first == reason; });
    if (same == names.end())
      names.emplace_back(reason, trial.name);
    else
      same->second += ", " + trial.name;
  }
  for (const auto& [reason, of_designs] : names)
    write_wrapped(out, fmt::format("    {} {}", of_designs, reason), 6);
}

} // namespace

void write_ranking_text(std::ostream& out, const Ranking& ranking) {
  write_wrapped(
      out,
      fmt::format("{}: designs by their worst error against {}", ranking.case_name, reference_text(ranking)),
      2);
  if (ranking.fem.converged()) write_designs_table(out, ranking);
  write_reasons(out, ranking.designs);
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
