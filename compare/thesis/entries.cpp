#include "compare/thesis/entries.hpp"

#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// The published figure of another test of the same material and springs, in whichever table.
std::optional<double> published_value(const PublishedFigure& figure) {
  for (const PublishedFigure& other : published_figures())
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
/// @param figure  that beta_2
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
  ComputedFigure computed{reference.name(), figure.unit == "mm3" ? pair.msm : pair.error(), pair.fem,
                          pair.msm};
  if (!computed.value) computed.reason = pair.reason;
  if (figure.measure == "beta_1")
    add_readings_from_beta_2(computed, small_beta_2(figure), reference, solutions);
  computed.trace = trace_of(jobs);
  return computed;
}

/// Rounding of print, and of the stiffnesses behind it: what counts as the same figure, points.
constexpr double same_figure = 0.1;
/// Near enough to be worth a hint, points.
constexpr double similar_figure = 0.5;

/// Of the beta_1 rows some hold another quantity's error. The definition in the text gives a beta_1 that errs
/// about as much as beta_2 does.
std::string explain_beta_1(const TableEntry& entry) {
  const auto [c, reading] = nearest_from_beta_2(entry);
  const double off = std::abs(reading - entry.published.value);
  if (!c || !(off <= similar_figure))
    return "not beta_1 as the text defines it, nor any other quantity that was tried";
  const std::string what =
      fmt::format("the error of 45 deg + beta_2 of the small test, {:.2f} with {}{}", reading, c->reference,
                  reading == c->from_beta_2 ? "" : " and the printed error of beta_2");
  return (off <= same_figure ? "not beta_1: print holds " : "not beta_1, perhaps ") + what;
}

/// The printed tilt of the left edge under the large shear lies above that reference which meets the tilt of
/// the right edge, although both come from the same two solutions.
std::string explain_alpha_1(const TableEntry& entry, const TableEntry* alpha_2) {
  const ComputedFigure* right = alpha_2 ? alpha_2->nearest() : nullptr;
  if (!right) return "";
  const ComputedFigure& left = entry.computed[static_cast<std::size_t>(right - alpha_2->computed.data())];
  if (!left.value || !(entry.published.value - *left.value > 1)) return "";
  return fmt::format(
      "print lies {:.1f} points above {}, which meets alpha_2 of the same two solutions within {:.1f}",
      entry.published.value - *left.value, left.reference,
      std::abs(*right->value - alpha_2->published.value));
}

/// Another measure of the same test.
const TableEntry* find_beside(const std::vector<TableEntry>& entries, const PublishedFigure& figure,
                              const std::string& measure) {
  for (const TableEntry& entry : entries) {
    const PublishedFigure& p = entry.published;
    if (p.table == figure.table && p.poissons_ratio == figure.poissons_ratio && p.design == figure.design &&
        p.load_set == figure.load_set && p.test == figure.test && p.measure == measure)
      return &entry;
  }
  return nullptr;
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

std::vector<JobPair> entry_jobs(const PublishedFigure& figure) {
  std::vector<JobPair> jobs;
  for (const FemChoice& reference : references_of(figure)) {
    jobs.push_back(thesis_jobs(figure, reference));
    if (figure.measure == "beta_1") jobs.push_back(thesis_jobs(small_beta_2(figure), reference));
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

BetaReading nearest_from_beta_2(const TableEntry& entry) {
  BetaReading nearest{nullptr, 0};
  const double published = entry.published.value;
  for (const ComputedFigure& c : entry.computed)
    for (const auto& reading : {c.from_beta_2, c.from_printed_beta_2})
      if (reading &&
          (!nearest.reference || std::abs(*reading - published) < std::abs(nearest.value - published)))
        nearest = {&c, *reading};
  return nearest;
}

void explain(std::vector<TableEntry>& entries) {
  for (TableEntry& entry : entries) {
    const PublishedFigure& p = entry.published;
    if (p.measure == "beta_1") entry.finding = explain_beta_1(entry);
    if (p.measure == "alpha_1" && p.load_set == "large")
      entry.finding = explain_alpha_1(entry, find_beside(entries, p, "alpha_2"));
  }
}

} // namespace springproof::compare
