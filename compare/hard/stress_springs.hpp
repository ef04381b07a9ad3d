#pragma once

#include "cases/case/hard_case.hpp"
#include "compare/provenance/stopwatch.hpp"
#include "compare/solve/answers.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <functional>
#include <string>
#include <vector>

/// The springs' side of hard cases, which needs no finite elements.
namespace springproof::compare {

/// A side's answer, or that no model can be made of the case, with the reason.
Answer or_refused(const std::function<Answer()>& solve);

/// A solver's settings with a hard case's limits: load steps, iterations, seconds since the stopwatch
/// started.
/// @param hard_case, stopwatch  must outlive what is returned
mechanics::EquilibriumSettings limited_by(const cases::HardCase& hard_case, const Stopwatch& stopwatch,
                                          mechanics::EquilibriumSettings settings);

/// @param which      msm, or hybrid: that design in place of the case's own
/// @param n_threads  of the multigrid path
Answer solve_springs(cases::Side which, const cases::HardCase& hard_case, int n_threads);

/// What a side differs in from what the case expects and allows.
std::vector<std::string> misses(const cases::HardCase& hard_case, const cases::ExpectedOutcome& expected,
                                const Answer& answer);

} // namespace springproof::compare
