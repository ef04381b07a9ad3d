#pragma once

#include "compare/gates/comparison.hpp"

namespace springproof::compare {

/// A measure on the two sides of a case that were solved apart.
struct MeasuredPair {
  std::optional<double> fem, msm;
  std::string reason; ///< why one is missing; empty when both are there
};

/// @param fem, msm  the same case, with its finite elements and its springs solved
MeasuredPair measured_pair(const Comparison& fem, const Comparison& msm, const std::string& measure);

/// error_percent() of a pair that has both.
std::optional<double> error_of(const MeasuredPair& pair);

} // namespace springproof::compare
