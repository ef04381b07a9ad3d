#pragma once

#include "compare/thesis/table_jobs.hpp"

/// What other designs than the thesis's give: in its tables, and as advice for linear elasticity.
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

/// A design for linear elasticity at a Poisson's ratio, to be measured on the cube.
struct AdviceQuestion {
  double poissons_ratio;
  std::string design;
};

/// Every method at nu = 0.2, 0.3, 0.35, 0.45, 0.49.
std::vector<AdviceQuestion> advice_questions();

/// In the order of cube_tests.
std::vector<JobPair> advice_jobs(const AdviceQuestion& asked);

/// A design at one Poisson's ratio, for any Young's modulus E and edge L0, with its errors on the thesis's
/// cube. The errors hold for equal strains, that is equal force/(E L0²).
struct Advice {
  double poissons_ratio;
  std::string design;
  std::optional<msm::CellStiffness> stiffness{}; ///< over E L0 (volume: over E), no unit; absent when
                                                 ///< refused, and where the cells are not of four stiffnesses
  bool is_designed = false;                      ///< not refused
  CubeErrors cube{};
  /// Medians of the six tests that converged: setup and solve; 0 without any. They differ from run to run.
  double fem_seconds = 0, msm_seconds = 0;
  Trace small_trace{}, large_trace{}; ///< give the worst error under either load set
  bool is_recommended = false;        ///< one at most for each Poisson's ratio
  Trace trace{};                      ///< gives the stiffnesses
  /// Why there are no stiffnesses or errors; empty otherwise.
  const std::string& refusal() const {
    return cube.small.failure.empty() ? cube.large.failure : cube.small.failure;
  }
};

std::vector<Advice> advise(const std::vector<AdviceQuestion>& questions, const Solutions& solutions);

/// Marks, for each Poisson's ratio, the design with the smallest worst error over both load sets, among those
/// that are stable in every test; none when there is none.
void recommend(std::vector<Advice>& advice);

} // namespace springproof::compare
