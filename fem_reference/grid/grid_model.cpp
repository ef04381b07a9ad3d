#include "fem_reference/grid/grid_model.hpp"

#include "cases/mesh/hex_mesh.hpp"
#include "fem_reference/grid/coarse_guess.hpp"
#include "fem_reference/grid/traction.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "mechanics/laws/ogden.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace springproof::fem_reference::grid {

namespace {

using cases::index;
using mechanics::Vector;

constexpr std::size_t most_terms = 8; ///< of Ogden's law

Law law_of(cases::Formulation formulation) {
  switch (formulation) {
  case cases::Formulation::small_strain:
    return Law::small_strain;
  case cases::Formulation::saint_venant_kirchhoff:
    return Law::saint_venant_kirchhoff;
  case cases::Formulation::log_strain:
    return Law::log_strain;
  default:
    return Law::ogden;
  }
}

/// In the order that Cells asks for.
std::vector<double> parameters_of(const cases::Material& material) {
  if (const auto* elastic = std::get_if<cases::LinearElastic>(&material)) {
    const auto moduli = mechanics::elastic_moduli(*elastic);
    return {moduli.mu, moduli.kappa};
  }
  const auto& ogden = std::get<cases::Ogden>(material);
  std::vector<double> values{
      ogden.bulk_modulus.value_or(mechanics::nearly_incompressible_ratio * mechanics::shear_modulus(ogden))};
  for (std::size_t t = 0; t < ogden.mu.size(); ++t) {
    values.push_back(ogden.mu[t]);
    values.push_back(ogden.alpha[t]);
  }
  return values;
}

bool is_quadratic(const cases::Scene& scene) {
  return scene.definition.fem.element == cases::Element::q2;
}

using Place = Eigen::Vector3i; ///< of a node in its grid

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

bool is_on_grid(const cases::Scene& scene) {
  const cases::Fem& fem = scene.definition.fem;
  if (!scene.mesh.grid) return false;
  if (fem.element == cases::Element::q2_p1) return false;
  std::size_t n_parameters = 0;
  for (const cases::Material& material : cases::materials_of(scene.definition)) {
    if (std::holds_alternative<cases::Ogden>(material) !=
        (fem.formulation == cases::Formulation::hyperelastic))
      return false; // the other backend has the message
    const std::size_t n = parameters_of(material).size();
    if (n > 1 + 2 * most_terms || (n_parameters > 0 && n != n_parameters)) return false;
    n_parameters = n;
  }
  return fem.formulation != cases::Formulation::saint_venant_kirchhoff || fem.element == cases::Element::q1 ||
         fem.element == cases::Element::q2;
}

double bulk_over_shear(const cases::Scene& scene) {
  double largest = 0;
  for (const cases::Material& material : cases::materials_of(scene.definition)) {
    const std::vector<double> values = parameters_of(material);
    const auto* ogden = std::get_if<cases::Ogden>(&material);
    largest = std::max(largest, ogden ? values[0] / mechanics::shear_modulus(*ogden) : values[1] / values[0]);
  }
  return largest;
}

struct GridModel::Implementation {
  Implementation(const cases::Scene& the_scene, MPI_Comm the_communicator, int threads)
      : scene(the_scene), communicator(the_communicator), n_threads(threads),
        fine(cases::refine(scene, scene.definition.fem.refine)),
        cell_factor(1 << scene.definition.fem.refine), factor(cell_factor * (is_quadratic(scene) ? 2 : 1)),
        slab(deal(cells_along(factor), communicator, factor / cell_factor)),
        body(make_body(factor, slab, slab.first_of_grid())), supported(make_supported()),
        quadratic(is_quadratic(scene) ? make_quadratic() : nullptr),
        equations(body, supported, n_threads, quadratic.get()), last(equations.rest()) {}

  cases::Scene scene; ///< on the body's own mesh
  MPI_Comm communicator;
  int n_threads;
  cases::Scene fine; ///< refined
  int cell_factor;   ///< elements along an edge of the body's own cells
  int factor;        ///< the same of the grid of nodes
  Slab slab;         ///< of the nodes
  Body body;
  Supported supported;
  std::unique_ptr<QuadraticElements> quadratic;
  GridEquations equations;
  Vector last;
  double last_load_factor = 0;

  Eigen::Vector3d spacing() const { return scene.mesh.grid->spacing / factor; }
  Place place_of(std::size_t node) const {
    const Eigen::Vector3d at = (fine.mesh.nodes[node] - scene.mesh.grid->origin).cwiseQuotient(spacing());
    return at.array().round().cast<int>();
  }
  bool holds(const Place& at) const { return is_in({0, slab.n_planes()}, at); }
  bool owns(const Place& at) const { return is_in(slab.computed(), at); }
  bool is_in(const Slab::Range& planes, const Place& at) const {
    const int plane = at.z() - slab.first_of_grid();
    return plane >= planes.begin && plane < planes.end;
  }
  /// Of a node that is held.
  std::ptrdiff_t entry_of(const Place& at) const {
    return body.layout.at(at.x(), at.y(), at.z() - slab.first_of_grid());
  }
  Eigen::Vector3d displacement_at(const Place& at) const {
    const std::ptrdiff_t entry = entry_of(at), size = body.layout.size;
    return {last[entry], last[entry + size], last[entry + 2 * size]};
  }
  /// Calls action(place) for the nodes of the elements that the rank computes.
  template<class Action>
  void for_each_node(const Action& action) const {
    const auto [begin, end] = slab.computed();
    for (int k = begin; k < end; ++k)
      for (int j = 0; j <= body.cells[1]; ++j)
        for (int i = 0; i <= body.cells[0]; ++i)
          if (has_cell(body, i, j, k)) action(Place(i, j, slab.first_of_grid() + k));
  }
  std::array<int, 3> cells_along(int along) const {
    std::array<int, 3> cells = scene.mesh.grid->cells;
    for (int& n : cells) n *= along;
    return cells;
  }
  Body make_body(int cells_along_edge, const Slab& of_nodes, int first_layer) const;
  std::unique_ptr<QuadraticElements> make_quadratic() const;
  std::vector<Place> places_on(const cases::Selection& selection) const;
  void add_loads(Field<double>& load) const;
  Supported make_supported();
  std::vector<double> cell_volumes() const;
  double count_free() const;
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
  const auto [begin, end] = slab.computed();
  const int first = slab.first_of_grid() + begin,
            beyond = std::min(slab.first_of_grid() + end, slab.n_planes_of_grid() - 1);
  return std::make_unique<QuadraticElements>(
      body, make_body(cell_factor, Slab((beyond - first) / 2 + 1), first / 2), n_threads);
}

/// Nodes on a selection's vertices and, of quadratic elements, on its edges and faces.
std::vector<Place> GridModel::Implementation::places_on(const cases::Selection& selection) const {
  std::vector<Place> places;
  for (const int node : selection.nodes) places.push_back(place_of(index(node)));
  if (!is_quadratic(scene)) return places;
  const auto add_middle = [&](int a, int b) {
    places.push_back((place_of(index(a)) + place_of(index(b))) / 2);
  };
  for (const auto& edge : selection.edges) add_middle(edge[0], edge[1]);
  for (const auto& face : selection.faces) {
    for (std::size_t v = 0; v < 4; ++v) add_middle(face[v], face[(v + 1) % 4]);
    add_middle(face[0], face[2]);
  }
  const auto is_before = [](const Place& a, const Place& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(places.begin(), places.end(), is_before);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

void GridModel::Implementation::add_loads(Field<double>& load) const {
  const auto add_force = [&](const Place& at, const Eigen::Vector3d& force) {
    if (!owns(at)) return;
    for (int c = 0; c < 3; ++c) load[c * body.layout.size + entry_of(at)] += force[c];
  };
  const std::vector<Eigen::Vector3d> forces =
      is_quadratic(scene) ? cases::point_forces(fine) : cases::nodal_forces(fine);
  for (std::size_t n = 0; n < forces.size(); ++n) add_force(place_of(n), forces[n]);
  if (!is_quadratic(scene)) return;
  for (const auto& applied : fine.loads) {
    const bool is_torque = applied.load.kind == cases::LoadKind::torque;
    if (!is_torque && applied.load.kind != cases::LoadKind::traction) continue;
    const double moment = is_torque ? cases::polar_moment(fine.mesh, applied) : 1;
    for (const auto& face : applied.selection.faces) {
      std::array<Eigen::Vector3d, 4> vertices;
      std::array<Place, 4> places;
      for (std::size_t v = 0; v < 4; ++v) {
        vertices[v] = fine.mesh.nodes[index(face[v])];
        places[v] = place_of(index(face[v]));
      }
      const NineForces nine = traction_on(applied, vertices, moment);
      for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a)
          add_force(places[0] + (a * (places[1] - places[0]) + b * (places[3] - places[0])) / 2,
                    nine[index(a + 3 * b)]);
    }
  }
}

Supported GridModel::Implementation::make_supported() {
  for_each_node([&](const Place& at) {
    for (int c = 0; c < 3; ++c) body.free[c * body.layout.size + entry_of(at)] = 1;
  });
  for (const auto& fixed : fine.constrained)
    for (const Place& at : places_on(fixed.selection))
      for (int c = 0; owns(at) && c < 3; ++c)
        if (fixed.components[index(c)]) body.free[c * body.layout.size + entry_of(at)] = 0;
  slab.update_ghosts(body.layout, body.free.data());
  Supported made;
  made.load.setZero(3 * body.layout.size);
  add_loads(made.load);
  made.load.array() *= body.free.cast<double>().array();
  struct MovedNode {
    Eigen::Vector3d rest;
    cases::Moved motion;
  };
  std::vector<MovedNode> nodes;
  for (const auto& [selection, motion] : fine.moved)
    for (const Place& at : places_on(selection)) {
      if (!holds(at)) continue;
      nodes.push_back({scene.mesh.grid->origin + at.cast<double>().cwiseProduct(spacing()), motion});
      for (int c = 0; c < 3; ++c)
        if (motion.components[index(c)]) made.moved.push_back(c * body.layout.size + entry_of(at));
    }
  if (!fine.moved.empty())
    made.prescribed = [nodes](double load_factor) {
      std::vector<double> values;
      for (const auto& [rest, motion] : nodes) {
        const Eigen::Vector3d by = cases::moved_by(motion, rest, load_factor);
        for (std::size_t c = 0; c < 3; ++c)
          if (motion.components[c]) values.push_back(by[static_cast<int>(c)]);
      }
      return values;
    };
  return made;
}

GridModel::GridModel(const cases::Scene& scene, MPI_Comm communicator, int n_threads)
    : implementation_(std::make_unique<Implementation>(scene, communicator, n_threads)) {}
GridModel::~GridModel() = default;

void GridModel::back_to_rest() {
  implementation_->last = implementation_->equations.rest();
  implementation_->last_load_factor = 0;
}

/// Of the body's cells; of each as much as the rank computes.
std::vector<double> GridModel::Implementation::cell_volumes() const {
  const std::vector<double> of_entries = equations.cell_volumes(last);
  const Layout& layout = quadratic ? quadratic->cells().layout : body.layout;
  // the rank's elements have layers of their own
  const Slab::Range layers = quadratic ? Slab::Range{0, quadratic->cells().cells[2]} : slab.own_layers();
  const int first = quadratic ? (slab.first_of_grid() + slab.computed().begin) / 2 : slab.first_of_grid();
  const cases::Grid& grid = *scene.mesh.grid;
  std::vector<double> volumes;
  for (int k = 0; k < grid.cells[2]; ++k)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int i = 0; i < grid.cells[0]; ++i) {
        if (!grid.has(i, j, k)) continue;
        double volume = 0;
        const int n = cell_factor;
        for (int c = 0; c < n; ++c) {
          const int layer = n * k + c - first;
          if (layer < layers.begin || layer >= layers.end) continue;
          for (int b = 0; b < n; ++b)
            for (int a = 0; a < n; ++a) volume += of_entries[index(layout.cell(n * i + a, n * j + b, layer))];
        }
        volumes.push_back(volume);
      }
  return volumes;
}

double GridModel::Implementation::count_free() const {
  double n = 0;
  for_each_node([&](const Place& at) {
    for (int c = 0; c < 3; ++c) n += body.free[c * body.layout.size + entry_of(at)] > 0 ? 1 : 0;
  });
  return n;
}

bool GridModel::can_leave_rest() {
  GridEquations& equations = implementation_->equations;
  const Vector rest = equations.rest();
  constexpr double forcing = 1e-5; // as of the assembled equations' iterative solver
  const Vector residual = equations.residual(rest, 1, mechanics::Expect::direction);
  return equations.direction(rest, residual, 1, forcing, mechanics::Convexity::exact).has_value();
}

cases::Solution GridModel::solve(double load_factor, const mechanics::EquilibriumSettings& given) {
  Implementation& m = *implementation_;
  mechanics::EquilibriumSettings settings = given;
  settings.from = m.last_load_factor;
  settings.to = load_factor;
  if (settings.from == 0 && settings.first_load_step == 1 && m.body.law != Law::small_strain)
    settings.guess = coarse_guess(m.body, m.supported, load_factor, m.n_threads);
  const auto equilibrium = mechanics::find_equilibrium(m.equations, m.last, "finite elements", settings);
  m.last = equilibrium.state;
  m.last_load_factor = load_factor;
  cases::Solution solution = mechanics::to_solution(equilibrium);
  // each entry is one rank's
  const auto gather = [&](double* values, std::size_t n) {
    if (m.slab.is_shared())
      MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(n), MPI_DOUBLE, MPI_SUM, m.communicator);
  };
  solution.displacement.assign(m.scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
  for (std::size_t n = 0; n < solution.displacement.size(); ++n) {
    const Place at = m.place_of(n); // the refined mesh begins with the body's own nodes
    if (m.owns(at)) solution.displacement[n] = m.displacement_at(at);
  }
  gather(solution.displacement.front().data(), 3 * solution.displacement.size());
  solution.cell_volume = m.cell_volumes();
  gather(solution.cell_volume.data(), solution.cell_volume.size());
  solution.unknowns = static_cast<std::size_t>(m.slab.total(m.count_free()));
  if (settings.stability != mechanics::Stability::ignore)
    solution.negative_eigenvalues = m.equations.negative_eigenvalues();
  for (std::size_t cell = 0; cell < m.scene.mesh.cells.size(); ++cell)
    if (!(cases::smallest_corner_jacobian(cases::cell_vertices(m.scene.mesh, cell, solution.displacement)) >
          0))
      ++solution.inverted_cells;
  return solution;
}

std::vector<GridModel::NodeValue> GridModel::node_displacements() const {
  const Implementation& m = *implementation_;
  std::vector<double> numbers;
  m.for_each_node([&](const Place& at) {
    const Eigen::Vector3d rest = m.scene.mesh.grid->origin + at.cast<double>().cwiseProduct(m.spacing()),
                          displacement = m.displacement_at(at);
    numbers.insert(numbers.end(), rest.begin(), rest.end());
    numbers.insert(numbers.end(), displacement.begin(), displacement.end());
  });
  if (m.slab.is_shared()) numbers = gather(numbers, m.communicator);
  std::vector<NodeValue> values;
  for (const double* at = numbers.data(); at != numbers.data() + numbers.size(); at += 6)
    values.push_back({Eigen::Vector3d(at), Eigen::Vector3d(at + 3)});
  return values;
}

} // namespace springproof::fem_reference::grid
