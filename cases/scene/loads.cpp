#include "cases/scene/loads.hpp"

#include "cases/mesh/triangle_mesh.hpp"
#include "cases/scene/regions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

std::array<double, 4> bilinear_shapes(double s, double t) {
  return {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
}

/// Calls action(face, point, shape values, area weight) at the points of a quadrature of a selection's faces:
/// the 2x2 Gauss points of a bilinear one, three of a triangle. Exact for shape functions times a linear
/// traction on a planar face.
template<class Action>
void integrate(const Mesh& mesh, const Selection& selection, const Action& action) {
  for (const FaceNodes& face : selection.faces) {
    Few<Vector3d, 4> x;
    for (const int node : face) x.push_back(mesh.nodes[index(node)]);
    if (face.size() == 3) {
      const double area = (x[1] - x[0]).cross(x[2] - x[0]).norm() / 2;
      for (std::size_t q = 0; q < 3; ++q) {
        std::array<double, 3> shape{1. / 6, 1. / 6, 1. / 6};
        shape[q] = 2. / 3;
        action(face, Vector3d(shape[0] * x[0] + shape[1] * x[1] + shape[2] * x[2]), shape, area / 3);
      }
      continue;
    }
    for (const auto& [s, t, point, area] : gauss_points({x[0], x[1], x[2], x[3]}, 2))
      action(face, point, bilinear_shapes(s, t), area);
  }
}

/// Forces on the nodes of loads' regions, which add up.
class Forces {
 public:
  explicit Forces(const std::vector<Scene::AppliedLoad>& loads) {
    std::vector<int> nodes;
    for (const Scene::AppliedLoad& applied : loads) {
      const Selection& selection = applied.selection;
      nodes.insert(nodes.end(), selection.nodes.begin(), selection.nodes.end());
      for (const auto& face : selection.faces) nodes.insert(nodes.end(), face.begin(), face.end());
    }
    make_set(nodes);
    for (const int node : nodes) forces.push_back({node, Vector3d::Zero()});
  }
  void add(int node, const Vector3d& force) {
    const auto is_before = [](const NodeVector& at, int number) { return at.node < number; };
    std::lower_bound(forces.begin(), forces.end(), node, is_before)->value += force;
  }
  std::vector<NodeVector> forces;
};

/// The force on a node.  @param here, all  the node's share of the region, and the sum of all shares
Vector3d on_node(const loads::NodalForce& load, double here, double) {
  return load.value * here;
}
Vector3d on_node(const loads::TotalForce& load, double here, double all) {
  return load.value * (here / all);
}

using TractionAt = std::function<Vector3d(const Vector3d&)>;
TractionAt traction_of(const loads::Traction& load, const Mesh&, const Selection&) {
  return [value = load.value](const Vector3d&) { return value; };
}
TractionAt traction_of(const loads::Torque& load, const Mesh& mesh, const Selection& selection) {
  return [load, per_radius = load.value / polar_moment(mesh, selection, load)](
             const Vector3d& point) -> Vector3d { return per_radius * load.axis.cross(point - load.centre); };
}

void add_point_forces(const Scene& scene, const std::vector<Scene::AppliedLoad>& loads, Forces& forces) {
  const auto share = modelled_share(scene);
  for (const auto& [selection, load, part, points] : loads) {
    if (load.on() != loads::On::nodes) continue;
    double all = 0;
    for (const int node : selection.nodes) all += share(node);
    for (std::size_t n = 0; n < selection.nodes.size(); ++n) {
      const double here = share(selection.nodes[n]) * (part.empty() ? 1 : part[n]);
      const auto force = [&](const auto& kind) { return on_node(kind, here, all); };
      forces.add(selection.nodes[n], loads::of_those_on<loads::On::nodes, Vector3d>(load.kind, force));
    }
  }
}

/// Area that a patch's sphere cuts from the case's [surface], mm². Without one it is that of a flat circle of
/// its radius, or of the modelled half or quarter where planes of symmetry go through its centre.
double area_within(const Scene& scene, const Region& region) {
  if (!scene.surface.triangles.empty()) {
    double sum = 0;
    for (const std::array<int, 3>& triangle : scene.surface.triangles)
      if ((barycentre(triangle, scene.surface.vertices) - *region.near).norm() <= *region.radius)
        sum += cases::doubled_area(triangle, scene.surface.vertices).norm() / 2;
    return sum;
  }
  double circle = std::acos(-1.0) * *region.radius * *region.radius;
  for (const Fixed& plane : scene.definition.symmetry) {
    const int axis = plane.region.name[0] - 'x';
    const int node = select_on_planes(scene.mesh, {plane.region.name}).nodes.front();
    if (std::abs(scene.mesh.nodes[index(node)][axis] - (*region.near)[axis]) < 1e-6 * *region.radius)
      circle /= 2; // the other half is the mirror image's
  }
  return circle;
}

constexpr double tonnes_per_mm3 = 1e-12; ///< in 1 kg/m³
constexpr double mm_per_m = 1e3;

/// mm/s²
Vector3d acceleration(const loads::Gravity& gravity) {
  return mm_per_m * gravity.value;
}

/// Shares a value of every cell out to the points.
/// @param of_volume  returns a cell's value per mm³
template<class OfVolume>
std::vector<double> shared_out(const Scene& scene, PointMass shared, const OfVolume& of_volume) {
  const Mesh& mesh = scene.mesh;
  std::vector<double> shares(mesh.nodes.size(), 0.0);
  double total = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const double value = of_volume(dynamics_of(scene, c)) * cell_volume(cell_corners(mesh, c));
    total += value;
    const CellNodes nodes = mesh.cells[c];
    for (const int node : nodes) shares[index(node)] += value / static_cast<double>(nodes.size());
  }
  if (shared != PointMass::uniform) return shares;
  const auto modelled = modelled_share(scene);
  double divisor = 0;
  for (std::size_t n = 0; n < shares.size(); ++n) divisor += shares[n] = modelled(static_cast<int>(n));
  for (double& share : shares) share *= total / divisor;
  return shares;
}

/// Masses of a network's nodes, t; 0 where its file gives none.
std::vector<double> masses_of_nodes(const Scene& scene) {
  return scene.node_masses.empty() ? std::vector<double>(scene.mesh.nodes.size(), 0.0) : scene.node_masses;
}

/// Masses of the body, t, without those that are added.
std::vector<double> own_masses(const Scene& scene, PointMass shared) {
  if (!has_cells(scene.definition.body)) return masses_of_nodes(scene);
  return shared_out(scene, shared, [](const CellDynamics& cell) { return cell.density; });
}

} // namespace

std::vector<FacePoint> gauss_points(const std::array<Vector3d, 4>& vertices, int n) {
  const double inner = std::sqrt(3. / 7 - 2. / 7 * std::sqrt(1.2)),
               outer = std::sqrt(3. / 7 + 2. / 7 * std::sqrt(1.2));
  const double light = (18 - std::sqrt(30.)) / 72, heavy = (18 + std::sqrt(30.)) / 72;
  using Rule = std::vector<std::array<double, 2>>; // place on the unit interval, and weight
  const Rule rule = n == 2 ? Rule{{0.5 - 0.5 / std::sqrt(3.0), 0.5}, {0.5 + 0.5 / std::sqrt(3.0), 0.5}}
                           : Rule{{(1 - outer) / 2, light},
                                  {(1 - inner) / 2, heavy},
                                  {(1 + inner) / 2, heavy},
                                  {(1 + outer) / 2, light}};
  std::vector<FacePoint> points;
  for (const auto& [s, weight_s] : rule)
    for (const auto& [t, weight_t] : rule) {
      const std::array<double, 4> shape = bilinear_shapes(s, t);
      const Vector3d along_s = (1 - t) * (vertices[1] - vertices[0]) + t * (vertices[2] - vertices[3]);
      const Vector3d along_t = (1 - s) * (vertices[3] - vertices[0]) + s * (vertices[2] - vertices[1]);
      Vector3d at = Vector3d::Zero();
      for (std::size_t v = 0; v < 4; ++v) at += shape[v] * vertices[v];
      points.push_back({s, t, at, weight_s * weight_t * along_s.cross(along_t).norm()});
    }
  return points;
}

std::function<double(int node)> modelled_share(const Scene& scene) {
  return [planes = planes_of_nodes(scene.mesh, scene.definition.symmetry)](int node) {
    double share = 1;
    for (int left = planes.empty() ? 0 : planes[index(node)]; left != 0; left &= left - 1) share /= 2;
    return share;
  };
}

void give_to_nodes(Scene::AppliedLoad& patch, const Mesh& mesh,
                   const std::function<double(int node)>& share) {
  patch.selection = {};
  patch.part.clear();
  for (const auto& [node, weight] : on_nodes(patch.points, mesh)) {
    patch.selection.nodes.push_back(node);
    patch.part.push_back(weight / share(node)); // the load's sum multiplies by the share
  }
}

std::vector<NodeVector> nodes_with_point_forces(const Scene& scene) {
  Forces all(scene.loads);
  add_point_forces(scene, scene.loads, all);
  return all.forces;
}

std::function<Vector3d(const Vector3d&)> surface_traction(const Mesh& mesh,
                                                          const Scene::AppliedLoad& applied) {
  const auto traction = [&](const auto& kind) { return traction_of(kind, mesh, applied.selection); };
  return loads::of_those_on<loads::On::area, TractionAt>(applied.load.kind, traction);
}

double area(const Mesh& mesh, const Selection& selection) {
  double sum = 0;
  integrate(mesh, selection,
            [&](const auto&, const Vector3d&, const auto&, double weight) { sum += weight; });
  return sum;
}

std::vector<std::string> warnings_of_loads(const Scene& scene) {
  constexpr double most = 0.1; // relative to the area
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    const auto& [selection, load, part, points] = scene.loads[i];
    if (!is<loads::Traction>(load) || !load.region.radius) continue;
    const double found = area(scene.mesh, selection), wanted = area_within(scene, load.region);
    if (std::abs(found - wanted) <= most * wanted) continue;
    const std::string by = wanted > 0 ? fmt::format(" ({:+.0f} %)", 100 * (found / wanted - 1)) : "";
    warnings.push_back(fmt::format("load[{}] acts on faces of {:.6g} mm2, and {} {:.6g} mm2{}: its force "
                                   "differs by as much; kind = \"total_force\" says the force itself",
                                   i, found,
                                   scene.surface.triangles.empty()
                                       ? fmt::format("a flat circle of radius {} mm has", *load.region.radius)
                                       : "the [surface] has there",
                                   wanted, by));
  }
  return warnings;
}

double polar_moment(const Mesh& mesh, const Selection& selection, const loads::Torque& torque) {
  double moment = 0;
  integrate(mesh, selection, [&](const auto&, const Vector3d& point, const auto&, double weight) {
    moment += weight * torque.axis.cross(point - torque.centre).squaredNorm();
  });
  return moment;
}

std::vector<NodeVector> loaded_nodes(const Scene& scene) {
  return loaded_nodes(scene, scene.loads);
}

std::vector<NodeVector> loaded_nodes(const Scene& scene, const std::vector<Scene::AppliedLoad>& loads) {
  Forces all(loads);
  add_point_forces(scene, loads, all);
  for (const Scene::AppliedLoad& applied : loads) {
    const auto traction = surface_traction(scene.mesh, applied);
    if (!traction) continue;
    integrate(scene.mesh, applied.selection,
              [&](const auto& face, const Vector3d& point, const auto& shape, double weight) {
                const Vector3d force = weight * traction(point);
                for (std::size_t v = 0; v < face.size(); ++v) all.add(face[v], shape[v] * force);
              });
  }
  return all.forces;
}

std::vector<Vector3d> on_all_nodes(const std::vector<NodeVector>& some, std::size_t n) {
  std::vector<Vector3d> all(n, Vector3d::Zero());
  for (const auto& [node, value] : some) all[index(node)] = value;
  return all;
}

std::vector<Vector3d> nodal_forces(const Scene& scene) {
  return on_all_nodes(loaded_nodes(scene), scene.mesh.nodes.size());
}

CellDynamics dynamics_of(const Scene& scene, std::size_t cell) {
  const MaterialDynamics& dynamics = dynamics_of(scene.definition, index(material_of(scene, cell)));
  return {dynamics.density.value_or(0) * tonnes_per_mm3, dynamics.mass_damping, dynamics.stiffness_damping};
}

NodeMasses added_masses(const Scene& scene) {
  NodeMasses masses;
  if (scene.masses.empty()) return masses;
  const auto share = modelled_share(scene);
  for (const auto& [selection, added] : scene.masses) {
    double divisor = 0;
    for (const int node : selection.nodes) divisor += share(node);
    for (const int node : selection.nodes)
      masses[node] += added.mass * tonnes_per_kg * (share(node) / divisor);
  }
  return masses;
}

double mass_of(const NodeMasses& added, int node) {
  const auto found = added.find(node);
  return found != added.end() ? found->second : 0;
}

std::vector<double> point_masses(const Scene& scene) {
  return point_masses(scene, scene.definition.msm.mass);
}

std::vector<double> point_masses(const Scene& scene, PointMass shared) {
  std::vector<double> masses = own_masses(scene, shared);
  for (const auto& [node, mass] : added_masses(scene)) masses[index(node)] += mass;
  return masses;
}

std::vector<double> point_mass_damping(const Scene& scene) {
  if (!has_cells(scene.definition.body)) {
    std::vector<double> damping = masses_of_nodes(scene);
    for (double& of_node : damping) of_node *= scene.definition.material_dynamics.mass_damping;
    return damping;
  }
  return shared_out(scene, scene.definition.msm.mass,
                    [](const CellDynamics& cell) { return cell.density * cell.mass_damping; });
}

Vector3d acceleration_of(const Load& load) {
  const auto of_kind = [](const auto& kind) { return acceleration(kind); };
  return loads::of_those_on<loads::On::masses, Vector3d>(load.kind, of_kind);
}

Vector3d gravity(const Scene& scene) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& applied : scene.loads)
    if (applied.load.on() == loads::On::masses) sum += acceleration_of(applied.load);
  return sum;
}

std::vector<NodeVector> weights(const std::vector<double>& masses, const Vector3d& acceleration) {
  std::vector<NodeVector> forces;
  for (std::size_t n = 0; n < masses.size(); ++n)
    forces.push_back({static_cast<int>(n), masses[n] * acceleration});
  return forces;
}

std::vector<NodeVector> applied_forces(const Scene& scene, PointMass shared) {
  std::vector<NodeVector> all = loaded_nodes(scene);
  if (gravity(scene).isZero(0)) return all;
  const std::vector<NodeVector> of_gravity = weights(point_masses(scene, shared), gravity(scene));
  all.insert(all.end(), of_gravity.begin(), of_gravity.end());
  return all;
}

} // namespace springproof::cases
