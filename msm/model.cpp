#include "msm/model.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/field_sums.hpp"
#include "msm/direct/direct_system.hpp"
#include "msm/direct/patched_system.hpp"
#include "msm/grid/moving_grid.hpp"
#include "msm/real_time/real_time.hpp"
#include "msm/relaxation/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace springproof::msm {

namespace {

/// Whether multigrid knows what a case asks for, whatever its springs are.
bool knows(const cases::Case& definition) {
  return !cases::has_memory(definition) && (definition.tools.empty() || definition.dynamics);
}

} // namespace

bool prefers_multigrid(const cases::Case& definition, const cases::Grid& grid, double n_nodes) {
  return knows(definition) && n_nodes >= multigrid_from &&
         !(grid.slenderness() > cases::Grid::thin && n_nodes <= most_factorised);
}

bool takes_multigrid(const cases::Scene& scene, const SpringBody& springs, Path wanted) {
  const std::vector<CellStiffness>* cells = springs.cells();
  const auto is_another = [&](const CellStiffness& cell) {
    const std::array<double, 3> k = cell.springs();
    return !(cell.exponents == cells->front().exponents) || *std::min_element(k.begin(), k.end()) < 0 ||
           cell.volume < 0;
  };
  const bool can = scene.mesh.grid && cells && knows(scene.definition) &&
                   std::none_of(cells->begin(), cells->end(), is_another);
  if (wanted == Path::multigrid && !can)
    throw cases::InputError(
        "the multigrid path needs a body that is a grid of cells of edges, face diagonals, "
        "internal diagonals and a volume term, springs of one law, no negative stiffness, "
        "a material without prony and, in statics, a case without tools");
  if (wanted != Path::automatic) return wanted == Path::multigrid;
  return can && prefers_multigrid(scene.definition, *scene.mesh.grid, double(scene.mesh.nodes.size()));
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
    const bool is_iterated = options.path == Path::automatic && !problem_.contact &&
                             takes_patched_system(problem_.lattice) &&
                             problem_.lattice.volume_patches.size() >= patches_iterated_from;
    system_ = is_iterated ? make_patched_system(problem_) : make_direct_system(problem_);
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
  const auto in_contact = [&] {
    if (problem_.contact) problem_.contact->forget();
    const auto displacement_of = [&](const Vector& state) -> mechanics::DisplacementAt {
      return [points = to_points(problem_, state)](int node) { return points[cases::index(node)]; };
    };
    return mechanics::find_equilibrium_in_contact(*system_, problem_.contact.get(), displacement_of, from,
                                                  "mass-spring equilibrium", settings);
  };
  const mechanics::Equilibrium found = system_->n_unknowns() == 0
                                           ? mechanics::prescribed_state(*system_, from, settings)
                                       : is_newton   ? in_contact()
                                       : relaxation_ ? relax_for(*system_, from, *relaxation_, settings)
                                                     : relax(*system_, from, solver_, settings);
  cases::Solution solution =
      solution_of(problem_, found,
                  grid_ ? grid::to_points(problem_, grid_->body, found.state, sharing_.get())
                        : to_points(problem_, found.state),
                  sharing_);
  if (problem_.contact)
    solution.tools = problem_.contact->found(
        [&](int node) { return solution.displacement[cases::index(node)]; }, settings.to);
  if (relaxation_) solution.from_equilibrium = cases::FromEquilibrium{settings.tolerance, {}, {}, {}, {}, {}};
  return solution;
}

MovingBody::MovingBody(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options)
    : problem_(make_moving_problem(scene)) {
  const SpringBody damping = damping_springs(scene, springs);
  const auto& real_time = scene.definition.msm.real_time;
  if (!real_time && takes_multigrid(scene, springs, options.path)) {
    grid_ = grid::make_grid_problem(problem_, *springs.cells());
    vectors_.emplace(grid_->body);
    auto statics = grid::make_grid_system(*grid_, options.n_threads);
    motion_ = grid::make_moving_grid(problem_, *grid_, *vectors_, *statics, make_inertia(scene, {}),
                                     *damping.cells(), options.n_threads);
    statics_ = std::move(statics);
  } else {
    problem_.lattice = make_lattice(scene.mesh, springs);
    statics_ = make_direct_system(problem_);
    auto memory = cases::has_memory(scene.definition)
                      ? std::make_unique<SpringMemory>(scene, springs, problem_.lattice)
                      : nullptr;
    motion_ = make_moving_lattice(problem_, *statics_, make_inertia(scene, make_lattice(scene.mesh, damping)),
                                  std::move(memory));
    if (real_time) motion_->step_by(step_method(*real_time, problem_, options.n_threads));
  }
  find_entries();
  if (!scene.definition.tools.empty())
    motion_->press_by(mechanics::Contact(mechanics::tool_sides(scene)), entries_);
}

/// What the places of a vector become as points says where they are.
void MovingBody::find_entries() {
  const Vector places = Vector::LinSpaced(size(), 1, static_cast<double>(size()));
  Vector room;
  const Points at = grid_ ? grid::to_points(problem_, grid_->body, vectors_->to_field(places, room))
                          : msm::to_points(problem_, places);
  for (const Eigen::Vector3d& of_point : at) {
    entries_.emplace_back();
    for (int c = 0; c < 3; ++c) entries_.back()[cases::index(c)] = std::lround(of_point[c]) - 1;
  }
}

Vector MovingBody::to_vector(const Points& points) const {
  Vector vector = Vector::Zero(size());
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int c = 0; c < 3; ++c)
      if (const Eigen::Index entry = entries_[p][cases::index(c)]; entry >= 0) vector[entry] = points[p][c];
  return vector;
}

Eigen::Vector3d MovingBody::at_node(const Vector& vector, int node) const {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c)
    if (const Eigen::Index entry = entries_[cases::index(node)][cases::index(c)]; entry >= 0)
      value[c] = vector[entry];
  return value;
}

Points MovingBody::to_points(const Vector& vector) const {
  Points points;
  points.reserve(entries_.size());
  for (std::size_t node = 0; node < entries_.size(); ++node)
    points.push_back(at_node(vector, static_cast<int>(node)));
  return points;
}

Pull& MovingBody::hold(const std::vector<cases::NodeWeight>& place, double stiffness) {
  Pull::Entries entries;
  for (const auto& [node, weight] : place)
    for (std::size_t c = 0; c < 3; ++c)
      if (const Eigen::Index at = entries_[cases::index(node)][c]; at >= 0)
        entries[c].push_back({at, weight, !problem_.is_constrained[3 * cases::index(node) + c]});
  return motion_->hold({std::move(entries), stiffness});
}

namespace {

/// Displacement when the motion begins, mm, one per point.
Points start_of(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options,
                const mechanics::IntegrationSettings& steps) {
  if (scene.definition.dynamics->start == cases::MotionStart::rest)
    return Points(scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
  // What a step in real time may leave is no equilibrium.
  const auto settings = steps.enough_linear_iterations ? mechanics::EquilibriumSettings{} : steps.newton;
  return Model(cases::scene_before_start(scene), springs, options).solve(settings).displacement;
}

/// Volume of a body, mm³.  @param displacement  mm, one per node
double volume_of(const cases::Mesh& mesh, const Points& displacement) {
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    sum += cases::cell_volume(cases::cell_corners(mesh, c, displacement));
  return sum;
}

cases::Solution follow(const cases::Scene& scene, MovingBody& body, const Points& start,
                       const mechanics::IntegrationSettings& settings) {
  const auto points = [&](const Vector& state) { return body.to_points(state); };
  const mechanics::FollowedMotion followed = mechanics::follow_motion(
      scene,
      {body.motion(), points,
       [&](const Vector& state) { return volume_of(body.problem().mesh, points(state)); }},
      body.to_vector(start), settings);
  cases::Solution solution = solution_of(body.problem(), followed.work, points(followed.end));
  solution.trajectory = followed.trajectory;
  solution.tools = body.motion().tools_at(solution.trajectory->time.back(), followed.end);
  return solution;
}

} // namespace

cases::Solution follow(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options,
                       const mechanics::IntegrationSettings& settings) {
  ModelOptions directly = options;
  directly.path = Path::direct;
  MovingBody body(scene, springs, options);
  try {
    return follow(scene, body, start_of(scene, springs, body.is_on_grid() ? options : directly, settings),
                  settings);
  } catch (const cases::SolveError&) {
    const bool may_be_factorised =
        body.is_on_grid() && options.path == Path::automatic && scene.mesh.nodes.size() <= most_factorised;
    if (!may_be_factorised || !body.motion().has_failed()) throw;
  }
  return follow(scene, springs, directly, settings);
}

namespace {

using cases::index;
using Eigen::Vector3d;

/// A cell as its first vertex sees it, at rest and displaced: far from the origin positions have lost digits.
struct SeenCell {
  cases::CellCorners rest, motion, now; ///< mm
  /// @param displacement  one per node from first_node on
  SeenCell(const cases::Mesh& mesh, std::size_t cell, const Points& displacement, std::size_t first_node) {
    const cases::CellNodes nodes = mesh.cells[cell];
    const auto moved = [&](int node) -> const Vector3d& { return displacement[index(node) - first_node]; };
    const Vector3d corner = mesh.nodes[index(nodes[0])];
    for (const int node : nodes) {
      rest.push_back(mesh.nodes[index(node)] - corner);
      motion.push_back(moved(node) - moved(nodes[0]));
      now.push_back(rest.back() + motion.back());
    }
  }
};

/// Adds what a cell is without its springs.
void add_shape(mechanics::CellSums& sum, const SeenCell& cell) {
  sum.rest_volume() = cases::cell_volume(cell.rest);
  sum.volume() = cases::cell_volume(cell.now);
  const auto gradient = volume_gradient(cell.rest); // integrals of grad N_a, mm²
  for (std::size_t v = 0; v < gradient.size(); ++v)
    sum.gradient() += cell.motion[v] * gradient[v].transpose();
}

mechanics::FieldsOf how_of(const cases::Scene& scene, const cases::Solution& solution, double load_factor) {
  return {load_factor, mechanics::StrainMeasure::logarithmic, scene.definition.msm.mass,
          solution.status == cases::Status::converged && solution.is_equilibrium()
              ? mechanics::Balance::at_nodes
              : mechanics::Balance::not_asked,
          solution.tools};
}

/// What the patches about nodes have of an answer.
struct AtNode {
  double pressure = 0; ///< derivative of the energy density by the volume ratio, MPa
  double energy = 0;   ///< per rest volume, MPa
};

/// One per node of the mesh; empty where no volume term is at nodes.
std::vector<AtNode> patches_at_nodes(const cases::Scene& scene, const SpringBody& springs,
                                     const cases::Solution& solution) {
  if (!has_volume_patches(springs)) return {};
  const Points displacement =
      solution.sharing ? solution.sharing->gather(solution.displacement) : solution.displacement;
  std::vector<AtNode> all(scene.mesh.nodes.size());
  const Lattice lattice = make_lattice(scene.mesh, springs);
  for (const VolumePatch& patch : lattice.volume_patches) {
    Points rest = at_nodes(patch.nodes, lattice.rest), motion = at_nodes(patch.nodes, displacement);
    for (std::size_t v = rest.size(); v-- > 0;) rest[v] -= rest[0], motion[v] -= motion[0];
    const VolumeLaw law = patch.law_at(rest, motion);
    all[index(patch.nodes[0])] = {patch.stiffness * law.pressure, patch.stiffness * law.integral};
  }
  return all;
}

/// Adds what the patches of a cell's nodes give it: a quarter of its volume each.
void add_patches(mechanics::FieldSums& sums, std::size_t c, const SeenCell& cell,
                 const cases::CellNodes& nodes, const std::vector<AtNode>& patches) {
  mechanics::CellSums& sum = sums.cell(c);
  double pressure = 0;
  for (const int node : nodes) {
    pressure += patches[index(node)].pressure / 4;
    sum.energy() += cases::cell_volume(cell.rest) * patches[index(node)].energy / 4;
  }
  const auto gradient = volume_gradient(cell.now);
  for (std::size_t v = 0; v < nodes.size(); ++v) {
    sum.virial() += pressure * gradient[v] * cell.now[v].transpose();
    sums.force(index(nodes[v])) += pressure * gradient[v];
  }
}

cases::Fields fields_of_cells(const cases::Scene& scene, const SpringBody& springs,
                              const cases::Solution& solution, double load_factor) {
  const cases::Sharing* const sharing = solution.sharing.get();
  const cases::Share here = cases::share_here(scene.mesh, sharing);
  mechanics::FieldSums sums(here.nodes, here.cells);
  const std::vector<AtNode> patches = patches_at_nodes(scene, springs, solution);
  for_each_cell(scene.mesh, springs, here.cells, [&](std::size_t c, const CellTerms& designed) {
    CellTerms terms = designed;
    if (!patches.empty()) terms.volume = 0;
    const SeenCell cell(scene.mesh, c, solution.displacement, here.nodes.begin);
    mechanics::CellSums& sum = sums.cell(c);
    add_shape(sum, cell);
    const Lattice lattice = cell_lattice(terms, cell.rest);
    const Points motion(cell.motion.begin(), cell.motion.end()), force = internal_force_at(lattice, motion);
    sum.energy() += energy_at(lattice, motion);
    const cases::CellNodes nodes = scene.mesh.cells[c];
    if (!patches.empty()) add_patches(sums, c, cell, nodes, patches);
    for (std::size_t v = 0; v < nodes.size(); ++v) {
      sum.virial() -= force[v] * cell.now[v].transpose();
      sums.force(index(nodes[v])) -= force[v];
    }
  });
  return mechanics::fields_of(scene, std::move(sums), sharing, how_of(scene, solution, load_factor));
}

cases::Fields fields_of_network(const cases::Scene& scene, const Lattice& network,
                                const cases::Solution& solution, double load_factor) {
  const cases::Sharing* const sharing = solution.sharing.get();
  const cases::Share here = cases::share_here(scene.mesh, sharing);
  mechanics::FieldSums sums(here.nodes, here.cells);
  for (std::size_t c = here.cells.begin; c < here.cells.end; ++c)
    add_shape(sums.cell(c), SeenCell(scene.mesh, c, solution.displacement, here.nodes.begin));
  // A spring may end anywhere: every rank, which has all springs, takes all nodes for once.
  const Points all = sharing ? sharing->gather(solution.displacement) : solution.displacement;
  const Points force = internal_force_at(network, all);
  for (std::size_t node = here.own_nodes.begin; node < here.own_nodes.end; ++node)
    sums.force(node) = -force[node];
  cases::Fields fields =
      mechanics::fields_of(scene, std::move(sums), sharing, how_of(scene, solution, load_factor));
  fields.total_energy = energy_at(network, all);
  fields.has_stress = false;
  fields.strain_energy.clear();
  fields.stress.clear();
  return fields;
}

} // namespace

cases::Fields fields(const cases::Scene& scene, const SpringBody& springs, const cases::Solution& solution,
                     double load_factor) {
  return springs.network()
             ? fields_of_network(scene, make_lattice(scene.mesh, springs), solution, load_factor)
             : fields_of_cells(scene, springs, solution, load_factor);
}

} // namespace springproof::msm
