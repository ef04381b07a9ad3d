#pragma once

#include "compare/thesis/draw_figures.hpp"
#include "compare/thesis/plot_bodies.hpp"
#include "compare/thesis/regenerate.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace springproof::compare {

/// FOLDER/report.html: tables, figures, three-dimensional views, settings and times on one page that needs no
/// other file and no network. It is page.html with the data, which page.js renders. The views' static
/// pictures go to FOLDER/figures.
/// @param figures  as draw_figures() left them in FOLDER/figures
/// @throws InputError if something cannot be read or written
void write_report(const std::string& folder, const ThesisResults& results,
                  const std::vector<Figure>& figures);

/// One three-dimensional view of the report.
struct BodyView {
  std::string id; ///< of the element on the page; the case's name
  Overlay overlay;
};

/// The views' geometry for the page's script: {"unit_mm": 1e-4, "bodies": [{"rest": [x, y, z, ...], "faces":
/// [a, b, c, d, ...]}], "views": [{"id", "largest_scale", "fem": {"body", "displacement": [...]}, "springs":
/// {...}}]}. Lengths are whole numbers of the unit. Bodies are surfaces alone, and views of the same body
/// share it. A side without an answer is left out.
nlohmann::ordered_json views_to_json(const std::vector<BodyView>& views);

/// What the page is rendered from: the document of tables.json, and beside it "sheets" (a table's number,
/// name and subject), "figures", "cases", "views" (views_to_json()), "provenance", "workers", "times" and
/// "licence"; an entry has "computed_by", each reference's figure with its command.
nlohmann::ordered_json report_to_json(const ThesisResults& results, const std::vector<Figure>& figures);

/// JSON as it may stand in a <script>: no text of it can end the element or begin a comment.
std::string embedded(const nlohmann::ordered_json& document);

} // namespace springproof::compare
