#pragma once

#include "fem_reference/discretisation.hpp"
#include "fem_reference/laws/formulation.hpp"

#include <Eigen/SparseCore>

namespace springproof::fem_reference {

/// A row and a column for every local degree of freedom, constrained ones too; what this rank's cells and
/// nodes add to them.
using LocalMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

struct Inertia {
  LocalMatrix mass;    ///< t: consistent or lumped, as fem.mass says, and what [[mass]] adds to nodes
  LocalMatrix damping; ///< N s/mm: mass_damping M + stiffness_damping K(rest), cell by cell
};

/// @param scene         that the discretisation is of: already refined
/// @param formulations  of each of its materials
Inertia make_inertia(const cases::Scene& scene, const Discretisation& discretisation,
                     const std::vector<Formulation>& formulations);

/// The tangent at rest, N/mm.
LocalMatrix rest_stiffness(const Discretisation& discretisation,
                           const std::vector<Formulation>& formulations);

} // namespace springproof::fem_reference
