#pragma once

#include "compare/study/study.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace springproof::compare {

/// FOLDER/CASE.html: what came of one case on a page of its own (page.hpp): the verdict, every warning,
/// measures with their uncertainty, what the springs are, both bodies, designs when they were ranked,
/// commands and versions. Beside it CASE_bodies/bodies.png and .svg, the bodies drawn. All of the answers
/// must be here.
/// @param ranking   of the same case; null: none
/// @param commands  that make the page, as typed
/// @throws InputError if something cannot be read or written
void write_case_page(const std::string& folder, const Comparison& comparison, const Ranking* ranking,
                     const std::vector<std::string>& commands);

/// What the page is rendered from: "heading", "subheading", "verdict", "time", "case" (as in results.json),
/// "springs" (as attempt_to_json() has a design; null without one of ours), "skin" (skin_to_json()) or else
/// "views" (views_to_json()), "ranking" (ranking_to_json()), "commands".
nlohmann::ordered_json case_page_to_json(const Comparison& comparison, const Ranking* ranking,
                                         const std::vector<std::string>& commands);

} // namespace springproof::compare
