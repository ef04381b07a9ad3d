#include "cases/case/names.hpp"
#include "compare/cube/cube_benchmark.hpp"
#include "compare/thesis/build_results.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <tuple>

namespace springproof::compare {

namespace {

/// Gathers errors into a row.
class RowBuilder {
 public:
  RowBuilder(const std::string& table, const std::string& design) : row_{table, design} {}

  void add(const PublishedFigure& figure, const std::optional<double>& error, const std::string& reason,
           const Trace& trace) {
    if (!error) {
      ++row_.n_missing;
      if (std::find(row_.reasons.begin(), row_.reasons.end(), reason) == row_.reasons.end())
        row_.reasons.push_back(reason);
    } else if (sum_.add(*error)) {
      row_.worst_trace = trace;
      row_.worst_at = fmt::format("{}{}{} {}{}", figure.load_set, figure.load_set.empty() ? "" : " ",
                                  figure.test, figure.measure, nu_of(figure));
    }
    row_.n_figures = sum_.n;
    row_.worst = sum_.worst;
    row_.mean = sum_.mean();
  }
  DesignRow row() const { return row_; }

 private:
  static std::string nu_of(const PublishedFigure& figure) {
    return figure.material == "ogden" ? "" : fmt::format(" nu = {:g}", figure.poissons_ratio);
  }
  DesignRow row_;
  ErrorSum sum_;
};

/// A published volume errs as much as it differs from the rest volume: the thesis compares it with nothing
/// else.
double published_error(const PublishedFigure& figure, const Comparison& fem) {
  if (figure.unit == "%") return figure.value;
  return (figure.value / volumes_of(fem).rest - 1) * 100;
}

/// The linear method is in the tables as the thesis's own.
std::vector<cases::Design> other_designs() {
  std::vector<cases::Design> designs = msm::methods();
  designs.erase(std::find(designs.begin(), designs.end(), cases::Design::linear_method));
  return designs;
}

void add_rows_of_table(const std::string& table, const std::vector<PublishedFigure>& figures,
                       const Solutions& solutions, std::vector<DesignRow>& rows) {
  std::vector<std::string> thesis_designs;
  std::vector<PublishedFigure> questions; // the figures without regard to the thesis's springs
  std::set<std::tuple<double, std::string, std::string, std::string>> seen;
  for (const PublishedFigure& figure : figures) {
    if (figure.table != table) continue;
    if (std::find(thesis_designs.begin(), thesis_designs.end(), figure.design) == thesis_designs.end())
      thesis_designs.push_back(figure.design);
    if (seen.emplace(figure.poissons_ratio, figure.load_set, figure.test, figure.measure).second)
      questions.push_back(figure);
  }
  const auto add_computed = [&](RowBuilder& row, const PublishedFigure& figure, const JobPair& jobs) {
    const MeasuredPair pair = measured_pair(solutions, jobs, figure.measure);
    row.add(figure, pair.error(), pair.reason, trace_of(jobs));
  };
  for (const std::string& design : thesis_designs) {
    RowBuilder published(table, design + ", in print"), computed(table, design + ", the thesis's set");
    for (const PublishedFigure& figure : figures) {
      if (figure.table != table || figure.design != design) continue;
      const JobPair jobs = thesis_jobs(figure);
      published.add(figure, published_error(figure, solutions.at(jobs.fem)), "", {});
      add_computed(computed, figure, jobs);
    }
    rows.push_back(published.row());
    rows.push_back(computed.row());
  }
  for (const cases::Design design : other_designs()) {
    RowBuilder row(table, cases::name_of(design));
    for (const PublishedFigure& figure : questions)
      add_computed(row, figure, designed_jobs(figure, cases::name_of(design)));
    rows.push_back(row.row());
  }
}

} // namespace

std::vector<SolveJob> design_jobs(const PublishedFigure& figure) {
  std::vector<SolveJob> jobs;
  for (const cases::Design design : other_designs())
    append(jobs, designed_jobs(figure, cases::name_of(design)));
  return jobs;
}

std::vector<DesignRow> design_rows(const std::vector<PublishedFigure>& figures, const Solutions& solutions) {
  std::vector<std::string> tables;
  for (const PublishedFigure& figure : figures)
    if (figure.test != "cell" && std::find(tables.begin(), tables.end(), figure.table) == tables.end())
      tables.push_back(figure.table);
  std::vector<DesignRow> rows;
  for (const std::string& table : tables) add_rows_of_table(table, figures, solutions, rows);
  return rows;
}

} // namespace springproof::compare
