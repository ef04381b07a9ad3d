#pragma once

#include "compare/solve/answers.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "msm/model.hpp"
#include "msm/real_time/real_time.hpp"

namespace springproof::compare {

/// A design request whose K_FEM comes from the finite-element side.
/// @param cell  mm    @param element  q1 (the thesis's choice) or q1_bbar
msm::DesignRequest design_request(const cases::Material& material, const msm::CellVertices& cell,
                                  const cases::Msm& options, cases::Element element = cases::Element::q1);

/// The scene with the springs of a design, by that design's own settings.
cases::Scene with_design(cases::Scene scene, cases::Design design);

/// The stiffnesses that a scene's [msm] block asks for. On a grid all cells of a material are alike; on
/// another mesh every cell is designed for itself (linear_method, moduli, hybrid, matched). Of several
/// designs the result's own stiffness and moduli are those of the first cell, its misfit is the worst, and
/// its warnings count the cells they hold for.
/// @throws InputError when the method cannot serve the material or the mesh's cells
msm::DesignResult design_for(const cases::Scene& scene);

/// Whether the cells of a scene's design are other than four stiffnesses, so that its lattice is assembled
/// and factorised on a grid too: of some designs always, of others where the grid's cells are no cubes.
/// @param scene  whose mesh may be without nodes
bool is_assembled(const cases::Scene& scene);

/// The springs of a design as they are solved: a hard case's stiffer where it says so.
/// @param design  design_for() of the scene
msm::SpringBody springs_as_solved(const cases::Scene& scene, const msm::DesignResult& design);

/// A solver's settings with the limits of a hard case: load steps, iterations, seconds from now on. For
/// another case they stay as they are.
mechanics::EquilibriumSettings limited(const cases::Case& definition,
                                       mechanics::EquilibriumSettings settings = {});

/// The springs' solution under the full load, with its fields where the case asks for them. Collective where
/// ranks share the solution.
/// @param springs  those that were solved
/// @throws SolveError where an equilibrium's reactions do not balance the loads
cases::Solution with_fields(const cases::Scene& scene, const msm::SpringBody& springs,
                            cases::Solution solution);

/// Designs the springs of a scene and solves them in this process, which needs no finite elements: those of a
/// hard case stiffer where it says so and from where it starts, those of a dynamic case through its time.
/// @param n_threads  used by the multigrid path    @param design  absent: the caller is not told
/// @throws InputError when no springs can be designed
Answer solve_springs(const cases::Scene& scene, int n_threads, std::optional<msm::DesignResult>& design);
/// The same, with limits on steps in real time.
Answer solve_springs(const cases::Scene& scene, int n_threads, std::optional<msm::DesignResult>& design,
                     const mechanics::StepLimits& limits);

} // namespace springproof::compare
