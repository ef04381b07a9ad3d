#pragma once

#include "compare/modes/eigenspaces.hpp"
#include "compare/thesis/entries.hpp"

/// Tables 4.1 to 4.3 and the dot diagrams: one cell of edge 2 mm, E = 1 MPa, springs by the linear method.
namespace springproof::compare {

struct CellAnalysis {
  double poissons_ratio;
  msm::CellStiffness stiffness; ///< N/mm; the same figures are the pseudo-stiffnesses k' = 2 k/(L0 E)
  EigenspaceAnalysis spaces;
};

/// The cells of these figures' Poisson's ratios, ascending, each once.
std::vector<CellAnalysis> analyse_cells(const std::vector<PublishedFigure>& figures);

/// One entry per published figure of a cell.
std::vector<TableEntry> cell_entries(const std::vector<PublishedFigure>& figures,
                                     const std::vector<CellAnalysis>& cells);

} // namespace springproof::compare
