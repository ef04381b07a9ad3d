#pragma once

#include "compare/sweep/analysis.hpp"
#include "compare/sweep/plan.hpp"
#include "compare/sweep/reference.hpp"
#include "compare/sweep/time_variant.hpp"

#include <functional>

namespace springproof::compare {

/// One variant, what it took, and how far it is from the truth. Its displacement is no longer kept.
struct SweepRow {
  Variant variant;
  VariantRun run;
  std::optional<double> field_error_percent;
  std::vector<std::optional<double>> measure_error_percent; ///< of the case's measures, with their sign
};

enum class Processes { one_per_variant, this_one };

/// Speed against error of one case: one plain record, which the writers read.
struct Sweep {
  cases::Case definition;
  Plan plan;
  TimingRules rules;
  Processes processes = Processes::one_per_variant;
  int n_ranks = 1;
  std::vector<SweepRow> rows; ///< of the plan's variants, in its order
  std::optional<Reference> reference;
  std::string reason_without_reference;
  double seconds = 0; ///< that the sweep took
};

/// Solves and times the plan's variants one after the other, each in a process of its own, and holds them
/// against the extrapolated reference. A variant that fails is a row with its reason. A quick sweep, and any
/// under MPI, runs in this process, and then memory is not told (collective; rank 0 alone has the springs'
/// rows).
/// @param program  whose hidden command `worker` serves
/// @param on_row   told the sweep as it is after every variant
/// @throws InputError for a case without a continuum limit, with another body than a box, or with measures
/// that the reference's mesh does not have
Sweep run_sweep(const cases::Case& definition, Extent extent, const TimingRules& rules,
                const std::string& program, const std::function<void(const Sweep&)>& on_row);

/// What an error is of.
enum class Error { field, worst_measure };
/// What a time is of.
enum class Clock {
  first_answer, ///< setup and the solve from rest
  re_solve      ///< the solve after a small change of the load, from the displacement before
};

/// Largest error of a measure, without sign; nothing when no measure has one.
std::optional<double> worst_measure_error(const SweepRow& row);

std::optional<double> error_of(const SweepRow& row, Error error);

/// Median of the repetitions; nothing without any.
std::optional<double> median_seconds(const SweepRow& row, Clock clock);

/// The rows that have both a time and an error.
std::vector<Point> points_of(const Sweep& sweep, Error error, Clock clock);

/// Errors of a spring design at its tightest tolerance, per level of the plan.
std::vector<std::optional<double>> errors_by_level(const Sweep& sweep, const std::string& method,
                                                   Error error);

/// The reference's own uncertainty, percent: of the displacement, or the largest of a measure.
double uncertainty_percent(const Reference& reference, Error error);

/// Names of the methods in the order of the rows.
std::vector<std::string> methods_of(const Sweep& sweep);

} // namespace springproof::compare
