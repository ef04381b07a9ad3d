#pragma once

#include "compare/report/views.hpp"
#include "compare/thesis/draw_figures.hpp"
#include "compare/thesis/results.hpp"

#include <string>
#include <vector>

/// The report's parts as HTML, without their heading; empty when the results have nothing for one.
namespace springproof::compare::html {

/// How many printed figures are met, and a list of those that are not, with their explanation.
std::string summary_section(const ThesisResults& results);

/// Stiffnesses by Poisson's ratio for any E and edge, with expected errors, and a calculator.
std::string advice_section(const ThesisResults& results);

/// Print beside both references; every number leads to the command that gives it again.
std::string tables_section(const ThesisResults& results);

std::string designs_section(const ThesisResults& results);
std::string volumes_section(const ThesisResults& results);

/// @param folder  that holds the figures' files
std::string figures_section(const std::vector<Figure>& figures, const std::string& folder);

/// @param folder  that holds each view's static picture, ID.png
std::string views_section(const ThesisResults& results, const std::vector<BodyView>& views,
                          const std::string& folder);

/// Settings and outcome of each case, versions, machine and times.
std::string settings_section(const ThesisResults& results);

} // namespace springproof::compare::html
