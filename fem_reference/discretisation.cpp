#include "fem_reference/discretisation.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "fem_reference/space.hpp"

#include <algorithm>
#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/sparsity_tools.h>
#include <fmt/format.h>
#include <set>
#include <utility>

namespace springproof::fem_reference {

using cases::index;
using Eigen::Vector3d;

namespace {

void add(Vec load, int local_node, const Vector3d& force) {
  check(VecSetValuesBlockedLocal(load, 1, &local_node, force.data(), ADD_VALUES));
}

void add_point_forces(const cases::Scene& scene, const Nodes& nodes, Vec load) {
  const std::vector<Vector3d> forces =
      cases::on_all_nodes(cases::nodes_with_point_forces(scene), scene.mesh.nodes.size());
  for (int node = 0; node < nodes.n_owned; ++node)
    if (nodes.mesh_node[index(node)] >= 0) add(load, node, forces[index(nodes.mesh_node[index(node)])]);
}

/// Whether this cell integrates over a face: one inside the body, between two cells, belongs to the first.
template<class Cell>
bool integrates(const Cell& cell, unsigned face) {
  return cell->at_boundary(face) || cell->id() < cell->neighbor(face)->id();
}

/// Integrates a traction or torque over the faces of its region with the element's own shape functions, also
/// where a face lies inside the body.
void add_traction(const cases::Scene& scene, const cases::Scene::AppliedLoad& applied, const Space& space,
                  const Nodes& nodes, Vec load) {
  const auto traction_at = cases::surface_traction(scene.mesh, applied);
  if (!traction_at) return;
  std::set<std::set<int>> faces; // by their vertices
  for (const auto& face : applied.selection.faces) faces.emplace(face.begin(), face.end());
  dealii::FEFaceValues<3> values(*space.mapping, *space.node_element, space.quadrature_of_faces,
                                 dealii::update_values | dealii::update_quadrature_points |
                                     dealii::update_JxW_values);
  const int* node = nodes.of_cell.data();
  for (const auto& cell : space.own_cells()) {
    for (const unsigned face : cell->face_indices()) {
      std::set<int> vertices;
      for (const unsigned v : cell->face(face)->vertex_indices())
        vertices.insert(static_cast<int>(cell->face(face)->vertex_index(v)));
      if (faces.count(vertices) == 0 || !integrates(cell, face)) continue;
      values.reinit(static_cast<const dealii::Triangulation<3>::active_cell_iterator&>(cell), face);
      for (const unsigned q : values.quadrature_point_indices()) {
        const auto& at = values.quadrature_point(q);
        const Vector3d traction = traction_at({at[0], at[1], at[2]});
        for (const unsigned a : values.dof_indices())
          add(load, node[a], values.JxW(q) * values.shape_value(a, q) * traction);
      }
    }
    node += nodes.per_cell;
  }
}

/// The weight of the cells, by the masses of their nodes, so that a free body falls as one, and of what
/// [[mass]] adds to nodes.
void add_gravity(const cases::Scene& scene, const Nodes& nodes, const Geometry& geometry, Vec load) {
  const Vector3d gravity = cases::gravity(scene);
  if (gravity.isZero(0)) return;
  for (int cell = 0; cell < nodes.n_cells; ++cell) {
    const double density = cases::dynamics_of(scene, index(nodes.mesh_cell[index(cell)])).density;
    const Eigen::VectorXd share =
        geometry.products(geometry.of(cell), scene.definition.fem.mass).rowwise().sum();
    for (int a = 0; a < nodes.per_cell; ++a)
      add(load, nodes.of_cell[index(cell * nodes.per_cell + a)], density * share[a] * gravity);
  }
  const cases::NodeMasses added = cases::added_masses(scene);
  for (int node = 0; node < nodes.n_owned; ++node)
    add(load, node, cases::mass_of(added, nodes.mesh_node[index(node)]) * gravity);
}

/// Compares the resultant of a load vector (N per owned degree of freedom) with that of the scene's loads.
/// Elements that leave out a load must not go unnoticed, in motion either, where reactions do not show it.
/// @throws SolveError
void check_resultant(const cases::Scene& scene, const std::vector<double>& load, MPI_Comm communicator) {
  constexpr double tolerance = 1e-6; // far above what quadrature and rounding leave
  Vector3d carried = Vector3d::Zero(), applied = carried;
  for (std::size_t i = 0; i < load.size(); ++i) carried[static_cast<int>(i % 3)] += load[i];
  for (double& component : carried) component = dealii::Utilities::MPI::sum(component, communicator);
  double size = 0;
  for (const auto& [node, force] : cases::applied_forces(scene, cases::PointMass::cells)) {
    applied += force;
    size += force.norm();
  }
  if (!((carried - applied).norm() <= tolerance * size))
    throw cases::SolveError(
        fmt::format("finite elements have ({:.6g}) N of the ({:.6g}) N that are applied at full load: "
                    "no answer to this case, and a defect to report",
                    fmt::join(carried, ", "), fmt::join(applied, ", ")));
}

/// Point forces, tractions, torques and gravity at full load, N per owned degree of freedom.
std::vector<double> assemble_loads(const cases::Scene& scene, const Space& space, const Nodes& nodes,
                                   const Geometry& geometry) {
  const Vector load = nodes.make_vector(space.mesh->get_communicator());
  add_point_forces(scene, nodes, load.get());
  for (const auto& applied : scene.loads) add_traction(scene, applied, space, nodes, load.get());
  add_gravity(scene, nodes, geometry, load.get());
  check(VecAssemblyBegin(load.get()));
  check(VecAssemblyEnd(load.get()));
  const ReadEntries values(load.get());
  std::vector<double> owned(values.data(), values.data() + 3 * nodes.n_owned);
  check_resultant(scene, owned, space.mesh->get_communicator());
  return owned;
}

/// A vertex, an edge or a face by its vertices' numbers.
using Part = std::set<int>;

/// The vertices, edges and faces of a selection, edges of its faces included.
std::set<Part> parts_of(const cases::Selection& selection) {
  std::set<Part> parts;
  for (const int node : selection.nodes) parts.insert(Part{node});
  for (const auto& edge : selection.edges) parts.emplace(edge.begin(), edge.end());
  for (const auto& face : selection.faces) {
    parts.emplace(face.begin(), face.end());
    for (const auto& [from, to] : cases::sides_of(face)) parts.insert(Part{from, to});
  }
  return parts;
}

/// Local nodes on a selection's vertices, edges and faces.
std::set<int> nodes_on(const cases::Selection& selection, const cases::Scene& scene, const Nodes& nodes) {
  const std::set<Part> parts = parts_of(selection);
  std::vector<char> is_seen(nodes.point.size());
  std::set<int> found;
  for (std::size_t i = 0; i < nodes.of_cell.size(); ++i) {
    const int node = nodes.of_cell[i];
    if (std::exchange(is_seen[index(node)], 1)) continue;
    const auto& cell = scene.mesh.cells[index(nodes.mesh_cell[i / index(nodes.per_cell)])];
    Part part;
    for (const int v : nodes.between[i % index(nodes.per_cell)]) part.insert(cell[index(v)]);
    if (parts.count(part) != 0) found.insert(node);
  }
  return found;
}

} // namespace

Constraints::Constraints(const cases::Scene& scene, const Nodes& nodes, MPI_Comm communicator)
    : is_constrained(3 * nodes.point.size()), at_full_load(3 * nodes.point.size()) {
  for (const auto& fixed : scene.constrained)
    for (const int node : nodes_on(fixed.selection, scene, nodes))
      for (std::size_t c = 0; c < 3; ++c)
        if (fixed.components[c]) is_constrained[3 * index(node) + c] = 1;
  are_moved = !scene.moved.empty();
  for (const auto& [selection, motion] : scene.moved)
    for (const int node : nodes_on(selection, scene, nodes))
      moved_.push_back({node, nodes.point[index(node)], motion});
  n_unknowns = std::count(is_constrained.begin(), is_constrained.begin() + 3 * nodes.n_owned, 0);
  MPI_Allreduce(MPI_IN_PLACE, &n_unknowns, 1, MPI_LONG, MPI_SUM, communicator);
}

void Constraints::prescribe(double load_factor, std::vector<double>& displacement) const {
  displacement.resize(at_full_load.size());
  for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] = load_factor * at_full_load[i];
  prescribe_moved([=](const cases::Moved& /*motion*/) { return load_factor; }, displacement);
}

void Constraints::prescribe_at(double time, std::vector<double>& displacement) const {
  displacement.assign(at_full_load.size(), 0);
  prescribe_moved([=](const cases::Moved& motion) { return motion.history.at(time); }, displacement);
}

/// Sets the moved degrees of freedom.  @param factor  returns the factor of a motion (Moved)
template<class Factor>
void Constraints::prescribe_moved(const Factor& factor, std::vector<double>& displacement) const {
  for (const auto& [node, rest, motion] : moved_) {
    const Vector3d value = cases::moved_by(motion, rest, factor(motion));
    for (std::size_t c = 0; c < 3; ++c)
      if (motion.components[c]) displacement[3 * index(node) + c] = value[static_cast<Eigen::Index>(c)];
  }
}

Discretisation::Discretisation(const cases::Scene& scene, const ElementType& type, MPI_Comm all_ranks)
    : space_(std::make_unique<Space>(scene, type, all_ranks)), communicator(space_->mesh->get_communicator()),
      element(type), nodes(*space_, scene), geometry(*space_, nodes, element),
      constraints(scene, nodes, communicator), load(assemble_loads(scene, *space_, nodes, geometry)) {
  if (!scene.material_of_cell.empty())
    for (const int cell : nodes.mesh_cell) material_of_cell.push_back(scene.material_of_cell[index(cell)]);
  if (element.pressure == Pressure::nodes) find_pressures();
  if (!scene.definition.tools.empty()) find_tool_sides(scene);
}

void Discretisation::find_pressures() {
  const Vector volumes = make_vector();
  {
    const WriteEntries sum(volumes.get());
    for (int cell = 0; cell < nodes.n_cells; ++cell) {
      const CellGeometry g = geometry.of(cell);
      const int n_modes = element.n_pressure_modes;
      for (int i = 0; i < g.n_points * n_modes; ++i)
        sum[pressure_of(nodes.of_cell[index(cell * nodes.per_cell + i % n_modes)])] +=
            g.weights[i / n_modes] * g.modes[i];
    }
  }
  mechanics::petsc::add_ghosts(volumes.get());
  const ReadEntries sums(volumes.get());
  for (int node = 0; node < nodes.n_owned; ++node)
    if (!is_held(pressure_of(node))) pressures.emplace_back(node, sums[pressure_of(node)]);
  n_pressures = static_cast<long>(pressures.size());
  MPI_Allreduce(MPI_IN_PLACE, &n_pressures, 1, MPI_LONG, MPI_SUM, communicator);
}

/// Pressures are those of vertices.
bool Discretisation::is_held(std::size_t unknown) const {
  const std::size_t n = index(n_per_node()), node = unknown / n, component = unknown % n;
  return component < 3 ? constraints.is_constrained[3 * node + component] != 0 : nodes.mesh_node[node] < 0;
}

Discretisation::~Discretisation() = default;

std::vector<double> Discretisation::load_of(const cases::Scene& scene) const {
  return assemble_loads(scene, *space_, nodes, geometry);
}

Matrix Discretisation::make_tangent_matrix() const {
  const dealii::IndexSet& owned = space_->dofs.locally_owned_dofs();
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(space_->dofs, relevant);
  dealii::AffineConstraints<double> lines(relevant);
  const auto n = static_cast<unsigned>(n_per_node());
  for (unsigned i = 0; i < n * nodes.point.size(); ++i)
    if (is_held(i)) lines.add_line(n * static_cast<unsigned>(nodes.global[i / n]) + i % n);
  lines.close();
  dealii::DynamicSparsityPattern pattern(relevant);
  dealii::DoFTools::make_sparsity_pattern(space_->dofs, pattern, lines, false);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned, communicator, relevant);
  dealii::PETScWrappers::MPI::SparseMatrix wrapper;
  wrapper.reinit(owned, owned, pattern, communicator);

  Mat matrix = wrapper;
  check(PetscObjectReference(reinterpret_cast<PetscObject>(matrix))); // outlives its wrapper
  Matrix result(matrix);
  check(MatSetBlockSize(matrix, n_per_node())); // multigrid then coarsens nodes, not components
  const Vector layout = make_vector();
  const auto numbers = get<ISLocalToGlobalMapping>(VecGetLocalToGlobalMapping, layout.get());
  check(MatSetLocalToGlobalMapping(matrix, numbers, numbers));
  return result;
}

} // namespace springproof::fem_reference
