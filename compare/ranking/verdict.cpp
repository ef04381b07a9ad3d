#include "compare/ranking/verdict.hpp"

#include "cases/case/names.hpp"
#include "compare/measure/measure.hpp"
#include "compare/provenance/print.hpp"
#include "compare/ranking/advice.hpp"
#include "compare/ranking/pace.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace springproof::compare {

namespace {

/// How both models ended, for a case without errors.
std::string end_of(const Answers& answers) {
  if (answers.fem.solution.trajectory) return "Both models moved to the end";
  if (!answers.msm.solution.is_equilibrium()) return "The springs were stopped before their equilibrium";
  return "Both models are in equilibrium";
}

std::string worst_measure_text(const RankedDesign& own, const Comparison& comparison) {
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
std::string mesh_text(const RankedDesign& own) {
  const auto fem = error_of_fem(own);
  if (!own.worst || !own.worst_bar || !fem) return "";
  if (fem->worst - fem->bar > *own.worst + *own.worst_bar)
    return " The mesh errs more than the springs do: refine it before you judge them.";
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

} // namespace

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
  RankedDesign own{cases::name_of(comparison.scene.definition.msm.design)};
  own.measures = comparison.measures;
  add_errors(own, comparison);
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
    if (printed_width(text) + 3 + printed_width(comment) <= screen_width)
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

} // namespace springproof::compare
