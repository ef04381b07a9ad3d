#include "compare/thesis/build_results.hpp"
#include "compare/thesis/measured_pair.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <tuple>

namespace springproof::compare {

namespace {

/// Gathers errors into a row.
class RowBuilder {
 public:
  RowBuilder(std::string table, std::string design)
      : row_{std::move(table), std::move(design), 0, 0, std::nullopt, std::nullopt, "", {}, {}} {}

  void add(const PublishedFigure& figure, const std::optional<double>& error, const std::string& reason,
           const Trace& trace) {
    if (!error) {
      ++row_.n_missing;
      if (std::find(row_.reasons.begin(), row_.reasons.end(), reason) == row_.reasons.end())
        row_.reasons.push_back(reason);
      return;
    }
    ++row_.n_figures;
    sum_ += std::abs(*error);
    row_.mean = sum_ / row_.n_figures;
    if (row_.worst && std::abs(*error) <= *row_.worst) return;
    row_.worst = std::abs(*error);
    row_.worst_trace = trace;
    row_.worst_at = fmt::format("{}{}{} {}{}", figure.load_set, figure.load_set.empty() ? "" : " ",
                                figure.test, figure.measure, nu_of(figure));
  }
  DesignRow row() const { return row_; }

 private:
  static std::string nu_of(const PublishedFigure& figure) {
    return figure.material == "ogden" ? "" : fmt::format(" nu = {:g}", figure.poissons_ratio);
  }
  DesignRow row_;
  double sum_ = 0;
};

double rest_volume(const Comparison& comparison) {
  return comparison.scene.mesh.cells.empty() ? 1 : volumes_of(comparison).rest;
}

/// A printed volume errs as much as it differs from the rest volume: print compares it with nothing else.
std::optional<double> printed_error(const PublishedFigure& figure, const Comparison& fem) {
  if (figure.unit == "%") return figure.value;
  return (figure.value / rest_volume(fem) - 1) * 100;
}

void add_rows_of_table(const std::string& table, const std::vector<PublishedFigure>& figures,
                       SolveSet& solves, std::vector<DesignRow>& rows) {
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
  const auto add_computed = [&](RowBuilder& row, const PublishedFigure& figure, const SolveJob& msm) {
    const SolveJob fem = fem_job(figure, references_of(figure).front());
    const MeasuredPair pair = measured_pair(solves.get(fem), solves.get(msm), figure.measure);
    row.add(figure, error_of(pair), pair.reason, trace_of(fem, msm));
  };
  for (const std::string& design : thesis_designs) {
    RowBuilder printed(table, design + ", in print"), computed(table, design + ", the thesis's set");
    for (const PublishedFigure& figure : figures) {
      if (figure.table != table || figure.design != design) continue;
      const Comparison& fem = solves.get(fem_job(figure, references_of(figure).front()));
      printed.add(figure, printed_error(figure, fem), "", {});
      add_computed(computed, figure, thesis_msm_job(figure));
    }
    rows.push_back(printed.row());
    rows.push_back(computed.row());
  }
  for (const char* design : {"nonlinear_method", "moduli", "hybrid", "multi_load"}) {
    RowBuilder row(table, design);
    for (const PublishedFigure& figure : questions)
      add_computed(row, figure, designed_msm_job(figure, design));
    rows.push_back(row.row());
  }
}

} // namespace

std::vector<DesignRow> design_rows(const std::vector<PublishedFigure>& figures, SolveSet& solves) {
  std::vector<std::string> tables;
  for (const PublishedFigure& figure : figures)
    if (figure.test != "cell" && std::find(tables.begin(), tables.end(), figure.table) == tables.end())
      tables.push_back(figure.table);
  std::vector<DesignRow> rows;
  for (const std::string& table : tables) add_rows_of_table(table, figures, solves, rows);
  return rows;
}

} // namespace springproof::compare
