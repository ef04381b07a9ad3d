#include "compare/solve/springs.hpp"

#include "compare/solve/design.hpp"
#include "compare/solve/solve_side.hpp"
#include "msm/model.hpp"

#include <algorithm>
#include <random>

namespace springproof::compare {

namespace {

using Eigen::Vector3d;

/// The springs of every cell, stiffer beyond the plane.
std::vector<msm::CellStiffness> stiffened(std::vector<msm::CellStiffness> springs,
                                          const cases::Stiffer& stiffer, const cases::HexMesh& mesh) {
  if (springs.size() == 1) springs.resize(mesh.cells.size(), springs.front());
  for (std::size_t c = 0; c < springs.size(); ++c) {
    Vector3d centre = Vector3d::Zero();
    for (const Vector3d& vertex : cases::cell_vertices(mesh, c)) centre += vertex / 8;
    if (!(centre[static_cast<int>(stiffer.axis)] > stiffer.beyond)) continue;
    auto& [edge, face_diagonal, internal_diagonal, volume] = springs[c];
    for (double* k : {&edge, &face_diagonal, &internal_diagonal, &volume}) *k *= stiffer.factor;
  }
  return springs;
}

/// Displacements to start from, mm; empty: rest.
msm::Points start_points(const cases::Stress& stress, const cases::HexMesh& mesh) {
  msm::Points start;
  if (stress.start == cases::Start::perturbed) {
    std::mt19937 generator(static_cast<unsigned>(stress.seed));
    // Not std::uniform_real_distribution, whose numbers a standard library may choose.
    const auto any = [&] { return stress.amplitude * (2 * (double(generator()) / 4294967295.0) - 1); };
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const double x = any(), y = any(), z = any();
      start.emplace_back(x, y, z);
    }
  }
  if (stress.start == cases::Start::inverted) {
    double lowest = mesh.nodes.front().z();
    for (const Vector3d& node : mesh.nodes) lowest = std::min(lowest, node.z());
    for (const Vector3d& node : mesh.nodes) start.emplace_back(0, 0, 2 * (lowest - node.z()));
  }
  return start;
}

} // namespace

mechanics::EquilibriumSettings limited(const cases::Case& definition,
                                       mechanics::EquilibriumSettings settings) {
  if (!definition.stress) return settings;
  const cases::Stress& stress = *definition.stress;
  settings.first_load_step = settings.largest_load_step = 1.0 / stress.least_load_steps;
  settings.max_newton_iterations = stress.max_iterations;
  settings.lowest_eigenvalue = mechanics::LowestEigenvalue::report;
  settings.should_stop = [stopwatch = Stopwatch(), most = stress.max_seconds] {
    return stopwatch.seconds() > most;
  };
  return settings;
}

Answer solve_springs(const cases::Scene& scene, int n_threads, std::optional<msm::DesignResult>& design) {
  const auto& stress = scene.definition.stress;
  const mechanics::EquilibriumSettings settings = limited(scene.definition);
  return solve_side(
      [&] {
        design = design_for(scene);
        std::vector<msm::CellStiffness> springs = stiffness_of_cells(*design);
        if (stress && stress->stiffer) springs = stiffened(std::move(springs), *stress->stiffer, scene.mesh);
        return msm::Model(scene, springs, {msm::Path::automatic, n_threads});
      },
      [&](msm::Model& model) {
        return model.solve(settings, stress ? start_points(*stress, scene.mesh) : msm::Points{});
      });
}

} // namespace springproof::compare
