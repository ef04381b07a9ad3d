#pragma once

#include "compare/thesis/table_jobs.hpp"

namespace springproof::compare {

/// One table with springs of one design: what the error is, whatever print says. Errors against the table's
/// declared reference; volumes count as errors against the finite elements' volume.
struct DesignRow {
  std::string table;
  std::string design;                 ///< "DESIGN, in print", "DESIGN, the thesis's set", or a method's name
  ErrorSum errors{};                  ///< percent, of the figures that have a value
  int n_missing = 0;                  ///< refused or failed
  std::string worst_at{};             ///< "large shear alpha_1 nu = 0.49"
  std::vector<std::string> reasons{}; ///< of what is missing, each once
  Trace worst_trace{};                ///< gives the worst figure
};

/// The jobs behind a published figure's part in the rows.
std::vector<JobPair> design_jobs(const PublishedFigure& figure);

/// Per table: the published figures, the thesis's sets, and every method but the linear one
/// (nonlinear_method: the true minimiser of eq. 5.9), each designed from the table's own material.
std::vector<DesignRow> design_rows(const std::vector<PublishedFigure>& figures, const Solutions& solutions);

} // namespace springproof::compare
