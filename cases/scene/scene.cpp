#include "cases/scene/scene.hpp"

#include "cases/case/elements.hpp"
#include "cases/case/input_file.hpp"
#include "cases/mesh/cell_point.hpp"
#include "cases/mesh/fill_surface.hpp"
#include "cases/mesh/labels.hpp"
#include "cases/mesh/read_mesh.hpp"
#include "cases/mesh/voxels.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "cases/scene/loads.hpp"
#include "cases/scene/network.hpp"
#include "cases/scene/regions.hpp"
#include "cases/scene/tools.hpp"
#include "cases/scene/world.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

double radians(double degrees) {
  return degrees * std::acos(-1.0) / 180;
}

/// Patches become groups of the mesh, so that refined meshes keep the same patches.
void add_patches(Scene& scene) {
  std::optional<std::vector<FaceNodes>> surface;
  const auto add_patch = [&](const Region& region, bool) {
    if (!region.is_patch()) return;
    if (!surface) surface = surface_faces(scene.mesh, scene.definition.symmetry);
    scene.mesh.groups.emplace(region.name, select_patch(scene.mesh, *surface, region));
  };
  const auto add_patches_of = [&](const auto& conditions) {
    for (const auto& condition : conditions) add_patch(condition.region, false);
  };
  add_patches_of(scene.definition.fixed);
  add_patches_of(scene.definition.moved);
  add_patches_of(scene.definition.loads);
  add_patches_of(scene.definition.masses);
  for (const Tool& tool : scene.definition.tools)
    if (tool.region) add_patch(*tool.region, false);
  for (const Measure& measure : scene.definition.measures) for_each_region(measure, add_patch);
}

bool has_cell(const Mesh& mesh, const RegionMaterial& region, std::size_t cell) {
  if (!region.group.empty()) return !mesh.group_of_cell.empty() && mesh.group_of_cell[cell] == region.group;
  const Vector3d centre = centre_of(mesh, mesh.cells[cell]);
  return (centre.array() >= region.lower.array()).all() && (centre.array() <= region.upper.array()).all();
}

void resolve_materials(Scene& scene) {
  if (scene.definition.region_materials.empty()) return;
  scene.material_of_cell.assign(scene.mesh.cells.size(), 0);
  int material = 0;
  for (const RegionMaterial& region : scene.definition.region_materials) {
    ++material;
    for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
      if (has_cell(scene.mesh, region, c)) scene.material_of_cell[c] = material;
    if (!contains(scene.material_of_cell, material))
      throw InputError(region.where,
                       region.group.empty()
                           ? "no cell has its centre in the box"
                           : fmt::format("'{}' is no group of cells of this body", region.group));
  }
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

/// Holds nodes of rigid cells that nothing else holds or moves.
void hold_rigid_nodes(Scene& scene) {
  if (rigid_class(scene.definition.body) == nullptr) return;
  const std::vector<bool> is_taken = constrained_dofs(scene);
  std::vector<bool> is_of_rigid(scene.mesh.nodes.size(), false);
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    if (is_rigid(scene, c))
      for (const int node : scene.mesh.cells[c]) is_of_rigid[index(node)] = true;
  for (unsigned held = 1; held < 8; ++held) { // by their free components
    std::array<bool, 3> components{};
    for (std::size_t a = 0; a < 3; ++a) components[a] = (held >> a & 1) != 0;
    std::vector<bool> is_selected(scene.mesh.nodes.size());
    for (std::size_t n = 0; n < is_selected.size(); ++n)
      is_selected[n] = is_of_rigid[n] && is_taken[3 * n] != components[0] &&
                       is_taken[3 * n + 1] != components[1] && is_taken[3 * n + 2] != components[2];
    Selection selection =
        select_between(scene.mesh, is_selected, [&](std::size_t c) { return is_rigid(scene, c); });
    if (!selection.nodes.empty()) scene.constrained.push_back({std::move(selection), components});
  }
}

template<class Action>
void for_each_dof(const Scene::ConstrainedNodes& fixed, const Action& action) {
  for (const int node : fixed.selection.nodes)
    for (std::size_t a = 0; a < 3; ++a)
      if (fixed.components[a]) action(3 * index(node) + a);
}

/// A degree of freedom is constrained once: not both fixed and moved, nor moved by two regions.
void check_motions(const Scene& scene) {
  std::vector<bool> is_taken(3 * scene.mesh.nodes.size(), false);
  const std::size_t n_resting = scene.constrained.size() - scene.moved.size();
  for (std::size_t f = 0; f < scene.constrained.size(); ++f)
    for_each_dof(scene.constrained[f], [&](std::size_t d) {
      if (f >= n_resting && is_taken[d])
        throw InputError(scene.moved[f - n_resting].motion.region.where,
                         "shares nodes with another region that is held or moved in the same component");
      is_taken[d] = true;
    });
}

/// Loads and motions that double precision cannot tell from none would be "carried" by a body at rest.
void check_sizes(const Scene& scene) {
  constexpr double least_force = 1e-140; // N: solvers square it
  constexpr double least_motion = 1e-9;  // mm: supports are where they have to be within 1e-12
  const std::vector<bool> is_held = constrained_dofs(scene);
  double force = 0, free_force = gravity(scene).cwiseAbs().maxCoeff();
  for (const NodeVector& loaded : loaded_nodes(scene))
    for (int a = 0; a < 3; ++a) {
      const double size = std::abs(loaded.value[a]);
      force = std::max(force, size);
      if (!is_held[3 * index(loaded.node) + index(a)]) free_force = std::max(free_force, size);
    }
  const bool has_unknowns = contains(is_held, false);
  if (force > 0 && free_force == 0 && scene.moved.empty() && has_unknowns)
    throw InputError(scene.definition.loads.front().region.where,
                     "every node that is loaded is held in the direction of its force: nothing would move; "
                     "load nodes that are free, or leave the direction out of the support's components");
  if (force > 0 && force < least_force)
    refuse(scene.definition.loads.front().region.where,
           "the largest force on a node is {:.3g} N, must be 0 or at least {:.0e} N, to be told from none",
           force, least_force);
  for (const auto& [selection, motion] : scene.moved) {
    double way = motion.displacement.cwiseAbs().maxCoeff();
    for (const int node : selection.nodes) {
      const double arm = motion.axis.cross(scene.mesh.nodes[index(node)] - motion.centre).norm();
      if (motion.angle != 0) way = std::max(way, arm * std::min(1., radians(std::abs(motion.angle))));
    }
    if (way > 0 && way < least_motion)
      refuse(motion.region.where, "moves by {:.3g} mm, must be 0 or at least {:.0e} mm, to be told from rest",
             way, least_motion);
  }
}

void resolve_loads(Scene& scene) {
  for (const Load& load : scene.definition.loads) {
    if (load.on() == loads::On::masses) {
      scene.loads.push_back({{}, load});
      continue;
    }
    Selection selection = select(scene.mesh, load.region);
    if (load.on() == loads::On::area && selection.faces.empty())
      refuse(load.region.where, "'{}' has no faces, and a {} acts on faces", load.region.name,
             name_of(load.kind));
    scene.loads.push_back({std::move(selection), load});
    if (is<loads::Torque>(load) &&
        !(polar_moment(scene.mesh, scene.loads.back().selection, std::get<loads::Torque>(load.kind)) > 0))
      throw InputError(load.region.where, "the region has no extent about the torque's axis");
  }
}

/// Grids of cells are sound by construction, and read_mesh() checks what others may have made.
/// A network's are read with the masses of its nodes.
Mesh make_mesh(const Body& body, std::vector<std::string>& remarks, std::vector<double>& node_masses) {
  if (const Box* box = std::get_if<Box>(&body)) return make_box_mesh(box->size, box->cells);
  if (const Voxels* voxels = std::get_if<Voxels>(&body)) return make_voxel_mesh(*voxels, &remarks);
  if (const Labels* labels = std::get_if<Labels>(&body)) return make_label_mesh(*labels);
  if (const FilledSurface* surface = std::get_if<FilledSurface>(&body))
    return fill_surface(*surface, remarks);
  if (const Network* network = std::get_if<Network>(&body)) {
    NetworkNodes nodes = read_nodes(read_text_file(network->nodes.path), network->nodes.path);
    node_masses = std::move(nodes.masses);
    Mesh mesh;
    mesh.nodes = std::move(nodes.places);
    return mesh;
  }
  return read_mesh(std::get<MeshFile>(body), &remarks);
}

/// Whether a support acts on some node of a region, in a component or (norm) in any.
bool has_support(const Scene& scene, const Region& region, Component component) {
  const std::vector<int> nodes = select(scene.mesh, region).nodes;
  const auto is_there = [&](const Scene::ConstrainedNodes& support) {
    const auto& acts = support.components;
    const bool is_along = component == Component::norm ? acts[0] || acts[1] || acts[2]
                                                       : acts[static_cast<std::size_t>(component)];
    return is_along && std::any_of(nodes.begin(), nodes.end(), [&](int node) {
             return std::binary_search(support.selection.nodes.begin(), support.selection.nodes.end(), node);
           });
  };
  return std::any_of(scene.constrained.begin(), scene.constrained.end(), is_there);
}

/// A reaction is measured where something is supported.
void check_reaction(const Scene& scene, const measures::Reaction& reaction) {
  if (has_support(scene, reaction.region, reaction.component)) return;
  refuse(reaction.region.where,
         "selects no node that is fixed or moved{}; must be a region of [[fixed]], [[symmetry]] or "
         "[[moved]], whose force is measured",
         reaction.component == Component::norm ? "" : " in component " + name_of(reaction.component));
}

/// Stress and strain are measured inside the body.
void check_cells(const Scene& scene, const measures::OfCells& measure) {
  if (measure.statistic && measure.has_region() && select(scene.mesh, measure.region).faces.empty())
    refuse(measure.region.where,
           "'{}' has no faces, and a statistic is of the cells that have a face in the region",
           measure.region.name);
  if (!measure.statistic && cells_at(scene.mesh, measure.point).empty())
    refuse(measure.point_where, "is [{}, {}, {}], must be a point of the body at rest (mm)",
           measure.point.x(), measure.point.y(), measure.point.z());
}

void check_measure(const Scene& scene, const Measure& measure) {
  if (is<measures::Stress>(measure) && scene.definition.msm.design == Design::network)
    throw InputError(measure.where, "kind is \"stress\", must be another one beside design = \"network\": "
                                    "the springs of a network belong to no cell, and a cell has no stress");
  const auto check_kind = [&](const auto& kind) {
    using Kind = std::decay_t<decltype(kind)>;
    if constexpr (std::is_same_v<Kind, measures::Reaction>) check_reaction(scene, kind);
    if constexpr (std::is_base_of_v<measures::OfCells, Kind>) check_cells(scene, kind);
  };
  std::visit(check_kind, measure.kind);
}

/// Drops triangles on planes of symmetry: no part of the surface, beyond them the body goes on.
void open_at_symmetry(const Mesh& mesh, const std::vector<Fixed>& symmetry, TriangleMesh& surface) {
  for (const Fixed& plane : symmetry) {
    const int axis = plane.region.name[0] - 'x';
    const double at = mesh.nodes[index(select_on_planes(mesh, {plane.region.name}).nodes.front())][axis];
    const auto is_on_plane = [&](const std::array<int, 3>& triangle) {
      return std::all_of(triangle.begin(), triangle.end(), [&](int vertex) {
        return std::abs(surface.vertices[index(vertex)][axis] - at) <= 1e-6 * (1 + std::abs(at));
      });
    };
    auto& triangles = surface.triangles;
    triangles.erase(std::remove_if(triangles.begin(), triangles.end(), is_on_plane), triangles.end());
  }
}

/// Reads the surface that a scene's case names, if it names one.
/// @param placement  of a case in world coordinates: those of the file are such too
/// @throws InputError, at the place in the case file, if it is none or has more than five million triangles
void read_surface_of(Scene& scene, const std::optional<Placement>& placement) {
  constexpr std::size_t most = 5'000'000;
  const auto& named = scene.definition.surface;
  if (!named) return;
  try {
    scene.surface = named->contour ? label_surface(std::get<Labels>(scene.definition.body), *named->contour)
                                   : read_surface(named->file.path, &scene.remarks);
    for (Eigen::Vector3d& vertex : scene.surface.vertices) {
      vertex *= named->scale;
      if (placement && !named->contour) vertex = placement->to_body(vertex);
    }
  } catch (const std::runtime_error& error) {
    named->file.refuse_once(error.what());
  }
  if (scene.surface.triangles.size() > most)
    named->file.refuse(
        fmt::format("has {} triangles, must have at most {}", scene.surface.triangles.size(), most));
  open_at_symmetry(scene.mesh, scene.definition.symmetry, scene.surface);
}

} // namespace

int material_of(const Scene& scene, std::size_t cell) {
  return scene.material_of_cell.empty() ? 0 : scene.material_of_cell[cell];
}

bool is_rigid(const Scene& scene, std::size_t cell) {
  const LabelClass* rigid = rigid_class(scene.definition.body);
  return rigid != nullptr && scene.mesh.group_of_cell[cell] == rigid->name;
}

Scene make_scene(const Case& case_as_read) {
  Scene scene;
  scene.definition = case_as_read;
  const Case& definition = scene.definition;
  read_surfaces(scene.definition.tools, scene.remarks);
  const std::optional<Placement> placement = leave_world(scene.definition, scene.remarks);
  scene.mesh = cut(make_mesh(definition.body, scene.remarks, scene.node_masses), definition.removed);
  const bool is_tetrahedron = scene.mesh.shape == CellShape::tetrahedron;
  if (has_cells(definition.body)) settle_element(scene.definition, is_tetrahedron);
  settle_design(scene.definition.msm, is_tetrahedron);
  find_nearest_nodes(scene.mesh, scene.definition, scene.remarks);
  resolve_materials(scene);
  add_patches(scene);
  resolve_supports(scene);
  check_motions(scene);
  check_scaled(scene);
  hold_rigid_nodes(scene); // a cut is joined where bone holds its sides
  join_cuts(scene);
  resolve_loads(scene);
  check_sizes(scene);
  for (const Tool& tool : definition.tools) touched_faces(scene, tool);
  for (const AddedMass& added : definition.masses)
    scene.masses.push_back({select(scene.mesh, added.region), added});
  resolve_network(scene, case_as_read);
  for (const Measure& measure : definition.measures)
    for_each_region(measure, [&](const Region& region, bool is_node) {
      if (is_node) weights_at(scene.mesh, region);
    });
  for (const Measure& measure : definition.measures) check_measure(scene, measure);
  if (definition.surface || !definition.landmarks.empty()) check_has_vtk();
  read_surface_of(scene, placement);
  return scene;
}

Vector3d moved_by(const Moved& motion, const Vector3d& rest, double load_factor) {
  if (motion.scaled) load_factor *= motion.scaled->factor(rest);
  if (motion.angle == 0) return load_factor * motion.displacement;
  const double angle = radians(load_factor * motion.angle);
  const Vector3d arm = rest - motion.centre;
  return Eigen::AngleAxisd(angle, motion.axis) * arm - arm;
}

Scene refine(const Scene& scene, int n) {
  if (n == 0) return scene;
  if (const auto joined = first_joined(scene.definition))
    throw InputError(joined->where,
                     "is joined, and the finite elements are asked for on a finer mesh, where the cut would "
                     "end elsewhere; leave fem.refine, sweeps and further meshes out");
  Scene fine;
  fine.definition = scene.definition;
  fine.mesh = refine(scene.mesh);
  for (const int material : scene.material_of_cell) // the children of cell c are 8c .. 8c+7
    fine.material_of_cell.insert(fine.material_of_cell.end(), 8, material);
  resolve_supports(fine);
  hold_rigid_nodes(fine);
  const auto share = modelled_share(fine);
  for (const Scene::AppliedLoad& applied : scene.loads) {
    if (!applied.points.empty()) {
      Scene::AppliedLoad& patch = fine.loads.emplace_back(applied);
      for (WeightedPoint& at : patch.points) at.point = refine(scene.mesh.shape, at.point);
      give_to_nodes(patch, fine.mesh, share);
      continue;
    }
    const Region& region = applied.load.region;
    const bool stays =
        is<loads::NodalForce>(applied.load) || applied.load.on() == loads::On::masses || region.is_node();
    fine.loads.push_back(
        {stays ? applied.selection : select(fine.mesh, applied.load.region), applied.load, applied.part});
  }
  for (const auto& [selection, added] : scene.masses) {
    fine.masses.push_back({added.region.is_node() ? selection : select(fine.mesh, added.region), added});
  }
  return refine(fine, n - 1);
}

std::vector<bool> constrained_dofs(const Scene& scene) {
  std::vector<bool> is_constrained(3 * scene.mesh.nodes.size(), false);
  for (const auto& fixed : scene.constrained)
    for_each_dof(fixed, [&](std::size_t d) { is_constrained[d] = true; });
  return is_constrained;
}

} // namespace springproof::cases
