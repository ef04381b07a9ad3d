#include "compare/thesis/build_results.hpp"
#include "compare/thesis/measured_pair.hpp"

#include <cmath>

namespace compare {

namespace {

/// Error of (45 deg + beta_2) of the small test of the same table, material and springs.
std::optional<double> error_from_beta_2(PublishedFigure figure, const Reference& reference,
                                        SolveSet& solves) {
  figure.load_set = "small";
  MeasuredPair beta =
      measured_pair(solves.get(fem_job(figure, reference)), solves.get(thesis_msm_job(figure)), "beta_2");
  if (beta.fem) *beta.fem += 45;
  if (beta.msm) *beta.msm += 45;
  return error_of(beta);
}

ComputedFigure compute(const PublishedFigure& figure, const Reference& reference, SolveSet& solves) {
  const SolveJob fem_side = fem_job(figure, reference), msm_side = thesis_msm_job(figure);
  const Comparison &fem = solves.get(fem_side), &msm = solves.get(msm_side);
  const MeasuredPair pair = measured_pair(fem, msm, figure.measure);
  ComputedFigure computed;
  computed.reference = reference.name();
  computed.fem = pair.fem;
  computed.msm = pair.msm;
  computed.value = figure.unit == "mm3" ? pair.msm : error_of(pair);
  if (!computed.value) computed.reason = pair.reason;
  if (figure.measure == "beta_1") computed.from_beta_2 = error_from_beta_2(figure, reference, solves);
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
    for (const Reference& reference : references_of(figure))
      entry.computed.push_back(compute(figure, reference, solves));
    entries.push_back(std::move(entry));
  }
  return entries;
}

} // namespace compare
