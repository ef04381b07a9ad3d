#pragma once

#include "msm/equilibrium.hpp"

namespace springproof::msm {

/// Moves `at` along a step as far as the potential falls enough (Armijo), halving the step. Next to the
/// solution the potential's change drowns in rounding: there a falling imbalance decides.
/// @param before  imbalance at `at`, N
/// @return whether a fraction of the step above 1e-6 would do; otherwise `at` is as it was
bool line_search(EquilibriumSystem& system, Vector& at, const Vector& step, const Vector& before,
                 double load_factor);

/// |imbalance| over |applied load|, or over |reaction| when nothing but supports that move is applied.
double relative_imbalance(EquilibriumSystem& system, const Vector& imbalance, const Vector& at);

} // namespace springproof::msm
