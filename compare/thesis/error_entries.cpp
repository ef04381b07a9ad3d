#include "compare/thesis/build_results.hpp"
#include "compare/thesis/measured_pair.hpp"

#include <cmath>

namespace springproof::compare {

namespace {

/// The figure that print has for another test of the same material and springs, in whichever table.
std::optional<double> printed_value(const PublishedFigure& figure) {
  static const std::vector<PublishedFigure> all = read_published_figures();
  for (const PublishedFigure& other : all)
    if (other.material == figure.material && other.poissons_ratio == figure.poissons_ratio &&
        other.design == figure.design && other.design_poissons_ratio == figure.design_poissons_ratio &&
        other.load_set == figure.load_set && other.measure == figure.measure)
      return other.value;
  return std::nullopt;
}

/// What a beta_1 would err by if it were 45 deg + beta_2 of the small test: with our springs, and with
/// springs that have the printed error of beta_2.
void add_readings_from_beta_2(ComputedFigure& computed, PublishedFigure figure, const FemChoice& reference,
                              SolveSet& solves) {
  figure.load_set = "small";
  figure.measure = "beta_2";
  const MeasuredPair beta = measured_pair(solves.get(fem_job(figure, reference)),
                                          solves.get(thesis_msm_job(figure)), figure.measure);
  if (!beta.fem) return;
  const auto with_error = [&](const std::optional<double>& error) { // (45 + b (1 + r))/(45 + b) - 1
    return error ? std::optional(*beta.fem * *error / (45 + *beta.fem)) : std::nullopt;
  };
  computed.from_beta_2 = with_error(error_of(beta));
  computed.from_printed_beta_2 = with_error(printed_value(figure));
}

ComputedFigure compute(const PublishedFigure& figure, const FemChoice& reference, SolveSet& solves) {
  const SolveJob fem_side = fem_job(figure, reference), msm_side = thesis_msm_job(figure);
  const Comparison &fem = solves.get(fem_side), &msm = solves.get(msm_side);
  const MeasuredPair pair = measured_pair(fem, msm, figure.measure);
  ComputedFigure computed;
  computed.reference = reference.name();
  computed.fem = pair.fem;
  computed.msm = pair.msm;
  computed.value = figure.unit == "mm3" ? pair.msm : error_of(pair);
  if (!computed.value) computed.reason = pair.reason;
  if (figure.measure == "beta_1") add_readings_from_beta_2(computed, figure, reference, solves);
  computed.trace = trace_of(fem_side, msm_side);
  return computed;
}

} // namespace

const ComputedFigure* TableEntry::nearest() const {
  const ComputedFigure* best = nullptr;
  const auto distance = [&](const ComputedFigure& c) { return std::abs(*c.value - published.value); };
  for (const ComputedFigure& candidate : computed)
    if (candidate.value && (!best || distance(candidate) < distance(*best))) best = &candidate;
  return best;
}

std::vector<TableEntry> error_entries(const std::vector<PublishedFigure>& figures, SolveSet& solves) {
  std::vector<TableEntry> entries;
  for (const PublishedFigure& figure : figures) {
    if (figure.test == "cell") continue;
    TableEntry entry{figure, {}, ""};
    for (const FemChoice& reference : references_of(figure))
      entry.computed.push_back(compute(figure, reference, solves));
    entries.push_back(std::move(entry));
  }
  return entries;
}

} // namespace springproof::compare
