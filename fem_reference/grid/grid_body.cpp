#include "fem_reference/grid/grid_body.hpp"

#include "cases/mesh/mesh.hpp"
#include "fem_reference/cuboid.hpp"
#include "fem_reference/grid/on_grid.hpp"
#include "mechanics/ranks/share_out.hpp"
#include "mechanics/shape_products.hpp"

#include <cmath>

namespace springproof::fem_reference::grid {

namespace {

using cases::index;
using mechanics::Vector;

bool is_quadratic(const cases::Scene& scene) {
  return scene.definition.fem.element == cases::Element::q2;
}

/// An element: a part of a cell of the body's own mesh.
struct Part {
  std::size_t cell;           ///< number in the body's own mesh
  std::array<int, 3> in_cell; ///< 0 to along - 1
  std::array<int, 3> at;      ///< indices in the grid of elements
  int layer;                  ///< index among the layers that are held
};

/// Calls action(Part) cell by cell, for the parts in a range of the layers that are held.
/// @param along  parts along an edge of a cell   @param first  first held layer of parts, by its grid index
template<class Action>
void for_each_part(const cases::Grid& grid, int along, int first, const Slab::Range& layers,
                   const Action& action) {
  std::size_t next = 0;
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) {
        if (!grid.has(i, j, k)) continue;
        const std::size_t cell = next++;
        for (int c = 0; c < along; ++c) {
          const int layer = along * k + c - first;
          if (layer < layers.begin || layer >= layers.end) continue;
          for (int b = 0; b < along; ++b)
            for (int a = 0; a < along; ++a)
              action(Part{cell, {a, b, c}, {along * i + a, along * j + b, along * k + c}, layer});
        }
      }
}

std::array<int, 3> cells_along(const cases::Scene& scene, int along) {
  std::array<int, 3> cells = scene.mesh.grid->cells;
  for (int& n : cells) n *= along;
  return cells;
}

Internal internal_of(cases::Element element) {
  if (element == cases::Element::q1_wilson) return Internal::bubbles;
  return element == cases::Element::q1_bbar || element == cases::Element::q1_p0 ? Internal::pressure
                                                                                : Internal::none;
}

/// @param along        elements along an edge of a cell
/// @param first_layer  first layer of cells that the slab holds, by its grid index
Body make_body(const cases::Scene& scene, int along, const Slab& of_nodes, int first_layer) {
  const cases::Element element = scene.definition.fem.element;
  const auto materials = cases::materials_of(scene.definition);
  Body made(cells_along(scene, along), of_nodes, scene.mesh.grid->spacing / along,
            law_of(scene.definition.fem.formulation), internal_of(element));
  const bool is_uniform = scene.material_of_cell.empty();
  made.parameters = parameters_of(materials.front());
  made.n_parameters = static_cast<int>(made.parameters.size());
  const auto n_entries = index(made.layout.n_cell_entries());
  if (!is_uniform) made.parameters.assign(index(made.n_parameters) * n_entries + 16, 0.);
  std::vector<std::vector<double>> values;
  for (const auto& material : materials) values.push_back(parameters_of(material));
  for_each_part(*scene.mesh.grid, along, first_layer, {0, made.cells[2]}, [&](const Part& part) {
    const auto entry = index(made.layout.cell(part.at[0], part.at[1], part.layer));
    made.weight[entry] = 1;
    if (is_uniform) return;
    const auto material = index(scene.material_of_cell[part.cell]);
    for (std::size_t p = 0; p < index(made.n_parameters); ++p)
      made.parameters[p * n_entries + entry] = values[material][p];
  });
  return made;
}

Body make_body(const cases::Scene& scene, int along, const Slab& of_nodes) {
  return make_body(scene, along, of_nodes, of_nodes.first_of_grid());
}

std::unique_ptr<QuadraticElements> make_quadratic(const cases::Scene& scene, int cell_factor,
                                                  const Body& body, int n_threads) {
  if (!is_quadratic(scene)) return nullptr;
  const Slab& slab = body.slab;
  const auto [begin, end] = slab.computed();
  const int first = slab.first_of_grid() + begin,
            beyond = std::min(slab.first_of_grid() + end, slab.n_planes_of_grid() - 1);
  return std::make_unique<QuadraticElements>(
      body, make_body(scene, cell_factor, Slab((beyond - first) / 2 + 1), first / 2), n_threads);
}

} // namespace

GridBody::GridBody(const cases::Scene& on_mesh, MPI_Comm the_communicator, int n_threads)
    : scene(on_mesh), communicator(the_communicator), n_threads_(n_threads),
      cell_factor_(1 << scene.definition.fem.refine), factor_(cell_factor_ * (is_quadratic(scene) ? 2 : 1)),
      body_(
          make_body(scene, factor_, deal(cells_along(scene, factor_), communicator, factor_ / cell_factor_))),
      places_{scene.mesh.grid->origin, scene.mesh.grid->spacing / factor_, body_},
      supported_(make_supported(cases::refine(scene, scene.definition.fem.refine), is_quadratic(scene),
                                places_, body_)),
      quadratic_(make_quadratic(scene, cell_factor_, body_, n_threads)),
      equations(body_, supported_, n_threads, quadratic_.get()) {}

Eigen::Vector3d GridBody::displacement_at(const Place& at, const Vector& state) const {
  const std::ptrdiff_t entry = places_.entry(at), size = body_.layout.size;
  return {state[entry], state[entry + size], state[entry + 2 * size]};
}

/// Calls action(Part, its entry in the elements' layout) for the elements that the rank computes, cell by
/// cell. Where every rank computes all, for those of the cells that are its own.
template<class Action>
void GridBody::for_each_element(const cases::Sharing* sharing, const Action& action) const {
  const Slab& slab = body_.slab;
  const Layout& layout = quadratic_ ? quadratic_->cells().layout : body_.layout;
  // the rank's quadratic elements have layers of their own
  const Slab::Range layers = quadratic_ ? Slab::Range{0, quadratic_->cells().cells[2]} : slab.own_layers();
  const int first = quadratic_ ? (slab.first_of_grid() + slab.computed().begin) / 2 : slab.first_of_grid();
  for_each_part(*scene.mesh.grid, cell_factor_, first, layers, [&](const Part& part) {
    if (!slab.is_shared() && sharing && !sharing->here().cells.has(part.cell)) return;
    action(part, index(layout.cell(part.at[0], part.at[1], part.layer)));
  });
}

mechanics::StateOnMesh GridBody::on_mesh() const {
  auto shared = mechanics::share_out(scene.mesh, communicator);
  const cases::Sharing* const sharing = shared.get();
  // Where every rank computes all nodes, it tells its own.
  const auto displacements = [this, sharing](const Vector& state) {
    std::vector<cases::Numbered<Eigen::Vector3d>> own;
    for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
      if (!body_.slab.is_shared() && sharing && !sharing->here().own_nodes.has(n)) continue;
      const Place at = places_.of(scene.mesh.nodes[n]);
      if (places_.owns(at)) own.push_back({static_cast<std::int64_t>(n), displacement_at(at, state)});
    }
    return own;
  };
  const auto cell_volumes = [this, sharing](const Vector& state) {
    const std::vector<double> of_entries = equations.cell_volumes(state);
    std::vector<cases::Numbered<double>> volumes;
    for_each_element(sharing, [&](const Part& part, std::size_t entry) {
      const auto cell = static_cast<std::int64_t>(part.cell);
      if (volumes.empty() || volumes.back().number != cell) volumes.push_back({cell, 0.});
      volumes.back().value += of_entries[entry];
    });
    return volumes;
  };
  return {scene.mesh, std::move(shared), {displacements, cell_volumes}};
}

std::vector<double> GridBody::node_displacements(const Vector& state) const {
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  std::vector<double> numbers;
  if (rank > 0 && !body_.slab.is_shared()) return numbers; // every rank has all of them
  places_.for_each([&](const Place& at) {
    const Eigen::Vector3d rest = places_.rest(at), displacement = displacement_at(at, state);
    numbers.insert(numbers.end(), rest.begin(), rest.end());
    numbers.insert(numbers.end(), displacement.begin(), displacement.end());
  });
  return numbers;
}

void GridBody::add_guess(mechanics::EquilibriumSettings& settings) const {
  if (settings.from != 0 || settings.first_load_step != 1 || body_.law == Law::small_strain) return;
  mechanics::grid::CoarseGuess coarse = coarse_guess(body_, supported_, settings.to, n_threads_);
  settings.guess = std::move(coarse.state);
  settings.first_load_step = coarse.first_load_step;
}

void GridBody::set_in_motion(const mechanics::EquilibriumSettings& settings) {
  equations.set_in_motion(cases::refine(scene, scene.definition.fem.refine), places_);
  equations.set_volume_tolerance(volume_tolerance_of(settings.tolerance));
}

bool GridBody::can_leave_rest() {
  constexpr double part = 1e-6; // share of the load: so small that Newton's step is the answer to it
  constexpr double forcing = 1e-3, enough = 0.1;
  const Vector rest = equations.rest();
  equations.forget_tangent();
  const Vector residual = equations.residual(rest, part, mechanics::Expect::direction);
  const auto step = equations.direction(rest, residual, part, forcing, mechanics::Convexity::exact);
  if (!step) return false;
  const Vector left = equations.residual(rest + *step, part, mechanics::Expect::residual);
  return equations.dot(left, left) <= enough * enough * equations.dot(residual, residual);
}

ElementsInState GridBody::elements(const Vector& state, const cases::Sharing* sharing) const {
  cases::Range cells;
  for_each_element(sharing, [&](const Part& part, std::size_t) { // they come in ascending order
    cells = {cells.size() == 0 ? part.cell : cells.begin, part.cell + 1};
  });
  std::vector<Formulation> formulations = formulations_of(scene);
  const ElementType type = element_type(scene.definition.fem, formulations.front());
  const auto cuboid = std::make_shared<Cuboid>(type.degree, type.n_pressure_modes,
                                               scene.mesh.grid->spacing / cell_factor_, type.n_bubbles);
  const auto for_each = [this, &state, sharing, cuboid, type](const auto& action) {
    const int degree = type.degree;
    const int n = degree + 1;
    const double edge = 1. / cell_factor_;
    std::vector<double> displacement(3 * cuboid->nodes().size()), internal(index(type.n_internal()));
    for_each_element(sharing, [&](const Part& part, std::size_t entry) {
      double* to = displacement.data();
      for (int a = 0; a < n * n * n; ++a, to += 3) {
        const Place node(degree * part.at[0] + a % n, degree * part.at[1] + a / n % n,
                         degree * part.at[2] + a / (n * n));
        Eigen::Map<Eigen::Vector3d>{to} = displacement_at(node, state);
      }
      for (std::size_t f = 0; f < internal.size(); ++f)
        internal[f] = state[equations.n_displacements() +
                            static_cast<Eigen::Index>(f * index(body_.layout.n_cell_entries()) + entry)];
      const Eigen::Vector3d lower = edge * Eigen::Vector3d(part.in_cell[0], part.in_cell[1], part.in_cell[2]);
      action({{part.cell, lower, edge * Eigen::Matrix3d::Identity()},
              cuboid->geometry(),
              displacement.data(),
              internal.data()});
    });
  };
  const CellGeometry cell = cuboid->geometry();
  const Eigen::MatrixXd of_all =
      mechanics::shape_products(cell.n_nodes, cell.n_points, cuboid->values().data(), cell.weights, 1);
  const auto products = [of_all](const CellGeometry&) { return of_all; };
  return {scene, std::move(formulations), type, cuboid->nodes(), products, cells, for_each};
}

} // namespace springproof::fem_reference::grid
