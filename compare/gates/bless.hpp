#pragma once

#include "compare/gates/comparison.hpp"

#include <string>

namespace springproof::compare {

/// The file whose intervals are moved: where links lead to.
/// @throws std::filesystem::filesystem_error if there is none, such as for a case from a pipe
std::string blessed_file(const cases::Case& definition);

/// Rewrites the regression intervals of a judged case that its values lie outside of in its file, each as
/// wide as it was and around the value now, and nothing else, whole or not at all. No other kind is ever
/// moved: what is exact, published or another's does not change because we do. A gate without a value is left
/// as it is.
/// @return the difference as a unified diff without context; empty when there was nothing to bless, and then
/// the file is not touched
/// @throws InputError if no interval stands where it should, for the file has changed meanwhile
std::string bless(const Comparison& judged);

/// Whether a case has an interval that may be blessed.
bool has_regression(const cases::Case& definition);

} // namespace springproof::compare
