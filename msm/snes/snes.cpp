#include "msm/snes/snes.hpp"

#include "msm/snes/snes_problem.hpp"

#include <algorithm>

namespace springproof::msm {

cases::Solution solve_by_snes(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
                              MPI_Comm communicator, const mechanics::EquilibriumSettings& settings,
                              const Points& start) {
  Problem problem = make_problem(scene);
  problem.lattice = make_lattice(scene.mesh, stiffness);
  SnesProblem system(problem, settings, communicator);
  const mechanics::Equilibrium equilibrium =
      mechanics::find_equilibrium(system, system.state(start), "mass-spring equilibrium by SNES", settings);
  cases::Solution solution = mechanics::to_solution(equilibrium);
  solution.unknowns =
      static_cast<std::size_t>(std::count(problem.is_fixed.begin(), problem.is_fixed.end(), false));
  solution.displacement = system.displacement(equilibrium.state);
  measure_cells(scene.mesh, solution);
  return solution;
}

} // namespace springproof::msm
