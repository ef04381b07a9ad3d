#include "cases/mesh/read_mesh.hpp"

#include "cases/case/installation.hpp"
#include "cases/mesh/confined.hpp"
#include "cases/mesh/fields.hpp"
#include "cases/mesh/mesh_file.hpp"
#include "cases/mesh/vtk_functions.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace springproof::cases {

namespace {

[[noreturn]] void refuse(const std::string& reason) {
  throw std::runtime_error(reason);
}

/// @return which format the file has
GmshFile format_of(const std::string& path) {
  std::ifstream stream(path);
  if (!stream) refuse(std::string("cannot be read: ") + std::strerror(errno));
  std::string heading;
  double version = 0;
  if (!(stream >> heading >> version) || heading != "$MeshFormat")
    refuse("is not a gmsh mesh, which begins with $MeshFormat and its version (meshio writes Fluent's format "
           "into "
           ".msh unless it is asked for \"gmsh\": a .vtu keeps the same)");
  if (version >= 2 && version < 3) return GmshFile::format_2;
  if (!(version >= 4 && version < 5))
    refuse(fmt::format("has format {}, must be 2.0 to 2.2, 4.0 or 4.1 (gmsh -save -format msh41 rewrites it)",
                       version));
  return GmshFile::format_4;
}

MeshFileContent content_by_gmsh(const GmshFunctions& gmsh, const std::string& path) {
  if (!std::ifstream(path)) refuse(std::string("cannot be read: ") + std::strerror(errno));
  const bool is_geometry = std::filesystem::path(path).extension() == ".geo";
  return gmsh.read(path, is_geometry ? GmshFile::geometry : format_of(path));
}

MeshFileContent content_by_vtk(const VtkFunctions& vtk, const MeshFile& file) {
  std::ifstream stream(file.file.path, std::ios::binary);
  if (!stream) refuse(std::string("cannot be read: ") + std::strerror(errno));
  return vtk.read_mesh({std::istreambuf_iterator<char>(stream), {}}, file.cell_groups);
}

/// @throws std::runtime_error if an index leads out of the mesh's arrays, or a position is not finite
void check(const Mesh& mesh) {
  const auto exist = [n_nodes = mesh.nodes.size()](const auto& nodes) {
    return std::all_of(nodes.begin(), nodes.end(),
                       [&](int node) { return node >= 0 && index(node) < n_nodes; });
  };
  const auto all_exist = [&](const auto& lists) { return std::all_of(lists.begin(), lists.end(), exist); };
  const ReferenceCell& shape = reference_cell(mesh.shape);
  const auto is_cell = [&](const CellNodes& cell) { return cell.size() == shape.n_vertices; };
  const auto is_face = [&](const FaceNodes& face) { return face.size() == shape.faces[0].size(); };
  bool is_sound = !mesh.cells.empty() && all_exist(mesh.cells) &&
                  std::all_of(mesh.cells.begin(), mesh.cells.end(), is_cell) &&
                  (mesh.group_of_cell.empty() || mesh.group_of_cell.size() == mesh.cells.size()) &&
                  std::all_of(mesh.nodes.begin(), mesh.nodes.end(),
                              [](const Eigen::Vector3d& node) { return node.allFinite(); });
  for (const auto& [name, group] : mesh.groups)
    is_sound = is_sound && exist(group.nodes) && all_exist(group.edges) && all_exist(group.faces) &&
               std::all_of(group.faces.begin(), group.faces.end(), is_face);
  if (!is_sound) throw std::runtime_error("is no sound mesh");
}

} // namespace

std::string bytes_of_mesh(const Mesh& mesh) {
  return to_bytes(mesh.shape, mesh.nodes.to_vector(), mesh.cells.to_vector(), mesh.groups,
                  mesh.group_of_cell);
}

Mesh mesh_from(const std::string& bytes) {
  Mesh mesh;
  from_bytes(bytes, mesh.shape, mesh.nodes.stored(), mesh.cells.stored(), mesh.groups, mesh.group_of_cell);
  check(mesh);
  find_grid(mesh);
  return mesh;
}

Mesh read_mesh(const MeshFile& mesh, std::vector<std::string>* remarks) {
  const NamedFile& file = mesh.file;
  std::error_code absent;
  if (!std::filesystem::is_regular_file(file.path, absent))
    file.refuse(absent ? absent.message() : "is no regular file");
  const std::string ending = std::filesystem::path(file.path).extension().string();
  const bool is_geometry = ending == ".geo", is_of_vtk = ending == ".vtu" || ending == ".vtk";
  if (is_geometry && std::filesystem::exists(file.path + ".opt", absent))
    file.refuse("has options for gmsh beside it, " + file.path +
                ".opt: write them into the .geo (Mesh.X = ...;)");
  try { // A .geo is a program, gmsh and VTK crash on some broken meshes, and their answers may be anything.
    // The libraries, a tenth of a second, are loaded before the child is confined.
    const GmshFunctions* const gmsh =
        is_of_vtk ? nullptr : static_cast<const GmshFunctions*>(load_shared_object("springproof_gmsh"));
    const VtkFunctions* const of_vtk = is_of_vtk ? &vtk() : nullptr;
    const Limits limits =
        is_geometry ? limits_to_mesh : limits_to_read(std::filesystem::file_size(file.path));
    const auto work = [&] {
      MeshWithRemarks made =
          mesh_of(is_of_vtk ? content_by_vtk(*of_vtk, mesh) : content_by_gmsh(*gmsh, file.path));
      for (Eigen::Vector3d& node : made.mesh.nodes.stored()) node *= mesh.scale;
      return to_bytes(made.remarks, bytes_of_mesh(made.mesh));
    };
    std::vector<std::string> found;
    std::string bytes;
    from_bytes(run_confined(work, limits), found, bytes);
    for (const std::string& remark : found)
      if (remarks) remarks->push_back(file.path + ": " + remark);
    return mesh_from(bytes);
  } catch (const std::exception& error) {
    file.refuse(error.what());
  }
}

} // namespace springproof::cases
