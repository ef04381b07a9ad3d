#include "compare/solve/solve.hpp"

#include "compare/solve/from_equilibrium.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/solvers.hpp"
#include "compare/solve/springs.hpp"
#include "msm/model.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <utility>

namespace springproof::compare {

namespace {

/// PETSc's solver takes all ranks, the others rank 0 alone.
Answer solve_springs_on_ranks(const cases::Scene& scene, int n_threads,
                              std::optional<msm::DesignResult>& design) {
  if (scene.definition.msm.solver != cases::Solver::snes)
    return shared_from_rank_0<Answer>(scene.mesh, [&] { return solve_springs(scene, n_threads, design); });
  solvers(); // loading them is no part of the time
  const auto designed = [&] {
    design = design_for(scene);
    return *design;
  };
  Answer answer = solve_side(designed, [&](const msm::DesignResult& found) {
    return with_fields(scene, found.springs, solvers().solve_by_snes(scene, found.springs));
  });
  hold_against_loads(scene, answer,
                     [&](const cases::Solution& solution) { msm::fields(scene, design->springs, solution); });
  return answer;
}

/// Whether every node of a region is on a face of it: shared by more and more nodes, a force is a traction.
bool is_area(const cases::Selection& selection) {
  std::vector<int> on_faces;
  for (const auto& face : selection.faces) on_faces.insert(on_faces.end(), face.begin(), face.end());
  std::sort(on_faces.begin(), on_faces.end());
  return std::all_of(selection.nodes.begin(), selection.nodes.end(),
                     [&](int node) { return std::binary_search(on_faces.begin(), on_faces.end(), node); });
}

} // namespace

std::optional<std::string> reason_without_continuum_limit(const cases::Scene& scene) {
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    const auto& selection = scene.loads[i].selection;
    const cases::Load& load = scene.loads[i].load;
    const bool is_shared_by_area = cases::is<cases::loads::TotalForce>(load) && is_area(selection);
    if (load.on() == cases::loads::On::nodes && !is_shared_by_area && !load.is_zero())
      return fmt::format(
          "load[{}] is a concentrated force (on points or edges), which has no continuum limit: the "
          "displacement under it grows without bound as the mesh is refined; use a traction",
          i);
  }
  for (std::size_t i = 0; i < scene.definition.removed.size(); ++i)
    if (scene.definition.removed[i].join)
      return fmt::format(
          "body.removed[{}] is joined, and ends where cells are left: a sharp tip, about which "
          "strains grow without bound as the mesh is refined",
          i);
  for (std::size_t i = 0; i < scene.masses.size(); ++i)
    if (!is_area(scene.masses[i].selection))
      return fmt::format(
          "mass[{}] is concentrated (on points or edges): its forces have no continuum limit; give "
          "it to an area",
          i);
  for (std::size_t i = 0; i < scene.moved.size(); ++i)
    if (!is_area(scene.moved[i].selection))
      return fmt::format(
          "moved[{}] is of points or edges, which meet no resistance in the continuum: what moves "
          "with them shrinks without bound as the mesh is refined; move an area",
          i);
  return std::nullopt;
}

cases::Scene with_fem(cases::Scene scene, const cases::Fem& fem) {
  scene.definition.fem = fem;
  return scene;
}

cases::Scene with_solved_fem(cases::Scene scene) {
  scene.definition.fem.real_time.reset();
  return scene;
}

Answer before_stepped_motion(const cases::Scene& scene) {
  return gathered(solve_fem_as_given(with_solved_fem(cases::scene_before_start(scene))));
}

Answer solve_stepped_fem(const cases::Scene& scene, fem_reference::StepBy by,
                         const mechanics::StepLimits& limits) {
  const auto& dynamics = scene.definition.dynamics;
  std::vector<Eigen::Vector3d> start;
  if (dynamics && dynamics->start == cases::MotionStart::equilibrium) {
    const Answer before = before_stepped_motion(scene);
    if (!before.converged()) return before;
    start = before.solution.displacement;
  }
  return shared_from_rank_0<Answer>(scene.mesh, [&] {
    std::unique_ptr<fem_reference::SteppedElements> elements;
    Answer answer = solve_side(
        [&] {
          const cases::ElementRealTime& steps = *scene.definition.fem.real_time;
          elements = std::make_unique<fem_reference::SteppedElements>(scene, steps, 1);
          return elements.get();
        },
        [&](fem_reference::SteppedElements* of) {
          return dynamics ? of->follow(start, by, limits) : of->come_to_rest(limits);
        });
    if (answer.solution.from_equilibrium) // outside of the time that the iterations took
      add_distance(answer.solution, "the same elements", [&] { return elements->equilibrium(); });
    return answer;
  });
}

Answer solve_fem_as_given(const cases::Scene& scene) {
  if (scene.definition.fem.real_time) return solve_stepped_fem(scene);
  solvers(); // loading them is no part of the time
  if (scene.definition.dynamics)
    return solve_side([&] { return std::cref(scene); },
                      [](const cases::Scene& of) { return solvers().follow_finite_elements(of); });
  const auto settings = limited(scene.definition, fem_reference::default_settings());
  decltype(make_finite_elements(scene)) solved;
  Answer answer = solve_side([&] { return make_finite_elements(scene); },
                             [&](auto& model) {
                               solved = std::move(model);
                               cases::Solution solution = solved->solve(settings);
                               if (scene.definition.has_fields)
                                 solution.fields = solved->fields(solution.sharing.get());
                               return solution;
                             });
  hold_against_loads(scene, answer,
                     [&](const cases::Solution& solution) { solved->fields(solution.sharing.get()); });
  return answer;
}

Answers solve(const cases::Scene& scene, const Request& request, SolveFem solve_fem, const KeptMeshes& kept,
              AskPeer ask_peer) {
  Answers answers;
  answers.resolved = scene.definition.fem;
  if (request.asks(cases::Side::fem)) answers = solve_fem(scene, request.meshes, kept);
  if (request.asks(cases::Side::msm))
    answers.msm = solve_springs_on_ranks(scene, request.n_threads, answers.design);
  if (!request.peer.empty() && ask_peer)
    answers.peer = ask_peer(with_fem(scene, answers.resolved), answers.fem);
  return answers;
}

} // namespace springproof::compare
