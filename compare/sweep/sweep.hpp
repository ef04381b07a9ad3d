#pragma once

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

} // namespace springproof::compare
