#include "cases/mesh/fill_surface.hpp"

#include "cases/case/installation.hpp"
#include "cases/mesh/confined.hpp"
#include "cases/mesh/fields.hpp"
#include "cases/mesh/read_mesh.hpp"
#include "cases/mesh/voxels.hpp"
#include "cases/mesh/vtk_functions.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

constexpr double most_tetrahedra = 20e6;
/// Volume of a tetrahedron over the cube of its edge, if all six are equally long; gmsh's are about as large.
const double volume_of_regular = 1 / (6 * std::sqrt(2.));

double enclosed_volume(const TriangleMesh& surface) {
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles)
    volume +=
        surface.vertices[index(a)].dot(surface.vertices[index(b)].cross(surface.vertices[index(c)])) / 6;
  return std::abs(volume);
}

std::string place_of(const Vector3d& point) {
  return fmt::format("({:.6g})", fmt::join(point, ", "));
}

/// Checks that every edge has two triangles.
void check_is_closed(const TriangleMesh& surface, const FilledSurface& body) {
  std::map<std::array<int, 2>, int> n_triangles;
  for (const auto& triangle : surface.triangles)
    for (std::size_t v = 0; v < 3; ++v) ++n_triangles[sorted(std::array{triangle[v], triangle[(v + 1) % 3]})];
  const auto refuse_if = [&](const auto& is_wrong, const std::string& what, const std::string& remedy) {
    const auto counts = [&](const auto& entry) { return is_wrong(entry.second); };
    const auto first = std::find_if(n_triangles.begin(), n_triangles.end(), counts);
    if (first == n_triangles.end()) return;
    const auto& [a, b] = first->first;
    body.file.refuse(fmt::format(what, std::count_if(n_triangles.begin(), n_triangles.end(), counts)) +
                     fmt::format(", one of them from {} to {} mm: ", place_of(surface.vertices[index(a)]),
                                 place_of(surface.vertices[index(b)])) +
                     remedy);
  };
  refuse_if([](int n) { return n == 1; }, "is open: {} of its edges belong to one triangle",
            "close its holes (MeshLab: Filters, Remeshing, Close Holes)");
  refuse_if([](int n) { return n > 2; },
            "is no surface of one body: {} of its edges belong to more than two triangles",
            "take parts that touch apart (MeshLab: Repair Non Manifold Edges), or fill = \"cubes\"");
}

/// Reads the surface in mm.
Surface scaled_surface(const FilledSurface& body, std::vector<std::string>* remarks) {
  Surface surface = read_body_surface(body.file, remarks);
  for (auto& triangle : surface)
    for (Vector3d& vertex : triangle) vertex *= body.scale;
  return surface;
}

Voxels as_voxels(const FilledSurface& body) {
  return {body.file, body.size, body.scale};
}

MeshWithRemarks filled_by_gmsh(const TriangleMesh& surface, const FilledSurface& body) {
  const auto& gmsh = *static_cast<const GmshFunctions*>(load_shared_object("springproof_gmsh"));
  std::vector<std::array<double, 3>> vertices;
  for (const Vector3d& vertex : surface.vertices) vertices.push_back({vertex.x(), vertex.y(), vertex.z()});
  const auto work = [&] {
    const MeshWithRemarks made = mesh_of(gmsh.fill(vertices, surface.triangles, body.size));
    return to_bytes(made.remarks, bytes_of_mesh(made.mesh));
  };
  MeshWithRemarks filled;
  std::string bytes;
  from_bytes(run_confined(work, limits_to_mesh), filled.remarks, bytes);
  filled.mesh = mesh_from(bytes);
  return filled;
}

Mesh fill_with_tetrahedra(const TriangleMesh& surface, const FilledSurface& body,
                          std::vector<std::string>& remarks) {
  check_is_closed(surface, body);
  const Vector3d extent = bounding_box(surface.vertices).sizes();
  const double n_cells = enclosed_volume(surface) / (volume_of_regular * std::pow(body.size, 3));
  if (!(n_cells <= most_tetrahedra))
    body.file.refuse(fmt::format("needs {:.2g} tetrahedra with edges of {} mm, must need at most {:.0e}: {}",
                                 n_cells, body.size, most_tetrahedra, scale_hint(extent)));
  if (!(body.size <= extent.maxCoeff()))
    body.file.refuse(
        fmt::format("is smaller than an edge of {} mm, the size: {}", body.size, scale_hint(extent)));
  try {
    MeshWithRemarks filled = filled_by_gmsh(surface, body);
    for (const std::string& remark : filled.remarks) remarks.push_back(body.file.path + ": " + remark);
    return std::move(filled.mesh);
  } catch (const std::exception& error) {
    body.file.refuse(fmt::format(
        "cannot be filled with tetrahedra ({}): where it crosses or touches itself, mend it (MeshLab: Select "
        "Self Intersecting Faces; Blender: 3D Print Toolbox), give another size, or take fill = \"cubes\"",
        error.what()));
  }
}

/// The largest distance of vertices and middles of triangles of one surface from another, mm.
double largest_distance(const TriangleMesh& from, const TriangleMesh& to) {
  std::vector<Vector3d> points = from.vertices;
  for (const auto& triangle : from.triangles) points.push_back(barycentre(triangle, from.vertices));
  const std::vector<double> distances = vtk().distances(to, points);
  return *std::max_element(distances.begin(), distances.end());
}

} // namespace

double count_cells(const FilledSurface& body) {
  if (body.fill == Fill::cubes) return count_voxels(as_voxels(body)).in_body;
  return enclosed_volume(joined(scaled_surface(body, nullptr))) /
         (volume_of_regular * std::pow(body.size, 3));
}

Mesh fill_surface(const FilledSurface& body, std::vector<std::string>& remarks) {
  const Surface triangles = scaled_surface(body, &remarks);
  const TriangleMesh surface = joined(triangles);
  if (surface.triangles.empty()) body.file.refuse("has no triangle with three different corners");
  Mesh mesh = body.fill == Fill::cubes ? make_voxel_mesh(triangles, as_voxels(body))
                                       : fill_with_tetrahedra(surface, body, remarks);
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) volume += cell_volume(cell_corners(mesh, c));
  const TriangleMesh outside = triangles_of_faces(mesh, boundary_faces(mesh));
  const double enclosed = enclosed_volume(surface),
               distance = std::max(largest_distance(outside, surface), largest_distance(surface, outside));
  remarks.push_back(
      fmt::format("{}: {} {} fill {:.6g} of its {:.6g} mm3 ({:+.2g} %), and their surface is at most "
                  "{:.3g} mm from it: limits are those of the cells' body",
                  body.file.path, mesh.cells.size(),
                  body.fill == Fill::cubes ? "cubes" : reference_cell(mesh.shape).names, volume, enclosed,
                  100 * (volume / enclosed - 1), distance));
  return mesh;
}

} // namespace springproof::cases
