#pragma once

#include "cases/case/elements.hpp"
#include "cases/scene/scene.hpp"
#include "tests/support/tetrahedra.hpp"

using namespace springproof;

/// Bodies of hexahedra as bodies of tetrahedra.
namespace tetrahedra {

/// Resolves the regions of a scene's definition on another mesh. Patches are none of them.
inline void resolve_again(cases::Scene& scene) {
  const cases::Case& definition = scene.definition;
  scene.constrained.clear();
  scene.moved.clear();
  for (const auto* list : {&definition.fixed, &definition.symmetry})
    for (const cases::Fixed& fixed : *list)
      scene.constrained.push_back({cases::select(scene.mesh, fixed.region), fixed.components});
  for (const cases::Moved& motion : definition.moved) {
    scene.moved.push_back({cases::select(scene.mesh, motion.region), motion});
    scene.constrained.push_back({scene.moved.back().selection, motion.components});
  }
  for (auto& applied : scene.loads)
    if (applied.load.on() != cases::loads::On::masses)
      applied.selection = cases::select(scene.mesh, applied.load.region);
  for (auto& mass : scene.masses) mass.selection = cases::select(scene.mesh, mass.added.region);
}

/// The scene of a body of hexahedra whose cells are cut.
/// @param element  in place of the case's
inline cases::Scene make_scene(const cases::Case& definition, cases::Element element) {
  cases::Case hexahedra = definition;
  hexahedra.fem.element = cases::Element::q1;
  hexahedra.fem.refine = 0;
  cases::Scene scene = cases::make_scene(hexahedra);
  scene.definition.fem.element = element;
  scene.definition.fem.refine = definition.fem.refine;
  scene.mesh = bodies::cut_in_tetrahedra(scene.mesh);
  std::vector<int> materials;
  for (const int material : scene.material_of_cell) materials.insert(materials.end(), 6, material);
  scene.material_of_cell = materials;
  resolve_again(scene);
  return scene;
}

/// A case's scene; where its element is a tetrahedron, the cells of its box are cut.
inline cases::Scene make_scene(const cases::Case& definition) {
  const cases::Element element = definition.fem.element;
  return cases::facts_of(element).is_tetrahedron ? make_scene(definition, element)
                                                 : cases::make_scene(definition);
}

} // namespace tetrahedra
