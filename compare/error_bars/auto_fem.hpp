#pragma once

#include "compare/solve/solve.hpp"

/// The finite elements' side of cases that leave its formulation or its refinement open: as accurate as the
/// case's expectations ask for, and no more.
namespace springproof::compare {

/// The largest displacement gradient of a cell (2-norm of F - I at its centre): strains and rotations alike.
/// What small strain leaves out is of this size next to what it keeps.
double largest_gradient(const cases::HexMesh& mesh, const std::vector<Eigen::Vector3d>& displacement);

/// Part of the finite elements' value, in percent, that it may be wrong by before the expectation can no
/// longer be judged: a quarter of the interval's width.
/// @param fem  the finite elements' value, in the measure's unit
double tolerated_error_percent(const cases::Expectation& expectation, double fem);

/// Solves the finite elements' side, with the formulation and refinement of the scene's definition or, where
/// that says "auto", with those that are found.
///
/// formulation: a linear solve estimates the largest gradient; when that is below what the narrowest
/// expectation tolerates, small strain is chosen, and that solve is the answer. accuracy: refined until the
/// error bar of each measure that is expected something of (finest_error_percent) is below what its
/// expectations tolerate; concentrated forces have no limit to refine towards, and keep the body's own mesh.
/// Collective over MPI_COMM_WORLD.
FemAnswer solve_fem(const cases::Scene& scene);

} // namespace springproof::compare
