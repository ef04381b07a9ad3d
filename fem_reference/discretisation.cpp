#include "fem_reference/discretisation.hpp"

#include "cases/case/index.hpp"

#include <algorithm>
#include <cmath>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/sparsity_tools.h>
#include <map>
#include <set>

namespace springproof::fem_reference {

namespace {

using cases::index;

using Eigen::Vector3d;

Vector3d to_eigen(const dealii::Point<3>& p) {
  return {p[0], p[1], p[2]};
}

template<std::size_t n>
std::array<int, n> sorted(std::array<int, n> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// Vertex numbers of an edge or a face of deal.II's mesh, sorted.
template<std::size_t n, typename Part>
std::array<int, n> sorted_vertices(const Part& part) {
  std::array<int, n> nodes{};
  for (std::size_t v = 0; v < n; ++v)
    nodes[v] = static_cast<int>(part->vertex_index(static_cast<unsigned>(v)));
  return sorted(nodes);
}

/// The vertices, edges and faces of a selection as sets of sorted vertex numbers.
struct SelectedParts {
  std::set<int> vertices;
  std::set<std::array<int, 2>> edges;
  std::set<std::array<int, 4>> faces;
  explicit SelectedParts(const cases::Selection& selection)
      : vertices(selection.nodes.begin(), selection.nodes.end()) {
    for (const auto& edge : selection.edges) edges.insert(sorted(edge));
    for (const auto& face : selection.faces) {
      faces.insert(sorted(face));
      for (std::size_t v = 0; v < 4; ++v)
        edges.insert(sorted(std::array<int, 2>{{face[v], face[(v + 1) % 4]}}));
    }
  }
};

} // namespace

/// deal.II's objects, alive only while the plain arrays are filled.
struct DiscretisationBuilder {

  DiscretisationBuilder(Discretisation& target, const cases::Scene& scene);
  void create_mesh();
  void distribute_nodes();
  void compute_geometry();
  void add_pressure_modes();
  void apply_fixed_regions(const Prescribed& prescribed);
  template<class Action>
  void visit(const cases::Selection& selection, const Action& action) const;
  void create_tangent();
  void add_point_forces();
  void add_tractions();
  void add_body_force(const Prescribed& prescribed);
  int local_node(dealii::types::global_dof_index global) const;

  Discretisation& out;
  const cases::Scene& scene;
  dealii::parallel::distributed::Triangulation<3> mesh;
  dealii::FE_Q<3> node_element;
  dealii::FESystem<3> element;
  dealii::DoFHandler<3> dofs;
  dealii::AffineConstraints<double> constraints;
  dealii::IndexSet owned, relevant;
  std::map<PetscInt, int> ghost_number;
};

DiscretisationBuilder::DiscretisationBuilder(Discretisation& target, const cases::Scene& the_scene)
    : out(target), scene(the_scene), mesh(target.communicator),
      node_element(static_cast<unsigned>(target.element.degree)), element(node_element, 3), dofs(mesh) {}

/// The scene's cells become coarse cells and are never refined: vertex numbers stay the scene's node numbers.
void DiscretisationBuilder::create_mesh() {
  std::vector<dealii::Point<3>> vertices;
  for (const Vector3d& node : scene.mesh.nodes) vertices.emplace_back(node.x(), node.y(), node.z());
  std::vector<dealii::CellData<3>> cells(scene.mesh.cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (unsigned v = 0; v < 8; ++v) cells[c].vertices[v] = static_cast<unsigned>(scene.mesh.cells[c][v]);
  mesh.create_triangulation(vertices, cells, dealii::SubCellData());
}

int DiscretisationBuilder::local_node(dealii::types::global_dof_index dof) const {
  const auto node = static_cast<PetscInt>(dof / 3);
  if (node >= out.first_owned_node && node < out.first_owned_node + out.n_owned_nodes)
    return node - out.first_owned_node;
  return ghost_number.at(node);
}

/// deal.II numbers the three components of every support point one after another: a node is a block of three.
void DiscretisationBuilder::distribute_nodes() {
  dofs.distribute_dofs(element);
  owned = dofs.locally_owned_dofs();
  dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
  const unsigned n = node_element.n_dofs_per_cell();
  out.nodes_per_cell = static_cast<int>(n);
  out.n_owned_nodes = static_cast<int>(owned.n_elements() / 3);
  out.first_owned_node = owned.n_elements() > 0 ? static_cast<int>(owned.nth_index_in_set(0) / 3) : 0;

  std::vector<dealii::types::global_dof_index> indices(element.n_dofs_per_cell());
  std::vector<PetscInt> cell_global;
  std::set<PetscInt> ghosts;
  for (const auto& cell : dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    out.mesh_cell.push_back(cell->index());
    if (!scene.material_of_cell.empty())
      out.material_of_cell.push_back(scene.material_of_cell[static_cast<std::size_t>(cell->index())]);
    for (unsigned a = 0; a < n; ++a) {
      const auto dof = indices[element.component_to_system_index(0, a)];
      Assert(dof % 3 == 0, dealii::ExcInternalError());
      cell_global.push_back(static_cast<PetscInt>(dof / 3));
      if (!owned.is_element(dof)) ghosts.insert(cell_global.back());
    }
  }
  out.n_cells = static_cast<int>(out.mesh_cell.size());
  out.ghost_nodes.assign(ghosts.begin(), ghosts.end());
  for (std::size_t g = 0; g < out.ghost_nodes.size(); ++g)
    ghost_number[out.ghost_nodes[g]] = out.n_owned_nodes + static_cast<int>(g);
  for (PetscInt node : cell_global)
    out.cell_nodes.push_back(local_node(3 * static_cast<dealii::types::global_dof_index>(node)));
}

void DiscretisationBuilder::compute_geometry() {
  const unsigned n = node_element.n_dofs_per_cell();
  const dealii::QGauss<3> quadrature(static_cast<unsigned>(out.element.degree) + 1);
  const dealii::MappingQ1<3> mapping;
  dealii::FEValues<3> values(mapping, node_element, quadrature,
                             dealii::update_gradients | dealii::update_JxW_values);
  out.points_per_cell = static_cast<int>(quadrature.size());
  for (unsigned q = 0; q < quadrature.size(); ++q) {
    for (unsigned a = 0; a < n; ++a)
      out.shape_values.push_back(node_element.shape_value(a, quadrature.point(q)));
  }
  const auto n_local_nodes = index(out.n_owned_nodes) + out.ghost_nodes.size();
  out.node_point.resize(n_local_nodes);
  out.mesh_node.assign(n_local_nodes, -1);
  out.gradients_.resize(index(out.n_cells) * quadrature.size() * 3 * n);
  double* gradient = out.gradients_.data();
  const int* node = out.cell_nodes.data();
  for (const auto& cell : dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(static_cast<const dealii::Triangulation<3>::active_cell_iterator&>(cell));
    for (unsigned q = 0; q < quadrature.size(); ++q) {
      out.weights_.push_back(values.JxW(q));
      for (unsigned j = 0; j < 3; ++j)
        for (unsigned a = 0; a < n; ++a) *gradient++ = values.shape_grad(a, q)[j];
    }
    for (unsigned a = 0; a < n; ++a)
      out.node_point[index(node[a])] =
          to_eigen(mapping.transform_unit_to_real_cell(cell, node_element.unit_support_point(a)));
    add_pressure_modes();
    for (unsigned v = 0; v < 8; ++v) // the vertices come first
      out.mesh_node[index(node[v])] = static_cast<int>(cell->vertex_index(v));
    node += n;
  }
}

/// 1 and the coordinates from the cell's centre over its edge length. Coordinates of the reference cell would
/// lose an order of accuracy on cells that are no parallelepipeds (Arnold, Boffi and Falk, Math. Comp. 71,
/// 2002).
void DiscretisationBuilder::add_pressure_modes() {
  if (out.element.n_pressure_modes == 0) return;
  const auto cell = static_cast<int>(out.weights_.size()) / out.points_per_cell - 1;
  const double* weights = out.weights_.data() + cell * out.points_per_cell;
  Vector3d centre = Vector3d::Zero();
  double volume = 0;
  for (int q = 0; q < out.points_per_cell; ++q) {
    centre += weights[q] * out.quadrature_point(cell, q);
    volume += weights[q];
  }
  centre /= volume;
  for (int q = 0; q < out.points_per_cell; ++q) {
    const Vector3d offset = (out.quadrature_point(cell, q) - centre) / std::cbrt(volume);
    for (int m = 0; m < out.element.n_pressure_modes; ++m) out.modes_.push_back(m == 0 ? 1 : offset[m - 1]);
  }
}

/// Calls action(degree of freedom, component) for those on a selection's vertices, edges and faces; some
/// several times.
template<class Action>
void DiscretisationBuilder::visit(const cases::Selection& selection, const Action& action) const {
  const SelectedParts parts(selection);
  for (const auto& cell : dofs.active_cell_iterators()) {
    if (cell->is_artificial()) continue;
    for (unsigned c = 0; c < 3; ++c) {
      for (unsigned v = 0; v < 8; ++v)
        if (parts.vertices.count(static_cast<int>(cell->vertex_index(v))) != 0)
          action(cell->vertex_dof_index(v, c), c);
      if (out.element.degree == 1) continue;
      for (unsigned l = 0; l < 12; ++l) {
        const auto line = cell->line(l);
        if (parts.edges.count(sorted_vertices<2>(line)) != 0) action(line->dof_index(c), c);
      }
      for (unsigned f = 0; f < 6; ++f) {
        const auto face = cell->quad(f);
        if (parts.faces.count(sorted_vertices<4>(face)) != 0) action(face->dof_index(c), c);
      }
    }
  }
}

void DiscretisationBuilder::apply_fixed_regions(const Prescribed& prescribed) {
  constraints.reinit(relevant);
  for (const auto& fixed : scene.fixed)
    visit(fixed.selection, [&](dealii::types::global_dof_index dof, unsigned component) {
      if (fixed.components[component]) constraints.add_line(dof);
    });
  constraints.close();
  for (const auto& [selection, motion] : scene.moved) {
    std::set<int> nodes;
    visit(selection, [&](dealii::types::global_dof_index dof, unsigned) { nodes.insert(local_node(dof)); });
    for (const int node : nodes) out.moved.emplace_back(node, motion);
  }
  long free = 0;
  out.is_fixed.assign(3 * out.node_point.size(), 0);
  out.prescribed.assign(3 * out.node_point.size(), 0);
  for (std::size_t node = 0; node < out.node_point.size(); ++node) {
    const bool is_owned = node < index(out.n_owned_nodes);
    const PetscInt global = is_owned ? out.first_owned_node + static_cast<PetscInt>(node)
                                     : out.ghost_nodes[node - index(out.n_owned_nodes)];
    const Vector3d value =
        prescribed.displacement ? prescribed.displacement(out.node_point[node]) : Vector3d::Zero();
    for (std::size_t c = 0; c < 3; ++c) {
      const bool is_fixed =
          constraints.is_constrained(static_cast<unsigned>(3 * global) + static_cast<unsigned>(c));
      out.is_fixed[3 * node + c] = is_fixed;
      out.prescribed[3 * node + c] = is_fixed ? value[static_cast<Eigen::Index>(c)] : 0;
      if (is_owned && !is_fixed) ++free;
    }
  }
  MPI_Allreduce(&free, &out.n_unknowns, 1, MPI_LONG, MPI_SUM, out.communicator);
}

void DiscretisationBuilder::create_tangent() {
  dealii::DynamicSparsityPattern pattern(relevant);
  dealii::DoFTools::make_sparsity_pattern(dofs, pattern, constraints, false);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned, out.communicator, relevant);
  out.matrix_ = std::make_unique<dealii::PETScWrappers::MPI::SparseMatrix>();
  out.matrix_->reinit(owned, owned, pattern, out.communicator);
  out.tangent = static_cast<const Mat&>(*out.matrix_);
  check(MatSetBlockSize(out.tangent, 3)); // multigrid then coarsens nodes, not components
}

void DiscretisationBuilder::add_point_forces() {
  out.load.assign(3 * index(out.n_owned_nodes), 0);
  const std::vector<Vector3d> forces = cases::point_forces(scene);
  for (std::size_t node = 0; node < index(out.n_owned_nodes); ++node)
    if (out.mesh_node[node] >= 0)
      for (std::size_t c = 0; c < 3; ++c)
        out.load[3 * node + c] += forces[index(out.mesh_node[node])][static_cast<Eigen::Index>(c)];
}

/// Adds up over cells into ghosts too, then sends those to their owners.
class LoadAssembly {
 public:
  explicit LoadAssembly(Discretisation& target) : out_(target), total_(target.make_vector()) {}
  void add(int local_node, const Vector3d& force) {
    for (std::size_t c = 0; c < 3; ++c)
      values_[3 * index(local_node) + c] += force[static_cast<Eigen::Index>(c)];
  }
  void finish() {
    Vec local = nullptr;
    PetscScalar* array = nullptr;
    check(VecGhostGetLocalForm(total_.get(), &local));
    check(VecGetArray(local, &array));
    std::copy(values_.begin(), values_.end(), array);
    check(VecRestoreArray(local, &array));
    check(VecGhostRestoreLocalForm(total_.get(), &local));
    check(VecGhostUpdateBegin(total_.get(), ADD_VALUES, SCATTER_REVERSE));
    check(VecGhostUpdateEnd(total_.get(), ADD_VALUES, SCATTER_REVERSE));
    const PetscScalar* owned = nullptr;
    check(VecGetArrayRead(total_.get(), &owned));
    for (std::size_t i = 0; i < out_.load.size(); ++i) out_.load[i] += owned[i];
    check(VecRestoreArrayRead(total_.get(), &owned));
  }

 private:
  Discretisation& out_;
  Vector total_;
  std::vector<double> values_ = std::vector<double>(3 * out_.node_point.size(), 0.);
};

/// Integrates tractions and torques over the faces of their regions with the element's own shape functions.
void DiscretisationBuilder::add_tractions() {
  LoadAssembly assembly(out);
  const dealii::QGauss<2> quadrature(static_cast<unsigned>(out.element.degree) + 2);
  const dealii::MappingQ1<3> mapping;
  dealii::FEFaceValues<3> values(mapping, node_element, quadrature,
                                 dealii::update_values | dealii::update_quadrature_points |
                                     dealii::update_JxW_values);
  for (const auto& applied : scene.loads) {
    if (applied.load.kind != cases::LoadKind::traction && applied.load.kind != cases::LoadKind::torque)
      continue;
    const double moment =
        applied.load.kind == cases::LoadKind::torque ? cases::polar_moment(scene.mesh, applied) : 1;
    const SelectedParts parts(applied.selection);
    const int* node = out.cell_nodes.data();
    for (const auto& cell : dofs.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      for (unsigned f = 0; f < 6; ++f) {
        const auto face = cell->face(f);
        if (!face->at_boundary() || parts.faces.count(sorted_vertices<4>(face)) == 0) continue;
        values.reinit(static_cast<const dealii::Triangulation<3>::active_cell_iterator&>(cell), f);
        for (unsigned q = 0; q < quadrature.size(); ++q) {
          const Vector3d traction =
              cases::surface_traction(applied, to_eigen(values.quadrature_point(q)), moment);
          for (unsigned a = 0; a < node_element.n_dofs_per_cell(); ++a)
            assembly.add(node[a], values.JxW(q) * values.shape_value(a, q) * traction);
        }
      }
      node += out.nodes_per_cell;
    }
  }
  assembly.finish();
}

void DiscretisationBuilder::add_body_force(const Prescribed& prescribed) {
  if (!prescribed.body_force) return;
  LoadAssembly assembly(out);
  for (int cell = 0; cell < out.n_cells; ++cell)
    for (int q = 0; q < out.points_per_cell; ++q) {
      const Vector3d force =
          out.geometry(cell).weights[q] * prescribed.body_force(out.quadrature_point(cell, q));
      for (int a = 0; a < out.nodes_per_cell; ++a)
        assembly.add(out.cell_nodes[index(cell * out.nodes_per_cell + a)],
                     out.shape_values[index(q * out.nodes_per_cell + a)] * force);
    }
  assembly.finish();
}

Discretisation::Discretisation(const cases::Scene& scene, const ElementType& the_element,
                               const Prescribed& prescribed_values, MPI_Comm the_communicator)
    : communicator(the_communicator), element(the_element) {
  DiscretisationBuilder builder(*this, scene);
  builder.create_mesh();
  builder.distribute_nodes();
  builder.compute_geometry();
  builder.apply_fixed_regions(prescribed_values);
  builder.create_tangent();
  builder.add_point_forces();
  builder.add_tractions();
  builder.add_body_force(prescribed_values);
}

Discretisation::~Discretisation() = default;

void Discretisation::prescribe(double load_factor, std::vector<double>& displacement) const {
  displacement.resize(prescribed.size());
  for (std::size_t i = 0; i < prescribed.size(); ++i) displacement[i] = load_factor * prescribed[i];
  for (const auto& [node, motion] : moved) {
    const Vector3d value = cases::moved_by(motion, node_point[index(node)], load_factor);
    for (std::size_t c = 0; c < 3; ++c)
      if (motion.components[c]) displacement[3 * index(node) + c] = value[static_cast<Eigen::Index>(c)];
  }
}

CellGeometry Discretisation::geometry(int cell) const {
  const auto c = index(cell), points = index(points_per_cell), nodes = index(nodes_per_cell);
  return {nodes_per_cell, points_per_cell, gradients_.data() + c * points * 3 * nodes,
          weights_.data() + c * points, modes_.data() + c * points * index(element.n_pressure_modes)};
}

Eigen::Vector3d Discretisation::quadrature_point(int cell, int point) const {
  Vector3d sum = Vector3d::Zero();
  for (int a = 0; a < nodes_per_cell; ++a)
    sum += shape_values[index(point * nodes_per_cell + a)] *
           node_point[index(cell_nodes[index(cell * nodes_per_cell + a)])];
  return sum;
}

Vector Discretisation::make_vector() const {
  Vec vector = nullptr;
  check(VecCreateGhostBlock(communicator, 3, 3 * n_owned_nodes, PETSC_DECIDE,
                            static_cast<PetscInt>(ghost_nodes.size()), ghost_nodes.data(), &vector));
  Vector owned_vector(vector);
  check(VecSet(vector, 0));
  return owned_vector;
}

} // namespace springproof::fem_reference
