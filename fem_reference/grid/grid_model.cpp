#include "fem_reference/grid/grid_model.hpp"

#include "cases/mesh/hex_mesh.hpp"
#include "cases/scene/in_time.hpp"
#include "fem_reference/grid/coarse_guess.hpp"
#include "fem_reference/grid/grid_equations.hpp"
#include "fem_reference/grid/on_grid.hpp"
#include "mechanics/equilibrium/turns.hpp"
#include "mechanics/ranks/share_out.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace springproof::fem_reference::grid {

namespace {

using cases::index;
using mechanics::Vector;

bool is_quadratic(const cases::Scene& scene) {
  return scene.definition.fem.element == cases::Element::q2;
}

/// Every rank's numbers, one after the other.
std::vector<double> gather(const std::vector<double>& own, MPI_Comm communicator) {
  int n_ranks = 1;
  MPI_Comm_size(communicator, &n_ranks);
  const int n = static_cast<int>(own.size());
  std::vector<int> counts(index(n_ranks)), places(index(n_ranks) + 1);
  MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
  std::partial_sum(counts.begin(), counts.end(), places.begin() + 1);
  std::vector<double> all(index(places.back()));
  MPI_Allgatherv(own.data(), n, MPI_DOUBLE, all.data(), counts.data(), places.data(), MPI_DOUBLE,
                 communicator);
  return all;
}

} // namespace

struct GridModel::Implementation {
  Implementation(const cases::Scene& the_scene, MPI_Comm the_communicator, int threads)
      : scene(the_scene), communicator(the_communicator), n_threads(threads),
        cell_factor(1 << scene.definition.fem.refine), factor(cell_factor * (is_quadratic(scene) ? 2 : 1)),
        body(make_body(factor, deal(cells_along(factor), communicator, factor / cell_factor))),
        places{scene.mesh.grid->origin, scene.mesh.grid->spacing / factor, body},
        supported(make_supported(cases::refine(scene, scene.definition.fem.refine), is_quadratic(scene),
                                 places, body)),
        quadratic(is_quadratic(scene) ? make_quadratic() : nullptr),
        equations(body, supported, n_threads, quadratic.get()), last(equations.rest()) {}

  cases::Scene scene; ///< on the body's own mesh
  MPI_Comm communicator;
  int n_threads;
  int cell_factor; ///< elements along an edge of the body's own cells
  int factor;      ///< the same of the grid of nodes
  Body body;
  Places places;
  Supported supported;
  std::unique_ptr<QuadraticElements> quadratic;
  GridEquations equations;
  Vector last;
  double last_load_factor = 0;

  Eigen::Vector3d displacement_at(const Place& at, const Vector& state) const {
    const std::ptrdiff_t entry = places.entry(at), size = body.layout.size;
    return {state[entry], state[entry + size], state[entry + 2 * size]};
  }
  std::array<int, 3> cells_along(int along) const {
    std::array<int, 3> cells = scene.mesh.grid->cells;
    for (int& n : cells) n *= along;
    return cells;
  }
  Body make_body(int cells_along_edge, const Slab& of_nodes) const {
    return make_body(cells_along_edge, of_nodes, of_nodes.first_of_grid());
  }
  Body make_body(int cells_along_edge, const Slab& of_nodes, int first_layer) const;
  std::unique_ptr<QuadraticElements> make_quadratic() const;
  std::vector<cases::Numbered<double>> cell_volumes(const Vector& state, const cases::Sharing* sharing) const;
  std::vector<cases::Numbered<Eigen::Vector3d>> displacements(const Vector& state,
                                                              const cases::Sharing* sharing) const;
  mechanics::StateOnMesh on_mesh() const;
  Vector start_of_motion(const mechanics::EquilibriumSettings& settings) const;

  struct OwnElement {
    std::size_t cell;        ///< of the body's own mesh
    std::array<int, 3> part; ///< of the cell
    std::array<int, 3> at;   ///< of the grid of elements
    std::size_t entry;       ///< of the elements' layout
  };
  template<class Action>
  void for_each_own_element(const cases::Sharing* sharing, const Action& action) const;
};

/// @param first_layer  of the grid's layers of cells, the first that the slab holds
Body GridModel::Implementation::make_body(int along, const Slab& of_nodes, int first_layer) const {
  const cases::Grid& grid = *scene.mesh.grid;
  const cases::Element element = scene.definition.fem.element;
  const auto materials = cases::materials_of(scene.definition);
  Body made(cells_along(along), of_nodes, grid.spacing / along, law_of(scene.definition.fem.formulation),
            element == cases::Element::q1_bbar || element == cases::Element::q1_p0);
  const bool is_uniform = scene.material_of_cell.empty();
  made.parameters = parameters_of(materials.front());
  made.n_parameters = static_cast<int>(made.parameters.size());
  const auto n_entries = index(made.layout.n_cell_entries());
  if (!is_uniform) made.parameters.assign(index(made.n_parameters) * n_entries + 16, 0.);
  std::vector<std::vector<double>> values;
  for (const auto& material : materials) values.push_back(parameters_of(material));
  std::size_t cell = 0;
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) {
        if (!grid.has(i, j, k)) continue;
        const auto material = is_uniform ? 0 : index(scene.material_of_cell[cell]);
        ++cell;
        for (int c = 0; c < along; ++c) {
          const int layer = along * k + c - first_layer;
          if (layer < 0 || layer >= made.cells[2]) continue;
          for (int b = 0; b < along; ++b)
            for (int a = 0; a < along; ++a) {
              const auto entry = index(made.layout.cell(along * i + a, along * j + b, layer));
              made.weight[entry] = 1;
              if (is_uniform) continue;
              for (std::size_t p = 0; p < index(made.n_parameters); ++p)
                made.parameters[p * n_entries + entry] = values[material][p];
            }
        }
      }
  return made;
}

std::unique_ptr<QuadraticElements> GridModel::Implementation::make_quadratic() const {
  const Slab& slab = body.slab;
  const auto [begin, end] = slab.computed();
  const int first = slab.first_of_grid() + begin,
            beyond = std::min(slab.first_of_grid() + end, slab.n_planes_of_grid() - 1);
  return std::make_unique<QuadraticElements>(
      body, make_body(cell_factor, Slab((beyond - first) / 2 + 1), first / 2), n_threads);
}

GridModel::GridModel(const cases::Scene& scene, MPI_Comm communicator, int n_threads)
    : implementation_(std::make_unique<Implementation>(scene, communicator, n_threads)) {}
GridModel::~GridModel() = default;

const cases::Scene& GridModel::scene() const {
  return implementation_->scene;
}

void GridModel::back_to_rest() {
  implementation_->last = implementation_->equations.rest();
  implementation_->last_load_factor = 0;
}

/// Displacements of the body's nodes that the rank computes. Where every rank computes all, of those that are
/// its own.
std::vector<cases::Numbered<Eigen::Vector3d>>
GridModel::Implementation::displacements(const Vector& state, const cases::Sharing* sharing) const {
  const bool is_dealt_out = body.slab.is_shared();
  std::vector<cases::Numbered<Eigen::Vector3d>> own;
  for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
    if (!is_dealt_out && sharing && !sharing->here().own_nodes.has(n)) continue;
    const Place at = places.of(scene.mesh.nodes[n]);
    if (places.owns(at)) own.push_back({static_cast<std::int64_t>(n), displacement_at(at, state)});
  }
  return own;
}

/// Calls action(OwnElement) for the elements that the rank computes, cell by cell. Where every rank computes
/// all, for those of the cells that are its own.
template<class Action>
void GridModel::Implementation::for_each_own_element(const cases::Sharing* sharing,
                                                     const Action& action) const {
  const Slab& slab = body.slab;
  const Layout& layout = quadratic ? quadratic->cells().layout : body.layout;
  // the rank's elements have layers of their own
  const Slab::Range layers = quadratic ? Slab::Range{0, quadratic->cells().cells[2]} : slab.own_layers();
  const int first = quadratic ? (slab.first_of_grid() + slab.computed().begin) / 2 : slab.first_of_grid();
  const cases::Grid& grid = *scene.mesh.grid;
  const int n = cell_factor;
  std::size_t next = 0;
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) {
        if (!grid.has(i, j, k)) continue;
        const std::size_t cell = next++;
        if (!slab.is_shared() && sharing && !sharing->here().cells.has(cell)) continue;
        for (int c = 0; c < n; ++c) {
          const int layer = n * k + c - first;
          if (layer < layers.begin || layer >= layers.end) continue;
          for (int b = 0; b < n; ++b)
            for (int a = 0; a < n; ++a)
              action(OwnElement{cell,
                                {a, b, c},
                                {n * i + a, n * j + b, n * k + c},
                                index(layout.cell(n * i + a, n * j + b, layer))});
        }
      }
}

/// Volumes of the body's cells; of each as much as the rank computes.
std::vector<cases::Numbered<double>>
GridModel::Implementation::cell_volumes(const Vector& state, const cases::Sharing* sharing) const {
  const std::vector<double> of_entries = equations.cell_volumes(state);
  std::vector<cases::Numbered<double>> volumes;
  for_each_own_element(sharing, [&](const OwnElement& element) {
    const auto cell = static_cast<std::int64_t>(element.cell);
    if (volumes.empty() || volumes.back().number != cell) volumes.push_back({cell, 0.});
    volumes.back().value += of_entries[element.entry];
  });
  return volumes;
}

mechanics::StateOnMesh GridModel::Implementation::on_mesh() const {
  auto sharing = mechanics::share_out(scene.mesh, communicator);
  const cases::Sharing* const shared = sharing.get();
  return {scene.mesh,
          std::move(sharing),
          {[this, shared](const Vector& state) { return displacements(state, shared); },
           [this, shared](const Vector& state) { return cell_volumes(state, shared); }}};
}

double GridModel::load_factor() const {
  return implementation_->last_load_factor;
}

cases::Range GridModel::cells(const cases::Sharing* sharing) const {
  std::optional<cases::Range> cells;
  implementation_->for_each_own_element(sharing, [&](const Implementation::OwnElement& element) {
    if (!cells) cells = cases::Range{element.cell, element.cell}; // they come in ascending order
    cells->end = element.cell + 1;
  });
  return cells.value_or(cases::Range{});
}

void GridModel::for_each_element(const cases::Sharing* sharing,
                                 const std::function<void(const Element&)>& action) const {
  const Implementation& m = *implementation_;
  const int degree = m.factor / m.cell_factor, n = degree + 1;
  std::vector<double> displacement(index(3 * n * n * n));
  m.for_each_own_element(sharing, [&](const Implementation::OwnElement& element) {
    double* to = displacement.data();
    for (int a = 0; a < n * n * n; ++a, to += 3) {
      const Place node(degree * element.at[0] + a % n, degree * element.at[1] + a / n % n,
                       degree * element.at[2] + a / (n * n));
      Eigen::Map<Eigen::Vector3d>{to} = m.displacement_at(node, m.last);
    }
    const double pressure =
        m.body.has_modes ? m.last[m.equations.n_displacements() + Eigen::Index(element.entry)] : 0;
    action({element.cell, element.part, m.cell_factor, displacement, pressure});
  });
}

bool GridModel::can_leave_rest() {
  GridEquations& equations = implementation_->equations;
  constexpr double part = 1e-6; // of the load: so small that Newton's step is the answer to it
  constexpr double forcing = 1e-3, enough = 0.1;
  const Vector rest = equations.rest();
  equations.forget_tangent();
  const Vector residual = equations.residual(rest, part, mechanics::Expect::direction);
  const auto step = equations.direction(rest, residual, part, forcing, mechanics::Convexity::exact);
  if (!step) return false;
  const Vector left = equations.residual(rest + *step, part, mechanics::Expect::residual);
  return equations.dot(left, left) <= enough * enough * equations.dot(residual, residual);
}

/// The state when the motion begins: of the static scene, whose states are of the same nodes and cells.
Vector GridModel::Implementation::start_of_motion(const mechanics::EquilibriumSettings& settings) const {
  if (scene.definition.dynamics->start == cases::MotionStart::rest) return equations.rest();
  GridModel still(cases::scene_before_start(scene), communicator, n_threads);
  still.solve(1, settings);
  return still.implementation_->last;
}

cases::Solution GridModel::follow(const mechanics::IntegrationSettings& settings) {
  Implementation& m = *implementation_;
  m.equations.set_in_motion(cases::refine(m.scene, m.scene.definition.fem.refine), m.places);
  m.equations.set_volume_tolerance(volume_tolerance_of(settings.newton.tolerance));
  m.last = m.start_of_motion(settings.newton);
  return mechanics::follow_motion(m.scene, m.equations, m.on_mesh(), m.last, settings);
}

bool GridModel::linear_solver_failed() const {
  return implementation_->equations.linear_solver_failed();
}

cases::Solution GridModel::solve(double load_factor, const mechanics::EquilibriumSettings& given) {
  Implementation& m = *implementation_;
  mechanics::EquilibriumSettings settings = given;
  settings.from = m.last_load_factor;
  settings.to = load_factor;
  settings = mechanics::in_small_turns(cases::largest_turn(m.scene.definition),
                                       cases::least_load_steps(m.scene.definition), std::move(settings));
  if (settings.from == 0 && settings.first_load_step == 1 && m.body.law != Law::small_strain) {
    CoarseGuess coarse = coarse_guess(m.body, m.supported, load_factor, m.n_threads);
    settings.guess = std::move(coarse.state);
    settings.first_load_step = coarse.first_load_step;
  }
  const auto equilibrium = mechanics::find_equilibrium(m.equations, m.last, "finite elements", settings);
  m.last = equilibrium.state;
  m.last_load_factor = load_factor;
  cases::Solution solution = mechanics::to_solution(equilibrium);
  m.on_mesh().add_to(solution, m.last);
  if (settings.stability != mechanics::Stability::ignore)
    solution.negative_eigenvalues = m.equations.negative_eigenvalues();
  return solution;
}

std::vector<GridModel::NodeValue> GridModel::node_displacements() const {
  const Implementation& m = *implementation_;
  std::vector<double> numbers;
  m.places.for_each([&](const Place& at) {
    const Eigen::Vector3d rest = m.places.rest(at), displacement = m.displacement_at(at, m.last);
    numbers.insert(numbers.end(), rest.begin(), rest.end());
    numbers.insert(numbers.end(), displacement.begin(), displacement.end());
  });
  if (m.body.slab.is_shared()) numbers = gather(numbers, m.communicator);
  std::vector<NodeValue> values;
  for (const double* at = numbers.data(); at != numbers.data() + numbers.size(); at += 6)
    values.push_back({Eigen::Vector3d(at), Eigen::Vector3d(at + 3)});
  return values;
}

} // namespace springproof::fem_reference::grid
