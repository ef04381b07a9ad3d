#include "compare/solve/solve.hpp"

#include "compare/provenance/mpi_rank.hpp"
#include "compare/solve/design.hpp"
#include "compare/solve/refined_meshes.hpp"
#include "compare/solve/solve_side.hpp"
#include "compare/solve/springs.hpp"
#include "fem_reference/model.hpp"
#include "msm/snes/snes.hpp"

namespace springproof::compare {

namespace {

/// PETSc's solver takes all ranks, the others rank 0 alone.
Answer solve_springs_on_ranks(const cases::Scene& scene, int n_threads,
                              std::optional<msm::DesignResult>& design) {
  if (scene.definition.msm.solver != cases::Solver::snes)
    return mpi_rank() == 0 ? solve_springs(scene, n_threads, design) : Answer{};
  const auto designed = [&] {
    design = design_for(scene);
    return stiffness_of_cells(*design);
  };
  return solve_side(designed, [&](const std::vector<msm::CellStiffness>& stiffness) {
    return msm::solve_by_snes(scene, stiffness, MPI_COMM_WORLD);
  });
}

} // namespace

FemAnswer solve_fem_as_given(const cases::Scene& scene) {
  const auto settings = limited(scene.definition, fem_reference::default_settings());
  return {solve_side([&] { return fem_reference::Model(scene, MPI_COMM_WORLD); },
                     [&](fem_reference::Model& model) { return model.solve(settings); }),
          scene.definition.fem,
          {}};
}

Answers solve(const cases::Scene& scene, const Request& request, SolveFem solve_fem) {
  Answers answers;
  answers.resolved = scene.definition.fem;
  if (request.asks(cases::Side::fem)) {
    FemAnswer fem = solve_fem(scene);
    answers.fem = std::move(fem.answer);
    answers.resolved = fem.resolved;
    answers.choices = std::move(fem.choices);
  }
  if (request.asks(cases::Side::msm))
    answers.msm = solve_springs_on_ranks(scene, request.n_threads, answers.design);
  if (request.meshes > 0)
    answers.refined = solve_refined(with_fem(scene, answers.resolved), answers.fem.solution, request.meshes);
  return answers;
}

} // namespace springproof::compare
