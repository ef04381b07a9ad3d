#include "cases/scene/scene.hpp"

#include "cases/case/index.hpp"
#include "cases/case/names.hpp"
#include "cases/mesh/read_mesh.hpp"
#include "cases/mesh/voxels.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <sstream>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

constexpr double near_tolerance = 1e-6; ///< mm: `near` names a node and does not search for one

Selection select_near(const HexMesh& mesh, const Region& region) {
  const Vector3d& point = *region.near;
  int nearest = 0;
  for (int n = 1; n < static_cast<int>(mesh.nodes.size()); ++n)
    if ((mesh.nodes[index(n)] - point).squaredNorm() < (mesh.nodes[index(nearest)] - point).squaredNorm())
      nearest = n;
  const double distance = (mesh.nodes[index(nearest)] - point).norm();
  if (!(distance <= near_tolerance))
    throw InputError(
        region.where,
        fmt::format("no node within {} mm of ({}, {}, {}): the nearest is {:.6g} mm away at ({}, {}, {})",
                    near_tolerance, point.x(), point.y(), point.z(), distance, mesh.nodes[index(nearest)].x(),
                    mesh.nodes[index(nearest)].y(), mesh.nodes[index(nearest)].z()));
  return {{nearest}, {}, {}};
}

struct Plane {
  int axis;
  bool upper;
};

/// "z+ x-" as planes; nothing if a word is not the name of a face of a box.
std::optional<std::vector<Plane>> parse_planes(const std::string& name) {
  std::vector<Plane> planes;
  std::istringstream words(name);
  for (std::string word; words >> word;) {
    if (word.size() != 2 || word[0] < 'x' || word[0] > 'z' || (word[1] != '-' && word[1] != '+'))
      return std::nullopt;
    planes.push_back({word[0] - 'x', word[1] == '+'});
  }
  if (planes.empty()) return std::nullopt;
  return planes;
}

Selection select_on_planes(const HexMesh& mesh, const std::vector<Plane>& planes) {
  Vector3d lower = mesh.nodes.front(), upper = mesh.nodes.front();
  for (const Vector3d& node : mesh.nodes) {
    lower = lower.cwiseMin(node);
    upper = upper.cwiseMax(node);
  }
  const double rounding =
      1e-9 * (upper - lower).norm(); // far above the rounding of i * spacing, far below a cell
  std::vector<bool> selected(mesh.nodes.size());
  Selection selection;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    selected[n] = std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
      const double position = (plane.upper ? upper : lower)[plane.axis];
      return std::abs(mesh.nodes[n][plane.axis] - position) <= rounding;
    });
    if (selected[n]) selection.nodes.push_back(static_cast<int>(n));
  }
  std::set<std::array<int, 2>> edges;
  for (const auto& cell : mesh.cells) {
    for (const auto& local : cell_edges) {
      const auto [a, b] = std::minmax(cell[index(local[0])], cell[index(local[1])]);
      if (selected[index(a)] && selected[index(b)]) edges.insert({a, b});
    }
    for (const auto& local : cell_faces) {
      const std::array<int, 4> face{cell[index(local[0])], cell[index(local[1])], cell[index(local[2])],
                                    cell[index(local[3])]};
      if (std::all_of(face.begin(), face.end(), [&](int n) { return selected[index(n)]; }))
        selection.faces.push_back(face);
    }
  }
  selection.edges.assign(edges.begin(), edges.end());
  return selection;
}

/// The faces of the mesh's surface whose centre lies in the region's sphere, with their edges and nodes.
Selection select_patch(const HexMesh& mesh, const Region& region) {
  Selection patch;
  std::set<int> nodes;
  std::set<std::array<int, 2>> edges;
  for (const auto& face : boundary_faces(mesh)) {
    Vector3d centre = Vector3d::Zero();
    for (const int node : face) centre += mesh.nodes[index(node)] / 4;
    if (!((centre - *region.near).norm() <= *region.radius)) continue;
    patch.faces.push_back(face);
    for (std::size_t v = 0; v < 4; ++v) {
      const auto [a, b] = std::minmax(face[v], face[(v + 1) % 4]);
      nodes.insert(face[v]);
      edges.insert({a, b});
    }
  }
  if (patch.faces.empty())
    throw InputError(region.where, fmt::format("'{}' has no face of the body's surface", region.name));
  patch.nodes.assign(nodes.begin(), nodes.end());
  patch.edges.assign(edges.begin(), edges.end());
  return patch;
}

/// A patch becomes a group of the mesh, so that refined meshes keep the same patch.
void add_patch(HexMesh& mesh, const Region& region) {
  if (region.radius) mesh.groups.emplace(region.name, select_patch(mesh, region));
}

void add_patches(Scene& scene) {
  for (const Fixed& fixed : scene.definition.fixed) add_patch(scene.mesh, fixed.region);
  for (const Moved& moved : scene.definition.moved) add_patch(scene.mesh, moved.region);
  for (const Load& load : scene.definition.loads) add_patch(scene.mesh, load.region);
}

bool has_cell(const HexMesh& mesh, const RegionMaterial& region, std::size_t cell) {
  if (!region.group.empty()) return !mesh.group_of_cell.empty() && mesh.group_of_cell[cell] == region.group;
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& vertex : cell_vertices(mesh, cell)) centre += vertex / 8;
  return (centre.array() >= region.lower.array()).all() && (centre.array() <= region.upper.array()).all();
}

void resolve_materials(Scene& scene) {
  if (scene.definition.region_materials.empty()) return;
  scene.material_of_cell.assign(scene.mesh.cells.size(), 0);
  int material = 0;
  for (const RegionMaterial& region : scene.definition.region_materials) {
    ++material;
    bool selects = false;
    for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
      if (has_cell(scene.mesh, region, c)) {
        scene.material_of_cell[c] = material;
        selects = true;
      }
    if (!selects)
      throw InputError(region.where,
                       region.group.empty()
                           ? "no cell has its centre in the box"
                           : fmt::format("'{}' is no group of cells of this body", region.group));
  }
}

/// Part of a node's load that the modelled part of a symmetric scene carries: halved by each symmetry plane
/// through it.
std::vector<double> modelled_share(const Scene& scene) {
  std::vector<double> share(scene.mesh.nodes.size(), 1.0);
  for (const Fixed& plane : scene.definition.symmetry)
    for (int n : select(scene.mesh, plane.region).nodes) share[index(n)] /= 2;
  return share;
}

/// Every region that a measure names is one node.
void check_measure(const HexMesh& mesh, const Measure& measure) {
  for (const Region* region : {&measure.node, &measure.top, &measure.bottom, &measure.centre})
    if (region->near || !region->name.empty()) select_node(mesh, *region);
}

/// Constrained and moved nodes of the definition on the scene's mesh.
void resolve_supports(Scene& scene) {
  for (const auto* list : {&scene.definition.fixed, &scene.definition.symmetry})
    for (const Fixed& fixed : *list)
      scene.constrained.push_back({select(scene.mesh, fixed.region), fixed.components});
  for (const Moved& motion : scene.definition.moved) {
    scene.moved.push_back({select(scene.mesh, motion.region), motion});
    scene.constrained.push_back({scene.moved.back().selection, motion.components});
  }
}

/// A degree of freedom is constrained once: not both fixed and moved, nor moved by two regions.
void check_motions(const Scene& scene) {
  std::vector<bool> is_taken(3 * scene.mesh.nodes.size(), false);
  const std::size_t n_resting = scene.constrained.size() - scene.moved.size();
  for (std::size_t f = 0; f < scene.constrained.size(); ++f)
    for (const int node : scene.constrained[f].selection.nodes)
      for (std::size_t a = 0; a < 3; ++a) {
        if (!scene.constrained[f].components[a]) continue;
        const std::size_t d = 3 * index(node) + a;
        if (f >= n_resting && is_taken[d])
          throw InputError(scene.moved[f - n_resting].motion.region.where,
                           "shares nodes with another region that is held or moved in the same component");
        is_taken[d] = true;
      }
}

void resolve_loads(Scene& scene) {
  for (const Load& load : scene.definition.loads) {
    Selection selection = select(scene.mesh, load.region);
    const bool needs_faces = load.kind == LoadKind::traction || load.kind == LoadKind::torque;
    if (needs_faces && selection.faces.empty())
      throw InputError(load.region.where, fmt::format("'{}' has no faces, and a {} acts on faces",
                                                      load.region.name, name_of(load.kind)));
    scene.loads.push_back({std::move(selection), load});
    if (load.kind == LoadKind::torque && !(polar_moment(scene.mesh, scene.loads.back()) > 0))
      throw InputError(load.region.where, "the region has no extent about the torque's axis");
  }
}

} // namespace

Selection select(const HexMesh& mesh, const Region& region) {
  if (region.near && !region.radius) return select_near(mesh, region);
  Selection selection;
  if (const auto group = mesh.groups.find(region.name); group != mesh.groups.end()) {
    selection = group->second;
  } else if (region.radius) {
    selection = select_patch(mesh, region);
  } else if (const auto planes = parse_planes(region.name)) {
    selection = select_on_planes(mesh, *planes);
  } else {
    std::string known;
    for (const auto& entry : mesh.groups) known += " '" + entry.first + "'";
    throw InputError(region.where,
                     fmt::format("'{}' names no region; allowed are x- x+ y- y+ z- z+ joined by blanks{}",
                                 region.name, known.empty() ? "" : ", and the mesh's groups" + known));
  }
  if (selection.nodes.empty())
    throw InputError(region.where, fmt::format("'{}' selects no node", region.name));
  return selection;
}

int select_node(const HexMesh& mesh, const Region& region) {
  const Selection selection = select(mesh, region);
  if (selection.nodes.size() != 1)
    throw InputError(region.where, fmt::format("'{}' selects {} nodes, and exactly one is wanted",
                                               region.name, selection.nodes.size()));
  return selection.nodes.front();
}

std::vector<Material> materials_of(const Case& definition) {
  std::vector<Material> materials{definition.material};
  for (const RegionMaterial& region : definition.region_materials) materials.push_back(region.material);
  return materials;
}

int material_of(const Scene& scene, std::size_t cell) {
  return scene.material_of_cell.empty() ? 0 : scene.material_of_cell[cell];
}

namespace {

HexMesh make_mesh(const Body& body) {
  if (const Box* box = std::get_if<Box>(&body)) return make_box_mesh(box->size, box->cells);
  if (const Voxels* voxels = std::get_if<Voxels>(&body)) return make_voxel_mesh(*voxels);
  return read_mesh(std::get<MeshFile>(body));
}

} // namespace

Scene make_scene(const Case& definition) {
  Scene scene;
  scene.definition = definition;
  scene.mesh = make_mesh(definition.body);
  resolve_materials(scene);
  add_patches(scene);
  resolve_supports(scene);
  check_motions(scene);
  resolve_loads(scene);
  for (const Measure& measure : definition.measures) check_measure(scene.mesh, measure);
  return scene;
}

Vector3d moved_by(const Moved& motion, const Vector3d& rest, double load_factor) {
  if (motion.angle == 0) return load_factor * motion.displacement;
  const double angle = load_factor * motion.angle * std::acos(-1.0) / 180;
  const Vector3d arm = rest - motion.centre;
  return Eigen::AngleAxisd(angle, motion.axis) * arm - arm;
}

Scene refine(const Scene& scene, int n) {
  if (n == 0) return scene;
  Scene fine;
  fine.definition = scene.definition;
  fine.mesh = refine(scene.mesh);
  for (const int material : scene.material_of_cell) // the children of cell c are 8c .. 8c+7
    fine.material_of_cell.insert(fine.material_of_cell.end(), 8, material);
  resolve_supports(fine);
  for (const Scene::AppliedLoad& applied : scene.loads) {
    const Region& region = applied.load.region;
    const bool stays = applied.load.kind == LoadKind::nodal_force || (region.near && !region.radius);
    fine.loads.push_back({stays ? applied.selection : select(fine.mesh, applied.load.region), applied.load});
  }
  return refine(fine, n - 1);
}

std::vector<bool> constrained_dofs(const Scene& scene) {
  std::vector<bool> is_constrained(3 * scene.mesh.nodes.size(), false);
  for (const auto& fixed : scene.constrained)
    for (int node : fixed.selection.nodes)
      for (std::size_t a = 0; a < 3; ++a)
        if (fixed.components[a]) is_constrained[3 * index(node) + a] = true;
  return is_constrained;
}

std::vector<Vector3d> point_forces(const Scene& scene) {
  std::vector<Vector3d> forces(scene.mesh.nodes.size(), Vector3d::Zero());
  const std::vector<double> share = modelled_share(scene);
  for (const auto& [selection, load] : scene.loads) {
    if (load.kind != LoadKind::nodal_force && load.kind != LoadKind::total_force) continue;
    double divisor = 1;
    if (load.kind == LoadKind::total_force) {
      divisor = 0;
      for (int node : selection.nodes) divisor += share[index(node)];
    }
    for (int node : selection.nodes) forces[index(node)] += load.value * (share[index(node)] / divisor);
  }
  return forces;
}

namespace {

/// Calls action(point, shape values, area weight) at the 2x2 Gauss points of a bilinear face; exact for what
/// is at most cubic in each direction: shape functions times a linear traction on a planar face.
template<class Action>
void integrate_face(const HexMesh& mesh, const std::array<int, 4>& face, const Action& action) {
  const double gauss[2] = {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
  std::array<Vector3d, 4> vertex;
  for (std::size_t v = 0; v < 4; ++v) vertex[v] = mesh.nodes[index(face[v])];
  for (double s : gauss)
    for (double t : gauss) {
      const std::array<double, 4> shape{(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
      const Vector3d along_s = (1 - t) * (vertex[1] - vertex[0]) + t * (vertex[2] - vertex[3]);
      const Vector3d along_t = (1 - s) * (vertex[3] - vertex[0]) + s * (vertex[2] - vertex[1]);
      Vector3d point = Vector3d::Zero();
      for (std::size_t v = 0; v < 4; ++v) point += shape[v] * vertex[v];
      action(point, shape, along_s.cross(along_t).norm() / 4);
    }
}

} // namespace

Vector3d surface_traction(const Scene::AppliedLoad& applied, const Vector3d& point, double polar_moment) {
  if (applied.load.kind == LoadKind::traction) return applied.load.value;
  return applied.load.moment / polar_moment * applied.load.axis.cross(point - applied.load.centre);
}

double polar_moment(const HexMesh& mesh, const Scene::AppliedLoad& applied) {
  double moment = 0;
  for (const auto& face : applied.selection.faces)
    integrate_face(mesh, face, [&](const Vector3d& point, const auto&, double weight) {
      moment += weight * applied.load.axis.cross(point - applied.load.centre).squaredNorm();
    });
  return moment;
}

std::vector<Vector3d> nodal_forces(const Scene& scene) {
  std::vector<Vector3d> forces = point_forces(scene);
  for (const Scene::AppliedLoad& applied : scene.loads) {
    if (applied.load.kind != LoadKind::traction && applied.load.kind != LoadKind::torque) continue;
    const double moment = applied.load.kind == LoadKind::torque ? polar_moment(scene.mesh, applied) : 0;
    for (const auto& face : applied.selection.faces)
      integrate_face(scene.mesh, face, [&](const Vector3d& point, const auto& shape, double weight) {
        const Vector3d force = weight * surface_traction(applied, point, moment);
        for (std::size_t v = 0; v < 4; ++v) forces[index(face[v])] += shape[v] * force;
      });
  }
  return forces;
}

} // namespace springproof::cases
