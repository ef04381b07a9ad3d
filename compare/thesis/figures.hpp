#pragma once

#include "compare/gates/comparison.hpp"
#include "compare/thesis/regenerate.hpp"

#include <string>
#include <vector>

namespace springproof::compare {

/// A mesh and where its nodes went; without displacements when that side has none to show.
struct DeformedBody {
  const cases::Mesh* mesh;
  const std::vector<Eigen::Vector3d>* displacement; ///< mm, one per node; empty: nothing is drawn
  bool is_there() const { return !displacement->empty(); }
};

/// Both models' answers to one question, to be drawn over each other. Their meshes may differ (the bar's).
struct Overlay {
  std::string title;
  DeformedBody fem, springs;
};

/// The two sides of one comparison.
Overlay overlay_of(const Comparison& comparison, const std::string& title);

/// Bodies seen along a fixed oblique direction, parallel projection, at true scale, as NAME.csv, .svg and
/// .png: finite elements as light faces with their edges, over them the surface's edge springs, dotted the
/// outline at rest. Only faces that look at the viewer are drawn.
void plot_bodies(const std::string& folder, const std::string& name, const std::vector<Overlay>& panels,
                 int columns, int size = 400);

/// A drawn figure: NAME.csv (or the data its caption names), NAME.gp, NAME.svg and NAME.png in one folder.
struct Figure {
  std::string number; ///< in the thesis: "4.6"
  std::string name;   ///< that of the files
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
