#include "compare/thesis/designs.hpp"

#include "cases/case/names.hpp"
#include "compare/thesis/volumes.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <tuple>

namespace springproof::compare {

namespace {

void add(DesignRow& row, const PublishedFigure& figure, const std::optional<double>& error,
         const std::string& reason, const Trace& trace) {
  if (!error) {
    ++row.n_missing;
    if (std::find(row.reasons.begin(), row.reasons.end(), reason) == row.reasons.end())
      row.reasons.push_back(reason);
  } else if (row.errors.add(*error)) {
    row.worst_trace = trace;
    row.worst_at = fmt::format("{}{}{} {}", figure.load_set, figure.load_set.empty() ? "" : " ", figure.test,
                               figure.measure);
    if (figure.material != "ogden") row.worst_at += fmt::format(" nu = {:g}", figure.poissons_ratio);
  }
}

void add_computed(DesignRow& row, const PublishedFigure& figure, const Solutions& solutions,
                  const JobPair& jobs) {
  const MeasuredPair pair = measured_pair(solutions, jobs, figure.measure);
  add(row, figure, pair.error(), pair.reason, trace_of(jobs));
}

/// A published volume errs as much as it differs from the rest volume: the thesis compares it with nothing
/// else.
double published_error(const PublishedFigure& figure, const Comparison& fem) {
  return figure.unit == "%" ? figure.value : (figure.value / volumes_of(fem).rest - 1) * 100;
}

/// The linear method is in the tables as the thesis's own.
std::vector<std::string> other_designs() {
  std::vector<std::string> designs;
  for (const cases::Design design : msm::methods())
    if (design != cases::Design::linear_method) designs.push_back(cases::name_of(design));
  return designs;
}

} // namespace

std::vector<JobPair> design_jobs(const PublishedFigure& figure) {
  std::vector<JobPair> jobs;
  for (const std::string& design : other_designs()) jobs.push_back(designed_jobs(figure, design));
  return jobs;
}

std::vector<DesignRow> design_rows(const std::vector<PublishedFigure>& figures, const Solutions& solutions) {
  std::vector<DesignRow> rows;
  const auto row_of = [&](const std::string& table, const std::string& design) -> DesignRow& {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const DesignRow& row) {
      return row.table == table && row.design == design;
    });
    return found == rows.end() ? rows.emplace_back(DesignRow{table, design}) : *found;
  };
  for (const std::string& table : tables_of(figures)) {
    std::vector<PublishedFigure> questions; // the figures without regard to the thesis's springs
    std::set<std::tuple<double, std::string, std::string, std::string>> seen;
    for (const PublishedFigure& figure : figures) {
      if (figure.table != table || figure.test == "cell") continue;
      const JobPair jobs = thesis_jobs(figure);
      const double error = published_error(figure, solutions.at(jobs.fem));
      add(row_of(table, figure.design + ", in print"), figure, error, "", {});
      add_computed(row_of(table, figure.design + ", the thesis's set"), figure, solutions, jobs);
      if (seen.emplace(figure.poissons_ratio, figure.load_set, figure.test, figure.measure).second)
        questions.push_back(figure);
    }
    for (const PublishedFigure& figure : questions)
      for (const std::string& design : other_designs())
        add_computed(row_of(table, design), figure, solutions, designed_jobs(figure, design));
  }
  return rows;
}

} // namespace springproof::compare
