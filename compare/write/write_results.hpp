#pragma once

#include "compare/gates/comparison.hpp"

#include <string>
#include <vector>

namespace springproof::compare {

/// The files of `--out`: results.json and comparison.csv of all cases, and the fields of the last one as
/// .vtu. Called after every case, so that what is finished is on disk before the next begins.
/// @param done  at least one
void write_results(const std::string& folder, const std::vector<Comparison>& done);

} // namespace springproof::compare
