#pragma once

#include "compare/thesis/plot_bodies.hpp"
#include "compare/thesis/regenerate.hpp"

namespace springproof::compare {

/// A drawn figure: NAME.csv (or the data its caption names), NAME.gp, NAME.svg and NAME.png in one folder.
struct Figure {
  std::string number; ///< in the thesis: "4.6"
  std::string name;   ///< of the files
  std::string caption;
  std::string command; ///< that draws it again, as typed in the source folder
};

/// Both models of one of the results' cases. Bars of any resolution stand against the finest one's finite
/// elements (figure 5.12).
Overlay thesis_overlay(const ThesisResults& results, const Comparison& comparison, const std::string& title);

/// Draws the thesis's figures that the results have something for: designs (4.6 to 4.8, 5.4 to 5.8) always,
/// dot diagrams (4.11, A.1 to A.8), deformed bodies (4.15, 5.9, 5.12) and volumes (5.10) when their cells or
/// cases are among the results. Figure 4.15 is of another Poisson's ratio than the case files' and solves its
/// six cases.
/// @throws InputError if the folder cannot be written or gnuplot fails
std::vector<Figure> draw_figures(const std::string& folder, const ThesisResults& results);

} // namespace springproof::compare
