#pragma once

#include "compare/thesis/figures.hpp"
#include "compare/thesis/regenerate.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace springproof::compare {

/// FOLDER/report.html: which springs for a material, every design's errors, deformed bodies, tables, and what
/// is reproduced of the thesis, on one page (page.hpp).
/// @param figures  as draw_figures() left them in FOLDER/figures
/// @throws InputError if something cannot be read or written
void write_report(const std::string& folder, const ThesisResults& results,
                  const std::vector<Figure>& figures);

/// What the page is rendered from: the document of tables.json, and beside it "methods" (what each design
/// is), "designed" (stiffnesses of every hundredth of Poisson's ratio), "sheets" (a table's number, name and
/// subject), "figures", "cases", "views" (views_to_json()), "workers" and "times"; an entry has
/// "computed_by", each reference's figure with its command, and an advice "seconds" of both models.
nlohmann::ordered_json report_to_json(const ThesisResults& results, const std::vector<Figure>& figures);

} // namespace springproof::compare
