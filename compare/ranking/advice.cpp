#include "compare/ranking/advice.hpp"

#include "compare/ranking/pace.hpp"

#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// What the reference's uncertainty does not tell from the smallest error, and what speaks for the
/// recommended design.  @param all  Ranking::best()
std::string others_text(const std::vector<const RankedDesign*>& all, const RankedDesign& own) {
  if (all.size() < 2) return "";
  std::vector<std::string> names, without_moduli;
  std::size_t n_alike = 0;
  for (const RankedDesign* one : all) {
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

} // namespace

std::string two_digits(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

std::string worst_text(const RankedDesign& ranked) {
  return two_digits(ranked.worst) + (ranked.worst_bar ? fmt::format(" +- {:.2g}", *ranked.worst_bar) : "");
}

std::optional<ErrorOfFem> error_of_fem(const RankedDesign& ranked) {
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

std::string error_of_fem_text(const RankedDesign& ranked) {
  const auto found = error_of_fem(ranked);
  if (!found) return "whose own error on this mesh is not known";
  return fmt::format("which themselves err by up to {:.2f} +- {:.2g} % on this mesh{}", found->worst,
                     found->bar,
                     found->n_known < found->n ? fmt::format(" in the {} of {} measures whose limit is known",
                                                             found->n_known, found->n)
                                               : "");
}

std::string advice_of(const Ranking& ranking) {
  if (!ranking.fem.converged())
    return fmt::format("There is no reference: finite elements: {}", ranking.fem.solution.message);
  const RankedDesign* best = ranking.recommended();
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

} // namespace springproof::compare
