#pragma once

#include "compare/gates/comparison.hpp"

#include <string>
#include <vector>

namespace springproof::compare {

/// A mesh and where its nodes went; without displacements when that side has none to show.
struct DeformedBody {
  const cases::HexMesh* mesh;
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

} // namespace springproof::compare
