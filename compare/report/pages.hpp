#pragma once

#include "compare/error_bars/convergence.hpp"
#include "compare/study/error_budget.hpp"
#include "compare/study/study.hpp"
#include "compare/thesis/figures.hpp"
#include "compare/thesis/regenerate.hpp"

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

/// Pages: page.html with its data, which its scripts render.
namespace springproof::compare {

/// page.html of a data folder, every {{name}} replaced by its value or else by the file of that name there,
/// or of a library's script: three.min.js, OrbitControls.js, chart.min.js.
std::string filled_page(const std::string& data, const std::map<std::string, std::string>& values);

/// JSON as it may stand in a <script>: no text of it can end the element or begin a comment.
std::string embedded(const nlohmann::ordered_json& document);

/// A drawn figure of a folder (NAME.svg) as an element of the page, which is shown where scripts are off and
/// taken to its place by the page's script elsewhere.
std::string picture(const std::string& folder, const std::string& name, const std::string& caption);

/// Writes a page that needs no other file and no network, whole or not at all.
/// @param title     title of the browser's window
/// @param data      what the sections of page.js are made from: "heading" and "subheading", "times" ({phase,
///                  seconds}), and what each section reads; one without data is left out. Versions and
///                  licences are added here.
/// @param pictures  results of picture(), one after the other
/// @throws InputError if something cannot be read or written
void write_page(const std::string& file, const std::string& title, nlohmann::ordered_json data,
                const std::string& pictures = "");

/// One body of a page, to be turned.
struct BodyView {
  std::string id;      ///< id of the element on the page
  Overlay overlay;     ///< its title stands below the body
  std::string group{}; ///< heading over the bodies that have the same
  std::string description{}, command{};
  std::vector<MeasuredValue> measures{};
  std::vector<std::string> failures{}; ///< why a side is not drawn
};

/// A case's own view. A side that failed is left out, with the reason.
/// @param overlay  overlay of both sides
BodyView view_of(const Comparison& comparison, const std::string& id, Overlay overlay);

/// The views' geometry for the page's script: {"bodies": [{"unit_mm", "rest": [x, y, z, ...], "corners": 4,
/// "faces": [a, b, c, d, ...]}], "views": [{"id", "largest_scale", "title", "group", "description",
/// "command", "measures", "failures", "fem": {"body", "unit_mm", "displacement": [...]}, "springs": {...}}]}.
/// Lengths are whole numbers of a unit that leaves them five digits. Bodies are surfaces alone, and views of
/// the same body share it. A side without an answer is left out.
nlohmann::ordered_json views_to_json(const std::vector<BodyView>& views);

/// The surface that a case names, at rest and as each model has moved it, for the page's script: {"unit_mm",
/// "rest": [x, y, z, ...], "triangles": [a, b, c, ...], "fem": {"unit_mm", "displacement": [...]}, "springs":
/// {...}, "marks": [{"name", "point"}]}. Lengths are whole numbers of a unit, points and marks in mm. A side
/// without an answer is left out.
/// @return null where the case names no surface, or ranks share the answers
nlohmann::ordered_json skin_to_json(const Comparison& comparison);

/// FOLDER/CASE.html: what came of one case on a page of its own: the verdict, every warning,
/// measures with their uncertainty, what the springs are, both bodies, designs when they were ranked,
/// commands and versions. Beside it CASE_bodies/bodies.png and .svg, the bodies drawn. All of the answers
/// must be here.
/// @param ranking   ranking of the same case; null: none
/// @param commands  those that make the page, as typed
/// @param budgets   the parts of the errors; null: none
/// @throws InputError if something cannot be read or written
void write_case_page(const std::string& folder, const Comparison& comparison, const Ranking* ranking,
                     const std::vector<std::string>& commands, const ErrorBudgets* budgets = nullptr);

/// What the page is rendered from: "heading", "subheading", "verdict", "time", "case" (as in results.json),
/// "springs" (as attempt_to_json() has a design; null without one of ours), "skin" (skin_to_json()) or else
/// "views" (views_to_json()), "ranking" (ranking_to_json()), "commands", and
/// where there are budgets "error_budget" (error_budgets_to_json()).
nlohmann::ordered_json case_page_to_json(const Comparison& comparison, const Ranking* ranking,
                                         const std::vector<std::string>& commands,
                                         const ErrorBudgets* budgets = nullptr);

/// FOLDER/report.html: which springs for a material, every design's errors, deformed bodies, tables, and what
/// is reproduced of the thesis, on one page.
/// @param figures  as draw_figures() left them in FOLDER/figures
/// @throws InputError if something cannot be read or written
void write_report(const std::string& folder, const ThesisResults& results,
                  const std::vector<Figure>& figures);

/// What the page is rendered from: the document of tables.json, and beside it "methods" (what each design
/// is), "designed" (stiffnesses of every hundredth of Poisson's ratio), "sheets" (a table's number, name and
/// subject), "figures", "cases", "views" (views_to_json()), "workers" and "times"; an entry has
/// "computed_by", each reference's figure with its command, and an advice "seconds" of both models.
nlohmann::ordered_json report_to_json(const ThesisResults& results, const std::vector<Figure>& figures);

/// FOLDER/dossier.html.
/// @param document  of dossier_to_json()   @param commands  those that make the page, as typed
/// @throws InputError if something cannot be read or written
void write_dossier_page(const std::string& folder, const nlohmann::ordered_json& document,
                        const std::vector<std::string>& commands);

} // namespace springproof::compare
