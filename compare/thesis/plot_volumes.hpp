#pragma once

#include "compare/thesis/results.hpp"

#include <string>
#include <vector>

namespace springproof::compare {

/// Figure 5.10 as NAME.csv, .svg and .png: box plots of the springs' cells' volumes, one for each case, and
/// the outliers. Cases without box-plot figures are left out.
/// @param labels  one for each case: two words, which stand below each other
void plot_volumes(const std::string& folder, const std::string& name,
                  const std::vector<const CaseVolumes*>& volumes, const std::vector<std::string>& labels);

} // namespace springproof::compare
