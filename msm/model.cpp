#include "msm/model.hpp"

#include "cases/case/error.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "msm/direct/direct_system.hpp"
#include "msm/relaxation/relaxation.hpp"

#include <algorithm>

namespace springproof::msm {

namespace {

[[noreturn]] void refuse_multigrid() {
  throw cases::InputError(
      "the multigrid path needs a body that is a grid of cells of edges, face diagonals, "
      "internal diagonals and a volume term, springs of one law, and no negative stiffness");
}

} // namespace

bool prefers_multigrid(const cases::Grid& grid, double n_nodes) {
  return n_nodes >= multigrid_from && !(grid.slenderness() > cases::Grid::thin && n_nodes <= most_factorised);
}

bool takes_multigrid(const cases::Scene& scene, const SpringBody& springs, Path wanted) {
  const std::vector<CellStiffness>* cells = springs.cells();
  const auto is_another = [&](const CellStiffness& k) {
    return !(k.exponents == cells->front().exponents) || k.edge < 0 || k.face_diagonal < 0 ||
           k.internal_diagonal < 0 || k.volume < 0;
  };
  const bool can = scene.mesh.grid && cells && std::none_of(cells->begin(), cells->end(), is_another);
  if (wanted == Path::multigrid && !can) refuse_multigrid();
  if (wanted != Path::automatic) return wanted == Path::multigrid;
  return can && prefers_multigrid(*scene.mesh.grid, double(scene.mesh.nodes.size()));
}

Model::Model(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options)
    : solver_(scene.definition.msm.solver), relaxation_(scene.definition.msm.relaxation),
      largest_turn_(cases::largest_turn(scene.definition)),
      least_steps_(cases::least_load_steps(scene.definition)), n_threads_(options.n_threads),
      sharing_(options.sharing), problem_(make_problem(scene)) {
  if (takes_multigrid(scene, springs, options.path)) {
    grid_ = grid::make_grid_problem(problem_, *springs.cells(), options.deal_out);
    system_ = grid::make_grid_system(*grid_, n_threads_);
    if (options.path == Path::automatic && !options.deal_out && scene.mesh.nodes.size() <= most_factorised)
      fallback_ = springs;
    else
      problem_.force.clear(); // the grid has its own
  } else {
    problem_.lattice = make_lattice(scene.mesh, springs);
    system_ = make_direct_system(problem_);
  }
}

cases::Solution Model::solve(const mechanics::EquilibriumSettings& settings, const Points& start) {
  try {
    return solve_on_path(settings, start);
  } catch (const cases::SolveError& error) {
    const bool may_be_multigrid = fallback_ && error.outcome() == cases::Outcome::unknown;
    if (!may_be_multigrid || system_->rest_state() != mechanics::RestState::unknown) throw;
  }
  problem_.lattice = make_lattice(problem_.mesh, *fallback_);
  fallback_.reset();
  system_ = make_direct_system(problem_);
  grid_.reset();
  return solve_on_path(settings, start);
}

cases::Solution Model::solve_on_path(mechanics::EquilibriumSettings settings, const Points& start) {
  settings = mechanics::in_small_turns(largest_turn_, least_steps_, std::move(settings));
  Vector from = Vector::Zero(system_->load().size());
  if (!start.empty())
    from = grid_ ? grid::to_field(problem_, grid_->body, start) : to_vector(problem_, start);
  const bool is_newton = solver_ == cases::Solver::newton || solver_ == cases::Solver::snes;
  if (grid_) clear_constrained(grid_->body, from);
  if (is_newton && grid_ && !grid_->supports && start.empty() && settings.first_load_step == 1)
    settings.guess = grid::coarse_guess(*grid_, n_threads_);
  const mechanics::Equilibrium found =
      system_->n_unknowns() == 0 ? mechanics::prescribed_state(*system_, from, settings)
      : is_newton   ? mechanics::find_equilibrium(*system_, from, "mass-spring equilibrium", settings)
      : relaxation_ ? relax_for(*system_, from, *relaxation_, settings)
                    : relax(*system_, from, solver_, settings);
  cases::Solution solution =
      solution_of(problem_, found,
                  grid_ ? grid::to_points(problem_, grid_->body, found.state, sharing_.get())
                        : to_points(problem_, found.state),
                  sharing_);
  if (relaxation_) solution.from_equilibrium = cases::FromEquilibrium{settings.tolerance, {}, {}, {}, {}};
  return solution;
}

} // namespace springproof::msm
