#pragma once

#include "compare/gates/comparison.hpp"

#include <string>
#include <vector>

namespace springproof::compare {

/// An interval of a case file that is moved to where the value is now.
struct BlessedInterval {
  cases::Expectation old;
  std::array<double, 2> interval;
};

/// The regression intervals of a case that its values lie outside of, each as wide as it was and around the
/// value now. No other kind is ever moved: what is exact, published or another's does not change because we
/// do. A gate without a value is left as it is.
std::vector<BlessedInterval> intervals_to_bless(const Comparison& judged);

/// The file whose intervals are moved: where links lead to.
/// @throws std::filesystem::filesystem_error if there is none, such as for a case from a pipe
std::string blessed_file(const cases::Case& definition);

/// Rewrites the intervals in the file of a judged case and nothing else, whole or not at all.
/// @return the difference as a unified diff without context; empty when there was nothing to bless, and then
/// the file is not touched
/// @throws InputError if no interval stands where it should, for the file has changed meanwhile
std::string bless(const Comparison& judged);

/// Whether a case has an interval that may be blessed.
bool has_regression(const cases::Case& definition);

} // namespace springproof::compare
