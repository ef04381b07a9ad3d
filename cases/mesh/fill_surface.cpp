#include "cases/mesh/fill_surface.hpp"

#include "cases/case/installation.hpp"
#include "cases/mesh/closed_surface.hpp"
#include "cases/mesh/confined.hpp"
#include "cases/mesh/fields.hpp"
#include "cases/mesh/read_mesh.hpp"
#include "cases/mesh/voxels.hpp"
#include "cases/mesh/vtk_functions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

constexpr const char* mend_it =
    "where it crosses or touches itself, mend it (MeshLab: Select Self Intersecting Faces; Blender: 3D Print "
    "Toolbox), give another size, or take fill = \"cubes\"";
constexpr double most_tetrahedra = 20e6;
/// Volume of a tetrahedron over the cube of its edge, if all six are equally long; gmsh's are about as large.
const double volume_of_regular = 1 / (6 * std::sqrt(2.));
const double area_of_regular = std::sqrt(3.) / 4; ///< the same of its faces, over the square

double enclosed_volume(const TriangleMesh& surface) {
  const std::vector<double> volumes = volumes_of_parts(surface);
  return std::abs(std::accumulate(volumes.begin(), volumes.end(), 0.));
}

/// Reads the surface in mm.
Surface scaled_surface(const FilledSurface& body, std::vector<std::string>* remarks) {
  Surface surface = read_body_surface(body.file, remarks);
  for (auto& triangle : surface)
    for (Vector3d& vertex : triangle) vertex *= body.scale;
  return surface;
}

bool has_cells(const MeshFileContent& content) {
  return std::any_of(content.elements.begin(), content.elements.end(), [](const auto& of_entity) {
    return of_entity.first[0] == 3 && !of_entity.second.empty();
  });
}

/// The same surface with every triangle divided into four. gmsh's partition of a surface (METIS) finds no end
/// on one of four triangles.
TriangleMesh divided(const TriangleMesh& surface) {
  TriangleMesh fine{surface.vertices, {}};
  std::map<std::array<int, 2>, int> middles; // by edge
  const auto middle = [&](int a, int b) {
    const auto [found, is_new] =
        middles.try_emplace(sorted(std::array{a, b}), static_cast<int>(fine.vertices.size()));
    if (is_new) fine.vertices.emplace_back((surface.vertices[index(a)] + surface.vertices[index(b)]) / 2);
    return found->second;
  };
  for (const auto& [a, b, c] : surface.triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const std::array<int, 3>& part :
         {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
      fine.triangles.push_back(part);
  }
  return fine;
}

/// Ten times what gmsh takes.
Limits limits_to_fill(const TriangleMesh& surface, double n_cells) {
  const double seconds = 30 + 2e-3 * double(surface.triangles.size()) + 1e-3 * n_cells;
  return {static_cast<int>(std::min(seconds, double(limits_to_mesh.seconds))), limits_to_mesh.bytes};
}

MeshWithRemarks filled_by_gmsh(TriangleMesh surface, const FilledSurface& body, double n_cells) {
  constexpr std::size_t few = 100;
  while (surface.triangles.size() < few) surface = divided(surface);
  const auto& gmsh = *static_cast<const GmshFunctions*>(load_shared_object("springproof_gmsh"));
  std::vector<std::array<double, 3>> vertices;
  for (const Vector3d& vertex : surface.vertices) vertices.push_back({vertex.x(), vertex.y(), vertex.z()});
  const auto work = [&] {
    MeshFileContent content = gmsh.fill(vertices, surface.triangles, body.size);
    if (!has_cells(content)) throw std::runtime_error("gmsh finds no inside");
    const MeshWithRemarks made = mesh_of(std::move(content));
    return to_bytes(made.remarks, bytes_of_mesh(made.mesh));
  };
  MeshWithRemarks filled;
  std::string bytes;
  from_bytes(run_confined(work, limits_to_fill(surface, n_cells)), filled.remarks, bytes);
  filled.mesh = mesh_from(bytes);
  return filled;
}

Mesh fill_with_tetrahedra(const TriangleMesh& surface, const FilledSurface& body,
                          std::vector<std::string>& remarks) {
  check_is_closed(surface, body.file, ", or fill = \"cubes\"");
  const Vector3d extent = bounding_box(surface.vertices).sizes();
  const double area = area_of(surface);
  if (!has_volume(surface))
    body.file.refuse("encloses no volume: its triangles lie in a plane, or double each other");
  // A flat body has two tetrahedra and more for each triangle of its surface.
  const double n_cells = std::max(enclosed_volume(surface) / (volume_of_regular * std::pow(body.size, 3)),
                                  2 * area / (area_of_regular * std::pow(body.size, 2)));
  if (!(n_cells <= most_tetrahedra))
    body.file.refuse(fmt::format("needs {:.2g} tetrahedra with edges of {} mm, must need at most {:.0e}: {}",
                                 n_cells, body.size, most_tetrahedra, scale_hint(extent)));
  constexpr double most_edges = 1e4; // along the body
  if (!(extent.maxCoeff() <= most_edges * body.size))
    body.file.refuse(fmt::format("is {:.3g} mm long, must be at most {:.0e} edges of {} mm: {}",
                                 extent.maxCoeff(), most_edges, body.size, scale_hint(extent)));
  if (!(body.size <= extent.maxCoeff()))
    body.file.refuse(
        fmt::format("is smaller than an edge of {} mm, the size: {}", body.size, scale_hint(extent)));
  try {
    MeshWithRemarks filled = filled_by_gmsh(surface, body, n_cells);
    for (const std::string& remark : filled.remarks) remarks.push_back(body.file.path + ": " + remark);
    return std::move(filled.mesh);
  } catch (const std::exception& error) {
    if (const std::size_t n = volumes_of_parts(surface).size(); n > 1)
      body.file.refuse(
          fmt::format("cannot be filled with tetrahedra ({}): it has {} parts that share no vertex. "
                      "Those that overlap must be united (Blender: Boolean, Union), or fill = "
                      "\"cubes\"; those that lie apart are bodies of their own",
                      error.what(), n));
    body.file.refuse(fmt::format("cannot be filled with tetrahedra ({}): {}", error.what(), mend_it));
  }
}

/// The largest distance of vertices and middles of triangles of one surface from another, mm.
double largest_distance(const TriangleMesh& from, const TriangleMesh& to) {
  std::vector<Vector3d> points = from.vertices;
  for (const auto& triangle : from.triangles) points.push_back(barycentre(triangle, from.vertices));
  double largest = 0;
  for (const double distance : vtk().distances(to, points)) largest = std::max(largest, std::abs(distance));
  return largest > 1e-9 * bounding_box(points).sizes().norm() ? largest : 0; // rounding
}

} // namespace

std::optional<Voxels> as_voxels(const FilledSurface& body) {
  if (body.fill != Fill::cubes) return std::nullopt;
  return Voxels{body.file, body.size, body.scale};
}

double count_tetrahedra(const FilledSurface& body) {
  return enclosed_volume(joined(scaled_surface(body, nullptr))) /
         (volume_of_regular * std::pow(body.size, 3));
}

Mesh fill_surface(const FilledSurface& body, std::vector<std::string>& remarks) {
  const Surface triangles = scaled_surface(body, &remarks);
  const TriangleMesh surface = joined(triangles);
  if (surface.triangles.empty()) body.file.refuse("has no triangle with three different corners");
  const std::optional<Voxels> voxels = as_voxels(body);
  Mesh mesh = voxels ? make_voxel_mesh(triangles, *voxels) : fill_with_tetrahedra(surface, body, remarks);
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) volume += cell_volume(cell_corners(mesh, c));
  const TriangleMesh outside = triangles_of_faces(mesh, boundary_faces(mesh));
  const double enclosed = enclosed_volume(surface),
               distance = std::max(largest_distance(outside, surface), largest_distance(surface, outside));
  // Between two surfaces there is about the area times the distance at most. What crosses itself bounds
  // another volume than it seems to.
  const double between = 2 * area_of(surface) * distance + 1e-5 * enclosed; // the files' single precision
  if (body.fill == Fill::tetrahedra && !(std::abs(volume - enclosed) <= between))
    body.file.refuse(fmt::format("bounds {:.6g} mm3, and gmsh fills {:.6g} mm3 of it with tetrahedra: {}",
                                 enclosed, volume, mend_it));
  remarks.push_back(
      fmt::format("{}: {} {} fill {:.6g} of its {:.6g} mm3 ({:+.2f} %), and their surface is at most "
                  "{:.3g} mm from it: limits are those of the cells' body",
                  body.file.path, mesh.cells.size(),
                  body.fill == Fill::cubes ? "cubes" : reference_cell(mesh.shape).names, volume, enclosed,
                  100 * (volume / enclosed - 1), distance));
  return mesh;
}

} // namespace springproof::cases
