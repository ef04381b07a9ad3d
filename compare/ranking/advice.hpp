#pragma once

#include "compare/ranking/ranking.hpp"

#include <string>

/// What a ranking comes to, in words.
namespace springproof::compare {

/// Which design to use: its numbers as the table has them, the finite elements' own error as far as it is
/// known, what the reference's uncertainty does not tell it from, and why it and not those.
std::string advice_of(const Ranking& ranking);

/// "2.31", or "-" without a value.
std::string two_digits(const std::optional<double>& value);

/// "2.31 +- 0.4": the worst error with what the reference's uncertainty leaves of it.
std::string worst_text(const RankedDesign& ranked);

/// The finite elements' own error on the mesh of the springs: the largest that there may be, of the measures
/// whose limit is known. What has no limit is unknown, whatever another measure's error.
struct ErrorOfFem {
  double worst = 0, bar = 0;      ///< percent, points
  std::size_t n = 0, n_known = 0; ///< measures, and those whose limit is known
};
/// Nothing where no limit is known.
std::optional<ErrorOfFem> error_of_fem(const RankedDesign& ranked);

/// The same as a clause about the finite elements, "which ..." or "whose ...".
std::string error_of_fem_text(const RankedDesign& ranked);

} // namespace springproof::compare
