#pragma once

#include "compare/thesis/draw_figures.hpp"
#include "compare/thesis/results.hpp"

#include <string>
#include <vector>

namespace springproof::compare {

/// FOLDER/report.html: tables, figures, three-dimensional views, settings and times on one page that needs no
/// other file and no network. The views' static pictures go to FOLDER/figures.
/// @param figures  as draw_figures() left them in FOLDER/figures
/// @throws InputError if something cannot be read or written
void write_report(const std::string& folder, const ThesisResults& results,
                  const std::vector<Figure>& figures);

} // namespace springproof::compare
