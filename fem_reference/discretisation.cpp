#include "fem_reference/discretisation.hpp"

#include "cases/case/index.hpp"
#include "fem_reference/loads.hpp"
#include "fem_reference/space.hpp"
#include "fem_reference/tangent_matrix.hpp"

namespace springproof::fem_reference {

Discretisation::Discretisation(const cases::Scene& scene, const ElementType& type,
                               const Prescribed& prescribed, MPI_Comm all_ranks)
    : Discretisation(scene, type, prescribed, std::make_unique<Space>(scene, type, all_ranks)) {}

Discretisation::Discretisation(const cases::Scene& scene, const ElementType& type,
                               const Prescribed& prescribed, std::unique_ptr<Space> space)
    : communicator(space->mesh.get_communicator()), element(type), nodes(*space, scene),
      geometry(*space, nodes, element), constraints(scene, nodes, prescribed, communicator),
      load(assemble_loads(scene, *space, nodes, geometry, prescribed)), space_(std::move(space)) {
  if (!scene.material_of_cell.empty())
    for (const int cell : nodes.mesh_cell)
      material_of_cell.push_back(scene.material_of_cell[cases::index(cell)]);
}

Discretisation::~Discretisation() = default;

Matrix Discretisation::make_tangent_matrix() const {
  return fem_reference::make_tangent_matrix(*space_, nodes, constraints);
}

} // namespace springproof::fem_reference
