#pragma once

#include "cases/scene/scene.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

/// What can be known of a finite-element model before there is one: no deal.II, no PETSc.
namespace springproof::fem_reference {

/// The usual limits of a path of finite elements. Small load steps follow a path that large ones would leave;
/// with Stability::report negative eigenvalues are counted, which may cost a factorisation.
mechanics::EquilibriumSettings default_settings();

enum class Backend {
  automatic, ///< grid where the body is one and the element is known to it, else or if that fails assembled
  assembled, ///< any mesh: assembled tangent; a sparse factorisation, or algebraic multigrid for large bodies
  grid       ///< grids of equal cuboids: geometric multigrid, no factorisation
};

/// What `automatic` means for a scene's body and element.
/// @param n_nodes  number of the elements' nodes after fem.refine; the scene's own mesh may have no nodes
Backend choose_backend(const cases::Scene& scene, double n_nodes);

/// The backend of a scene with its mesh: the one asked for, or what `automatic` means for the scene.
/// @throws InputError if the grid backend is asked for and cannot serve this scene
Backend backend_of(const cases::Scene& scene, Backend asked);

/// Remark on a solution that the assembled backend gave in place of the grid backend.
constexpr const char* by_assembled_tangent =
    "by the assembled tangent: the matrix-free multigrid does not converge for this body";

/// Most unknowns that MUMPS factorises by default; above it multigrid-preconditioned Krylov methods run.
/// Cubes of 26,460 and 86,490 unknowns (compressible, one thread) were measured to take 1.0 and 1.5 times as
/// long with MUMPS as with multigrid, the larger one 1.3 GB; below the limit the factorisation's indifference
/// to near incompressibility, and its count of negative eigenvalues, are worth that.
constexpr long direct_solver_limit = 120000;

/// The bulk modulus over the shear modulus above which the grid's iterations are too many, for bodies that
/// can be factorised: 25 a linear solve at 1000, Newton's method fails at 5000.
constexpr double most_incompressible = 1500;

/// Number of times the edges of a mesh's cells are halved by nodes: by fem.refine, and by quadratic elements.
int n_halvings(const cases::Fem& fem);

/// Approximate number of element nodes after fem.refine, which decides between backends and solvers.
/// @param n_nodes  number of the mesh's nodes
double n_element_nodes(const cases::Fem& fem, double n_nodes);
inline double n_element_nodes(const cases::Scene& scene) {
  return n_element_nodes(scene.definition.fem, double(scene.mesh.nodes.size()));
}

/// Whether the assembled backend factorises a tangent of that many nodes. It does always where pressures are
/// unknowns beside the displacement: that tangent is indefinite, and multigrid does not take it.
bool takes_factorisation(double n_nodes, const cases::Fem& fem);

} // namespace springproof::fem_reference
