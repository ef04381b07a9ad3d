#pragma once

#include "fem_reference/discretisation.hpp"
#include "fem_reference/laws/formulation.hpp"

#include <Eigen/SparseCore>

namespace springproof::fem_reference {

/// A matrix with a row and a column for every local degree of freedom, constrained ones too. It holds what
/// this rank's cells and nodes add.
using LocalMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

struct Inertia {
  LocalMatrix mass;    ///< t: consistent or lumped, as fem.mass says, and what [[mass]] adds to nodes
  LocalMatrix damping; ///< N s/mm: mass_damping M + stiffness_damping K(rest), cell by cell
};

/// @param scene         the discretisation's, already refined
/// @param formulations  one for each of its materials
Inertia make_inertia(const cases::Scene& scene, const Discretisation& discretisation,
                     const std::vector<Formulation>& formulations);

/// The tangent at rest, N/mm, with a row and a column for every local unknown.
LocalMatrix rest_stiffness(const Discretisation& discretisation,
                           const std::vector<Formulation>& formulations);

} // namespace springproof::fem_reference
