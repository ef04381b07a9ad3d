#include "compare/design.hpp"

#include "fem_reference/element_stiffness.hpp"

namespace compare {

msm::DesignRequest design_request(const cases::Material& material, const msm::CellVertices& cell,
                                  const cases::Msm& options, cases::Element element) {
  return {material, cell, options,
          [cell, element](const cases::LinearElastic& elastic) {
            return fem_reference::element_stiffness(cell, elastic, element);
          },
          std::nullopt};
}

msm::DesignResult design_for(const cases::Scene& scene) {
  const cases::Msm& options = scene.definition.msm;
  if (!scene.mesh.grid && options.design != cases::Design::given)
    throw cases::InputError(options.where, "not available yet: designs for a mesh of unequal cells");
  return msm::design(design_request(scene.definition.material, cases::cell_vertices(scene.mesh, 0), options));
}

} // namespace compare
