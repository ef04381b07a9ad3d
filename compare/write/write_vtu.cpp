#include "compare/write/write.hpp"

#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

/// VTK's order of a hexahedron's vertices in terms of v = i + 2j + 4k.
constexpr std::array<std::size_t, 8> vtk_order{0, 1, 3, 2, 4, 5, 7, 6};
constexpr int vtk_hexahedron = 12;

/// The raw block at the end of a .vtu: every array is preceded by its size in bytes and found by its offset.
/// (deal.II's DataOut would give every cell vertices of its own, and cell data to the vertices.)
class AppendedData {
 public:
  template<class Value>
  std::string array(const char* type, const std::string& name, int components,
                    const std::vector<Value>& values) {
    const std::size_t offset = bytes_.size();
    const std::uint64_t size = values.size() * sizeof(Value);
    append(&size, sizeof size);
    append(values.data(), size);
    return fmt::format(
               R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)",
               type, name, components, offset) +
           "\n";
  }
  std::string vectors(const std::string& name, const std::vector<Eigen::Vector3d>& values) {
    std::vector<double> flat;
    for (const Eigen::Vector3d& v : values) flat.insert(flat.end(), v.data(), v.data() + 3);
    return array("Float64", name, 3, flat);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }
  std::string bytes_;
};

std::string mesh_arrays(const cases::HexMesh& mesh, AppendedData& data) {
  std::vector<std::int64_t> connectivity, offsets;
  for (const auto& cell : mesh.cells) {
    for (std::size_t v : vtk_order) connectivity.push_back(cell[v]);
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  const std::vector<std::uint8_t> types(mesh.cells.size(), vtk_hexahedron);
  return "<Points>\n" + data.vectors("rest position", mesh.nodes) + "</Points>\n<Cells>\n" +
         data.array("Int64", "connectivity", 1, connectivity) + data.array("Int64", "offsets", 1, offsets) +
         data.array("UInt8", "types", 1, types) + "</Cells>\n";
}

/// The whole file. @param points, cells  descriptions of the arrays that are in data already
void write_grid(std::ostream& out, const cases::HexMesh& mesh, AppendedData& data, const std::string& points,
                const std::string& cells) {
  const std::string mesh_text = mesh_arrays(mesh, data);
  fmt::print(
      out,
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
      "{}<PointData>\n{}</PointData>\n<CellData>\n{}</CellData>\n</Piece>\n</UnstructuredGrid>\n"
      "<AppendedData encoding=\"raw\">\n_",
      mesh.nodes.size(), mesh.cells.size(), mesh_text, points, cells);
  out.write(data.bytes().data(), static_cast<std::streamsize>(data.bytes().size()));
  fmt::print(out, "\n</AppendedData>\n</VTKFile>\n");
}

} // namespace

void write_vtu(std::ostream& out, const Comparison& comparison) {
  const cases::HexMesh& mesh = comparison.scene.mesh;
  const cases::Solution &fem = comparison.answers.fem.solution, &msm = comparison.answers.msm.solution;
  AppendedData data;
  std::string points, cells;
  const auto add = [&](const char* side, const cases::Solution& solution) {
    if (solution.displacement.empty()) return;
    points += data.vectors(std::string(side) + "_displacement", solution.displacement);
    cells += data.array("Float64", std::string(side) + "_cell_volume", 1, solution.cell_volume);
  };
  add("fem", fem);
  add("msm", msm);
  if (!fem.displacement.empty() && !msm.displacement.empty()) {
    std::vector<Eigen::Vector3d> difference;
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
      difference.push_back(msm.displacement[n] - fem.displacement[n]);
    points += data.vectors("difference", difference);
  }
  write_grid(out, mesh, data, points, cells);
}

void write_vtu(std::ostream& out, const cases::HexMesh& mesh, const std::vector<PointField>& fields) {
  AppendedData data;
  std::string points;
  for (const PointField& field : fields) points += data.vectors(field.name, field.values);
  write_grid(out, mesh, data, points, "");
}

} // namespace springproof::compare
