#pragma once

#include "cases/scene/loads.hpp"

/// What has mass in a scene: kg/m³, kg and m/s² of the case become t/mm³, t and mm/s² here, and nowhere else.
namespace springproof::cases {

/// Damping and density of a cell's material, t/mm³; without a density in the case nothing has mass.
struct CellDynamics {
  double density;           ///< t/mm³, >= 0
  double mass_damping;      ///< 1/s
  double stiffness_damping; ///< s
};
CellDynamics dynamics_of(const Scene& scene, std::size_t cell);

/// A mass (t) of one node.
struct NodeMass {
  int node;
  double mass;
};

/// What [[mass]] adds to nodes of the mesh, in ascending order: shared equally by a region's nodes; a node on
/// symmetry planes has the modelled part alone, as of a force.
std::vector<NodeMass> added_masses(const Scene& scene);
/// The mass of a node; 0 where the list has none.
double mass_of(const std::vector<NodeMass>& added, int node);

/// Masses of the springs' points, t: as msm.mass shares out the cells', and what is added to them; or as
/// `shared` does.
std::vector<double> point_masses(const Scene& scene);
std::vector<double> point_masses(const Scene& scene, PointMass shared);

/// Factors of the mass in C that belong to these points, t/s: of every cell's mass its material's
/// mass_damping. What is added by [[mass]] is not damped.
std::vector<double> point_mass_damping(const Scene& scene);

/// The acceleration of a load that acts on masses, mm/s², at a factor of 1; and of all of a scene's together.
Eigen::Vector3d acceleration_of(const Load& load);
Eigen::Vector3d gravity(const Scene& scene);

/// All loads of the case as nodal forces, N, at factors of 1: loaded_nodes(), and gravity on point_masses(),
/// which in finite elements are those of the cells.
std::vector<NodeVector> applied_forces(const Scene& scene, PointMass shared = PointMass::cells);

/// Forces on all points in an acceleration (mm/s²), N.  @param masses  point_masses()
std::vector<NodeVector> weights(const std::vector<double>& masses, const Eigen::Vector3d& acceleration);

} // namespace springproof::cases
