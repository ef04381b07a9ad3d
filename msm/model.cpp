#include "msm/model.hpp"

#include "cases/case/error.hpp"
#include "msm/direct/direct_system.hpp"
#include "msm/grid/grid_system.hpp"
#include "msm/relaxation/relaxation.hpp"

#include <algorithm>

namespace springproof::msm {

namespace {

/// Nodes from which the multigrid path was measured to be the faster one.
constexpr std::size_t multigrid_from = 500;

bool has_negative_spring(const std::vector<CellStiffness>& stiffness) {
  return std::any_of(stiffness.begin(), stiffness.end(), [](const CellStiffness& k) {
    return k.edge < 0 || k.face_diagonal < 0 || k.internal_diagonal < 0 || k.volume < 0;
  });
}

Path choose_path(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness, Path wanted) {
  const bool can_multigrid = scene.mesh.grid && !has_negative_spring(stiffness);
  if (wanted == Path::multigrid && !can_multigrid)
    throw cases::InputError(
        "the multigrid path needs a body that is a grid of cells, and no negative stiffness");
  if (wanted != Path::automatic) return wanted;
  return can_multigrid && scene.mesh.nodes.size() >= multigrid_from ? Path::multigrid : Path::direct;
}

} // namespace

struct Model::Implementation {
  Path path;
  cases::Solver solver;
  int n_threads;
  Problem problem;
  std::optional<grid::GridProblem> grid;
  std::unique_ptr<SpringSystem> system;

  Implementation(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
                 const ModelOptions& options)
      : path(choose_path(scene, stiffness, options.path)), solver(scene.definition.msm.solver),
        n_threads(options.n_threads), problem(make_problem(scene)) {
    if (path == Path::direct) {
      problem.lattice = make_lattice(scene.mesh, stiffness);
      system = make_direct_system(problem);
    } else {
      grid = grid::make_grid_problem(problem, stiffness);
      system = grid::make_grid_system(*grid, n_threads);
    }
  }

  Vector to_vector(const Points& points) const {
    return grid ? grid::to_field(problem, grid->body, points) : msm::to_vector(problem, points);
  }
  Points to_points(const Vector& vector) const {
    return grid ? grid::to_points(problem, grid->body, vector) : msm::to_points(problem, vector);
  }

  mechanics::Equilibrium solve(mechanics::EquilibriumSettings settings, const Points& start) {
    const Points rest(problem.mesh.nodes.size(), Eigen::Vector3d::Zero());
    Vector from = to_vector(start.empty() ? rest : start);
    if (grid) grid::clear_constrained(grid->body, from);
    if (solver != cases::Solver::newton) return relax(*system, from, solver, settings);
    if (grid && !grid->supports && start.empty() && settings.first_load_step == 1)
      settings.guess = grid::coarse_guess(*grid, n_threads);
    return mechanics::find_equilibrium(*system, from, "mass-spring equilibrium", settings);
  }
};

Model::Model(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
             const ModelOptions& options)
    : implementation_(std::make_unique<Implementation>(scene, stiffness, options)) {}

Model::~Model() = default;
Model::Model(Model&&) noexcept = default;

Path Model::path() const {
  return implementation_->path;
}

cases::Solution Model::solve(const mechanics::EquilibriumSettings& settings, const Points& start) {
  const mechanics::Equilibrium equilibrium = implementation_->solve(settings, start);
  const std::vector<bool>& is_constrained = implementation_->problem.is_constrained;
  cases::Solution solution = mechanics::to_solution(equilibrium);
  solution.unknowns =
      static_cast<std::size_t>(std::count(is_constrained.begin(), is_constrained.end(), false));
  solution.displacement = implementation_->to_points(equilibrium.state);
  measure_cells(implementation_->problem.mesh, solution);
  return solution;
}

} // namespace springproof::msm
