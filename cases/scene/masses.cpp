#include "cases/scene/masses.hpp"

#include <algorithm>
#include <map>

namespace springproof::cases {

namespace {

constexpr double tonnes_per_kg = 1e-3, tonnes_per_mm3 = 1e-12; ///< the latter of kg/m³
constexpr double mm_per_m = 1e3;

/// mm/s²
Eigen::Vector3d acceleration(const loads::Gravity& gravity) {
  return mm_per_m * gravity.value;
}

/// Shares a value of every cell out to the points.
/// @param of_volume  returns a cell's value per mm³
template<class OfVolume>
std::vector<double> shared_out(const Scene& scene, PointMass shared, const OfVolume& of_volume) {
  const HexMesh& mesh = scene.mesh;
  std::vector<double> shares(mesh.nodes.size(), 0.0);
  double total = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const double value = of_volume(dynamics_of(scene, c)) * cell_volume(cell_vertices(mesh, c));
    total += value;
    for (const int node : mesh.cells[c]) shares[index(node)] += value / 8;
  }
  if (shared != PointMass::uniform) return shares;
  const auto modelled = modelled_share(scene);
  double divisor = 0;
  for (std::size_t n = 0; n < shares.size(); ++n) divisor += shares[n] = modelled(static_cast<int>(n));
  for (double& share : shares) share *= total / divisor;
  return shares;
}

} // namespace

CellDynamics dynamics_of(const Scene& scene, std::size_t cell) {
  const int material = material_of(scene, cell);
  const MaterialDynamics& dynamics = material == 0
                                         ? scene.definition.material_dynamics
                                         : scene.definition.region_materials[index(material - 1)].dynamics;
  return {dynamics.density.value_or(0) * tonnes_per_mm3, dynamics.mass_damping, dynamics.stiffness_damping};
}

std::vector<NodeMass> added_masses(const Scene& scene) {
  if (scene.masses.empty()) return {};
  std::map<int, double> masses; // by node
  const auto share = modelled_share(scene);
  for (const auto& [selection, added] : scene.masses) {
    double divisor = 0;
    for (const int node : selection.nodes) divisor += share(node);
    for (const int node : selection.nodes)
      masses[node] += added.mass * tonnes_per_kg * (share(node) / divisor);
  }
  std::vector<NodeMass> ascending;
  for (const auto& [node, mass] : masses) ascending.push_back({node, mass});
  return ascending;
}

double mass_of(const std::vector<NodeMass>& added, int node) {
  const auto is_before = [](const NodeMass& at, int number) { return at.node < number; };
  const auto found = std::lower_bound(added.begin(), added.end(), node, is_before);
  return found != added.end() && found->node == node ? found->mass : 0;
}

std::vector<double> point_masses(const Scene& scene) {
  return point_masses(scene, scene.definition.msm.mass);
}

std::vector<double> point_masses(const Scene& scene, PointMass shared) {
  std::vector<double> masses =
      shared_out(scene, shared, [](const CellDynamics& cell) { return cell.density; });
  for (const auto& [node, mass] : added_masses(scene)) masses[index(node)] += mass;
  return masses;
}

std::vector<double> point_mass_damping(const Scene& scene) {
  return shared_out(scene, scene.definition.msm.mass,
                    [](const CellDynamics& cell) { return cell.density * cell.mass_damping; });
}

Eigen::Vector3d acceleration_of(const Load& load) {
  const auto of_kind = [](const auto& kind) { return acceleration(kind); };
  return loads::of_those_on<loads::On::masses, Eigen::Vector3d>(load.kind, of_kind);
}

Eigen::Vector3d gravity(const Scene& scene) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& applied : scene.loads)
    if (applied.load.on() == loads::On::masses) sum += acceleration_of(applied.load);
  return sum;
}

std::vector<NodeVector> weights(const std::vector<double>& masses, const Eigen::Vector3d& acceleration) {
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
