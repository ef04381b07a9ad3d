#pragma once

#include "compare/study/study.hpp"
#include "compare/thesis/figures.hpp"
#include "compare/thesis/regenerate.hpp"

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

/// Pages: page.html with its data, which its scripts render.
namespace springproof::compare {

/// A script that pages are made with: three.min.js, OrbitControls.js, chart.min.js.
std::string page_script(const std::string& name);

/// page.html of a data folder, every {{name}} replaced by its value or else by the file of that name there.
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

/// FOLDER/CASE.html: what came of one case on a page of its own (page.hpp): the verdict, every warning,
/// measures with their uncertainty, what the springs are, both bodies, designs when they were ranked,
/// commands and versions. Beside it CASE_bodies/bodies.png and .svg, the bodies drawn. All of the answers
/// must be here.
/// @param ranking   ranking of the same case; null: none
/// @param commands  those that make the page, as typed
/// @throws InputError if something cannot be read or written
void write_case_page(const std::string& folder, const Comparison& comparison, const Ranking* ranking,
                     const std::vector<std::string>& commands);

/// What the page is rendered from: "heading", "subheading", "verdict", "time", "case" (as in results.json),
/// "springs" (as attempt_to_json() has a design; null without one of ours), "skin" (skin_to_json()) or else
/// "views" (views_to_json()), "ranking" (ranking_to_json()), "commands".
nlohmann::ordered_json case_page_to_json(const Comparison& comparison, const Ranking* ranking,
                                         const std::vector<std::string>& commands);

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
