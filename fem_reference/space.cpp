#include "fem_reference/space.hpp"

#include "cases/mesh/sharing.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/fe/mapping_q1.h>

namespace springproof::fem_reference {

namespace {

using dealii::FE_Q, dealii::FE_SimplexP;

bool is_tetrahedron(const ElementType& type) {
  return type.shape == cases::CellShape::tetrahedron;
}

/// p4est, which deals out hexahedra, takes no tetrahedra: these are dealt out by their numbers, as answers
/// are (cases::share_of()).
std::unique_ptr<dealii::parallel::TriangulationBase<3>> make_mesh(const ElementType& type,
                                                                  MPI_Comm communicator) {
  if (!is_tetrahedron(type))
    return std::make_unique<dealii::parallel::distributed::Triangulation<3>>(communicator);
  using Shared = dealii::parallel::shared::Triangulation<3>;
  auto mesh = std::make_unique<Shared>(communicator, dealii::Triangulation<3>::none, true,
                                       Shared::partition_custom_signal);
  mesh->signals.create.connect([mesh = mesh.get(), communicator] {
    const auto n_cells = static_cast<std::size_t>(mesh->n_active_cells());
    const auto n_ranks = static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(communicator));
    for (int rank = 0; rank < n_ranks; ++rank) {
      const cases::Range part = cases::part_of(n_cells, rank, n_ranks);
      for (const auto& cell : mesh->active_cell_iterators())
        if (part.has(static_cast<std::size_t>(cell->index())))
          cell->set_subdomain_id(static_cast<unsigned>(rank));
    }
  });
  return mesh;
}

std::unique_ptr<dealii::Mapping<3>> make_mapping(const ElementType& type) {
  if (is_tetrahedron(type)) return std::make_unique<dealii::MappingFE<3>>(FE_SimplexP<3>(1));
  return std::make_unique<dealii::MappingQ1<3>>();
}

std::unique_ptr<dealii::FiniteElement<3>> make_element(const ElementType& type) {
  const auto degree = static_cast<unsigned>(type.degree);
  if (is_tetrahedron(type)) return std::make_unique<FE_SimplexP<3>>(degree);
  return std::make_unique<FE_Q<3>>(degree);
}

dealii::Quadrature<3> make_quadrature(const ElementType& type) {
  const auto degree = static_cast<unsigned>(type.degree);
  // One point of order 1, or four of order 2; QGaussSimplex<3>(2) has more.
  if (is_tetrahedron(type)) return dealii::QWitherdenVincentSimplex<3>(1, degree == 1);
  return dealii::QGauss<3>(degree + 1);
}

dealii::Quadrature<2> make_quadrature_of_faces(const ElementType& type) {
  const auto degree = static_cast<unsigned>(type.degree);
  if (is_tetrahedron(type)) return dealii::QGaussSimplex<2>(degree + 2);
  return dealii::QGauss<2>(degree + 2);
}

} // namespace

Space::Space(const cases::Scene& scene, const ElementType& type, MPI_Comm communicator)
    : shape(type.shape), mesh(make_mesh(type, communicator)), mapping(make_mapping(type)),
      node_element(make_element(type)),
      element(*node_element, static_cast<unsigned>(type.n_unknowns_per_node())), dofs(*mesh),
      quadrature(make_quadrature(type)), quadrature_of_faces(make_quadrature_of_faces(type)) {
  std::vector<dealii::Point<3>> vertices;
  for (const Eigen::Vector3d& node : scene.mesh.nodes) vertices.emplace_back(node.x(), node.y(), node.z());
  std::vector<dealii::CellData<3>> cells;
  for (const cases::CellNodes& nodes : scene.mesh.cells) {
    cells.emplace_back(static_cast<unsigned>(nodes.size()));
    cells.back().vertices.assign(nodes.begin(), nodes.end());
  }
  mesh->create_triangulation(vertices, cells, dealii::SubCellData());
  dofs.distribute_dofs(element);
}

} // namespace springproof::fem_reference
