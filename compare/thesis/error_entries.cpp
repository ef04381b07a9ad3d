#include "compare/thesis/build_results.hpp"

#include <cmath>

namespace springproof::compare {

namespace {

/// The published figure of another test of the same material and springs, in whichever table.
std::optional<double> published_value(const PublishedFigure& figure) {
  static const std::vector<PublishedFigure> all = read_published_figures();
  for (const PublishedFigure& other : all)
    if (other.material == figure.material && other.poissons_ratio == figure.poissons_ratio &&
        other.design == figure.design && other.design_poissons_ratio == figure.design_poissons_ratio &&
        other.load_set == figure.load_set && other.measure == figure.measure)
      return other.value;
  return std::nullopt;
}

/// Of the small test that a beta_1 is compared with.
PublishedFigure small_beta_2(PublishedFigure figure) {
  figure.load_set = "small";
  figure.measure = "beta_2";
  return figure;
}

/// What a beta_1 would err by if it were 45 deg + beta_2 of the small test: with our springs, and with
/// springs that have the published error of beta_2.
void add_readings_from_beta_2(ComputedFigure& computed, const PublishedFigure& figure,
                              const FemChoice& reference, const Solutions& solutions) {
  const MeasuredPair beta = measured_pair(solutions, thesis_jobs(figure, reference), figure.measure);
  if (!beta.fem) return;
  const auto with_error = [&](const std::optional<double>& error) { // (45 + b (1 + r))/(45 + b) - 1
    return error ? std::optional(*beta.fem * *error / (45 + *beta.fem)) : std::nullopt;
  };
  computed.from_beta_2 = with_error(beta.error());
  computed.from_printed_beta_2 = with_error(published_value(figure));
}

ComputedFigure compute(const PublishedFigure& figure, const FemChoice& reference,
                       const Solutions& solutions) {
  const JobPair jobs = thesis_jobs(figure, reference);
  const MeasuredPair pair = measured_pair(solutions, jobs, figure.measure);
  ComputedFigure computed;
  computed.reference = reference.name();
  computed.fem = pair.fem;
  computed.msm = pair.msm;
  computed.value = figure.unit == "mm3" ? pair.msm : pair.error();
  if (!computed.value) computed.reason = pair.reason;
  if (figure.measure == "beta_1")
    add_readings_from_beta_2(computed, small_beta_2(figure), reference, solutions);
  computed.trace = trace_of(jobs);
  return computed;
}

} // namespace

std::optional<double> TableEntry::difference(const ComputedFigure& of) const {
  return of.value ? std::optional(*of.value - published.value) : std::nullopt;
}

const ComputedFigure* TableEntry::nearest() const {
  const ComputedFigure* best = nullptr;
  for (const ComputedFigure& candidate : computed)
    if (candidate.value && (!best || std::abs(*difference(candidate)) < std::abs(*difference(*best))))
      best = &candidate;
  return best;
}

std::vector<SolveJob> entry_jobs(const PublishedFigure& figure) {
  std::vector<SolveJob> jobs;
  for (const FemChoice& reference : references_of(figure)) {
    append(jobs, thesis_jobs(figure, reference));
    if (figure.measure == "beta_1") append(jobs, thesis_jobs(small_beta_2(figure), reference));
  }
  return jobs;
}

std::vector<TableEntry> error_entries(const std::vector<PublishedFigure>& figures,
                                      const Solutions& solutions) {
  std::vector<TableEntry> entries;
  for (const PublishedFigure& figure : figures) {
    if (figure.test == "cell") continue;
    TableEntry entry{figure, {}, ""};
    for (const FemChoice& reference : references_of(figure))
      entry.computed.push_back(compute(figure, reference, solutions));
    entries.push_back(std::move(entry));
  }
  return entries;
}

} // namespace springproof::compare
