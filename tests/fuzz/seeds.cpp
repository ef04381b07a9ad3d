// seeds FOLDER: writes meshes and answers in today's format into FOLDER/mesh and FOLDER/kept, from which the
// fuzzers begin.

#include "cases/mesh/labels.hpp"
#include "cases/mesh/read_mesh.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "compare/solve/fields.hpp"

#include <filesystem>
#include <fstream>

using namespace springproof;

namespace {

cases::Mesh bar() {
  cases::Mesh mesh = cases::make_box_mesh({2, 1, 1}, {2, 1, 1});
  mesh.groups["end"] = {{0, 3, 6, 9}, {{0, 3}}, {{0, 6, 9, 3}}};
  mesh.group_of_cell = {"left", "right"};
  return mesh;
}

cases::Mesh wedge() {
  cases::Mesh mesh = cases::make_box_mesh({2, 1, 1}, {2, 1, 1});
  mesh.nodes.stored()[2].x() += 0.3;
  return mesh;
}

/// The same box of tetrahedra around the diagonals of its cells.
cases::Mesh tetrahedra() {
  const cases::Mesh box = cases::make_box_mesh({2, 1, 1}, {2, 1, 1});
  cases::Mesh mesh;
  mesh.shape = cases::CellShape::tetrahedron;
  mesh.nodes = box.nodes;
  for (const cases::CellNodes& cell : box.cells)
    for (const auto& [a, b] : {std::pair(1, 3), {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}})
      mesh.cells.stored().push_back(cases::pick(cell, cases::CellNodes{0, a, b, 7}));
  mesh.groups["end"] = {{0, 3, 6, 9}, {{0, 3}}, {{0, 6, 9}, {0, 9, 3}}};
  mesh.group_of_cell.assign(mesh.cells.size(), "left");
  return mesh;
}

cases::Surface boundary(const cases::Mesh& mesh) {
  cases::Surface surface;
  for (const auto& face : cases::boundary_faces(mesh))
    for (const std::array<std::size_t, 3>& corners : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}}) {
      auto& triangle = surface.emplace_back();
      for (std::size_t v = 0; v < 3; ++v) triangle[v] = mesh.nodes[cases::index(face[corners[v]])];
    }
  return surface;
}

/// Points and fields on the box that the fuzzers match displacements with.
cases::PointCloud cloud() {
  cases::PointCloud cloud;
  cloud.points = cases::make_box_mesh({2, 2, 2}, {2, 2, 2}).nodes.to_vector();
  cloud.fields = {{"displacement", cloud.points}, {"velocity", cloud.points}};
  return cloud;
}

/// Every node takes the value of its own point.
cases::CellCloud cells() {
  cases::CellCloud cells{cloud(), {}, {}};
  for (int p = 0; p < static_cast<int>(cells.cloud.points.size()); ++p) {
    cells.to_nodes.first.push_back(cases::index(p));
    cells.to_nodes.points.push_back(p);
    cells.to_nodes.weights.push_back(1);
    cells.to_nodes.outside.push_back(0);
  }
  cells.to_nodes.first.push_back(cells.cloud.points.size());
  cells.from_nodes = cells.to_nodes;
  return cells;
}

/// Answers for a mesh of one cell.
compare::Answers answers() {
  compare::Answers answers;
  answers.choices = {"formulation: small_strain"};
  cases::Solution& solution = answers.fem.solution;
  solution.status = cases::Status::converged;
  solution.displacement.assign(8, Eigen::Vector3d(0, 0.01, 0));
  solution.cell_volume = {1};
  solution.lowest_eigenvalue = 0.1;
  answers.msm = answers.fem;
  answers.msm.solution.fields = cases::Fields{std::vector<Eigen::Vector3d>(8, {0, 0, 1}),
                                              0.1,
                                              true,
                                              {0.1},
                                              {{1, 2, 3, 4, 5, 6}},
                                              {{0, 0, 0, 0, 0, 0}}};
  answers.design = msm::DesignResult{};
  answers.design->warnings = {"a warning"};
  answers.refined = compare::RefinedMeshes{{0, 1}, {solution, solution}, ""};
  answers.peer = compare::Peer{"CalculiX", answers.fem, 1e-7};
  return answers;
}

} // namespace

int main(int, char** argv) {
  const std::filesystem::path folder = argv[1];
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << bytes;
  };
  write("mesh/bar", cases::bytes_of_mesh(bar()));
  write("mesh/wedge", cases::bytes_of_mesh(wedge()));
  write("mesh/tetrahedra", cases::bytes_of_mesh(tetrahedra()));
  write("stl/box", cases::bytes_of(boundary(cases::make_box_mesh({2, 1, 1}, {1, 1, 1}))));
  write("stl/wedge", cases::bytes_of(boundary(wedge())));
  write("vtp/box", cases::bytes_of(boundary(cases::make_box_mesh({2, 2, 2}, {1, 1, 1}))));
  write("vtp/wedge", cases::bytes_of(boundary(wedge())));
  write("vtu/cloud", cases::bytes_of(cloud()));
  write("vtu/cells", cases::bytes_of(cells()));
  write("labels/grid", cases::bytes_of(cases::LabelGrid{{3, 2, 1}, {0, 0, 0}, {1, 2, 0, 2, 0, 1}}));
  write("kept/answers", cases::to_bytes(answers()));
  write("kept/answer", cases::to_bytes(answers().fem));
}
