#pragma once

#include "cases/mesh/hex_mesh.hpp"
#include "compare/modes/eigenspaces.hpp"
#include "msm/design/linear_method.hpp"

#include <Eigen/SparseCore>
#include <vector>

/// The lowest modes of a whole free body, both models on one mesh.
namespace springproof::compare {

/// Sum of cell matrices on a mesh's degrees of freedom, 3*node + component, N/mm.
/// @param cells  one for every cell of the mesh, or a single one for all
Eigen::SparseMatrix<double> assemble(const cases::HexMesh& mesh, const std::vector<msm::CellMatrix>& cells);

/// An FEM eigenspace and the MSM eigenspace that it overlaps most.
struct ModePair {
  Eigenspace fem, msm;
  double ratio;         ///< MSM's eigenvalue over FEM's
  double angle_degrees; ///< largest principal angle between the two, over the smaller dimension
};

struct FreeBodyModes {
  Spectrum fem, msm;
  std::vector<ModePair> pairs; ///< ascending; the six rigid modes are left out
};

/// @param n_modes  deforming modes wanted; eigenspaces that would be cut in two are left out
/// @throws SolveError if SLEPc does not converge
FreeBodyModes free_body_modes(const Eigen::SparseMatrix<double>& fem, const Eigen::SparseMatrix<double>& msm,
                              int n_modes);

} // namespace springproof::compare
