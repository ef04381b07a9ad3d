#include "compare/write/write.hpp"

namespace springproof::compare {

void write_vtu(std::ostream& out, const Comparison& comparison) {
  const cases::Solution &fem = comparison.answers.fem.solution, &msm = comparison.answers.msm.solution;
  std::vector<cases::PointField> displacements;
  std::vector<cases::CellField> volumes;
  const auto add = [&](const std::string& side, const cases::Solution& solution) {
    if (solution.displacement.empty()) return;
    displacements.push_back({side + "_displacement", solution.displacement});
    volumes.push_back({side + "_cell_volume", solution.cell_volume});
  };
  add("fem", fem);
  add("msm", msm);
  if (displacements.size() == 2) {
    std::vector<Eigen::Vector3d> difference = msm.displacement;
    for (std::size_t n = 0; n < difference.size(); ++n) difference[n] -= fem.displacement[n];
    displacements.push_back({"difference", difference});
  }
  out << cases::vtk().write_unstructured_grid(comparison.scene.mesh, displacements, volumes);
}

void write_vtu(std::ostream& out, const cases::HexMesh& mesh, const std::vector<cases::PointField>& fields) {
  out << cases::vtk().write_unstructured_grid(mesh, fields, {});
}

} // namespace springproof::compare
