#pragma once

#include "compare/solve/solve.hpp"

/// The finite elements' side: its formulation, where a case leaves that open, and its limit under refinement,
/// known as well as the case's expectations ask for and no better.
namespace springproof::compare {

/// The largest displacement gradient of a cell (2-norm of F - I at its centre): strains and rotations alike.
/// What small strain leaves out is of this size next to what it keeps.
double largest_gradient(const cases::Mesh& mesh, const std::vector<Eigen::Vector3d>& displacement,
                        const cases::Sharing* sharing = nullptr);

/// Part of the finite elements' value, in percent, that it may be wrong by before the expectation can no
/// longer be judged: a quarter of the interval's width.
/// @param fem  the finite elements' value, in the measure's unit
double tolerated_error_percent(const cases::Expectation& expectation, double fem);

/// Solves the finite elements' side on the case's own mesh, with the formulation of the scene's definition
/// or, where that says "auto", with the one that is found; and on further meshes for its limit.
///
/// formulation: a linear solve estimates the largest gradient; when that is below what the narrowest
/// expectation tolerates, small strain is chosen, and that solve is the answer. accuracy: refined until the
/// reference of every measure (find_limit) is known to what its expectations tolerate, without one to a
/// quarter of a percent, or until the next mesh would have more than 1.5 million unknowns, take more than a
/// minute by estimate, or more memory than there is. Concentrated forces have no limit to refine towards. A
/// refined mesh that fails costs the others nothing. A hard case is not refined. Collective over
/// MPI_COMM_WORLD.
/// @param n_meshes  0: as the case's accuracy asks; else so many, from the body's own on, or the finest of
/// them that of the case when that is refined further
/// @param kept  answers on single meshes that an earlier command left
/// @throws InputError for a network without finite elements
Answers solve_fem(const cases::Scene& scene, int n_meshes, const KeptMeshes& kept = {});

/// The same of the finite elements beside a network, at the network's nodes: by the shape functions of the
/// cells, outside of them to first order. What that leaves out is told by a quadratic interpolation.
Answers solve_fem_at_network(const cases::Scene& network, int n_meshes);

} // namespace springproof::compare
