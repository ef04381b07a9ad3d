#pragma once

#include "compare/solve/answers.hpp"

#include <ostream>

/// CalculiX, an independent finite-element program, solves a case too. Its fully integrated trilinear
/// hexahedron C3D8 is our small_strain q1 in a static step, and with NLGEOM our saint_venant_kirchhoff q1;
/// its tetrahedra C3D4 and C3D10 are p1 and p2.
namespace springproof::compare {

/// CalculiX takes a residual below 1e-6 for zero, in whatever unit. Forces in millionths of a newton (and
/// moduli likewise) put that far below what its convergence is controlled by; displacements do not change.
constexpr double calculix_force_unit = 1e6;

/// Why CalculiX cannot solve this case; nothing if it can.
std::optional<std::string> reason_without_calculix(const cases::Case& definition);

/// CalculiX's input: the mesh refined as the case's finite elements are, supports by degree of freedom, and
/// all loads as the nodal forces that ours are equivalent to. Tools are layers of held cells that the body's
/// surface meets node by node, without friction (mesh_of_tool()). Node n and cell c of the mesh are n + 1 and
/// c + 1 there; mm, N, MPa.
/// @param scene  already refined
void write_calculix_input(std::ostream& out, const cases::Scene& scene);

/// The same for a motion, with an amplitude for every load: before and after its points it is what it is at
/// them.
void write_calculix_motion_input(std::ostream& out, const cases::Scene& scene);

/// Displacements of a CalculiX .dat file (mm), and the part of the load, or the time (s), they belong to.
struct CalculixOutput {
  std::vector<Eigen::Vector3d> displacement;
  double load_reached = 0;
};

/// Reads what *NODE PRINT leaves in a .dat file, block after block: seven digits a component.
/// @throws SolveError if a node has no displacement in some block, or there is no block
std::vector<CalculixOutput> read_calculix_blocks(std::istream& in, std::size_t n_nodes);

/// Forces (N) on the nodes of the tools in the last block of a .dat file, one tool after the other; on the
/// body.
/// @param n_nodes  of the body, after which the tools' are
std::vector<Eigen::Vector3d> read_calculix_tool_forces(std::istream& in, std::size_t n_nodes);

/// All nodes after every step of a linear motion from rest: *DYNAMIC at the case's own step, with alpha = 0,
/// which is newmark (1/4, 1/2); loads by their histories.
/// @param scene  one without a reason_without_calculix(), of a density
/// @return nothing when there is no `ccx`   @throws SolveError when it stops
std::vector<CalculixOutput> motion_by_calculix(const cases::Scene& scene);

/// Runs `ccx` in a temporary folder, one thread. Skipped, with the reason as its message, when there is no
/// such program or it cannot express the case; residual and linear iterations stay 0, since CalculiX does not
/// print them.
/// @throws SolveError when it stops before the full load
cases::Solution solve_with_calculix(const cases::Scene& scene);

/// The same with the time it took, held against our finite elements, on rank 0. A solve that fails is a
/// failed answer. Collective.
/// @param fem  our answer to the same scene
Peer ask_calculix(const cases::Scene& scene, const Answer& fem);

} // namespace springproof::compare
