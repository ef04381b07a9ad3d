#include "compare/solve/refined_meshes.hpp"

#include "fem_reference/model.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// Every node of the region belongs to a face of it: what is shared by more and more nodes tends to a
/// traction.
bool is_area(const cases::Selection& selection) {
  std::vector<int> on_faces;
  for (const auto& face : selection.faces) on_faces.insert(on_faces.end(), face.begin(), face.end());
  std::sort(on_faces.begin(), on_faces.end());
  return std::all_of(selection.nodes.begin(), selection.nodes.end(),
                     [&](int node) { return std::binary_search(on_faces.begin(), on_faces.end(), node); });
}

} // namespace

std::optional<std::string> reason_without_continuum_limit(const cases::Scene& scene) {
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    const auto& [selection, load] = scene.loads[i];
    const bool is_point_force = load.kind == cases::LoadKind::nodal_force ||
                                (load.kind == cases::LoadKind::total_force && !is_area(selection));
    if (is_point_force && !load.value.isZero(0))
      return fmt::format(
          "load[{}] is a concentrated force (on points or edges), which has no continuum limit: the "
          "displacement under it grows without bound as the mesh is refined; use a traction",
          i);
  }
  return std::nullopt;
}

cases::Scene with_fem(cases::Scene scene, const cases::Fem& fem) {
  scene.definition.fem = fem;
  return scene;
}

RefinedMeshes solve_refined(const cases::Scene& scene, const cases::Solution& own, int n_meshes) {
  if (const auto reason = reason_without_continuum_limit(scene)) return {{}, {}, *reason};
  if (own.status != cases::Status::converged) return {{}, {}, "the case's own mesh was not solved"};
  RefinedMeshes meshes;
  cases::Fem fem = scene.definition.fem;
  const int own_refine = fem.refine, finest = std::max(n_meshes - 1, own_refine);
  for (fem.refine = finest - n_meshes + 1; fem.refine <= finest; ++fem.refine) {
    meshes.refine.push_back(fem.refine);
    try {
      meshes.solutions.push_back(fem.refine == own_refine
                                     ? own
                                     : fem_reference::Model(with_fem(scene, fem), MPI_COMM_WORLD).solve());
    } catch (const cases::SolveError& error) {
      return {{}, {}, fmt::format("the mesh refined {} times was not solved: {}", fem.refine, error.what())};
    }
  }
  return meshes;
}

} // namespace springproof::compare
