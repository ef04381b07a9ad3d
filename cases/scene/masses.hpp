#pragma once

#include "cases/scene/loads.hpp"

/// Masses of a scene: kg/m³, kg and m/s² of the case become t/mm³, t and mm/s² here, and nowhere else.
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

/// Masses that [[mass]] adds to nodes, in ascending order. A region's nodes share its mass equally; a node on
/// symmetry planes has the modelled part alone, as with a force.
std::vector<NodeMass> added_masses(const Scene& scene);
/// The mass of a node; 0 where the list has none.
double mass_of(const std::vector<NodeMass>& added, int node);

/// Masses of the springs' points, t: the cells' masses, which msm.mass or `shared` shares out, and what
/// [[mass]] adds.
std::vector<double> point_masses(const Scene& scene);
std::vector<double> point_masses(const Scene& scene, PointMass shared);

/// Masses of these points times mass_damping, their part of C, t/s. Every cell's mass has its material's
/// factor; masses added by [[mass]] are not damped.
std::vector<double> point_mass_damping(const Scene& scene);

/// The acceleration by a load that acts on masses, mm/s², at a factor of 1; and that by all loads of a scene.
Eigen::Vector3d acceleration_of(const Load& load);
Eigen::Vector3d gravity(const Scene& scene);

/// All loads of the case as nodal forces, N, at factors of 1: loaded_nodes(), and gravity on point_masses(),
/// shared as PointMass::cells for finite elements.
std::vector<NodeVector> applied_forces(const Scene& scene, PointMass shared = PointMass::cells);

/// Forces on all points in an acceleration (mm/s²), N.  @param masses  point_masses()
std::vector<NodeVector> weights(const std::vector<double>& masses, const Eigen::Vector3d& acceleration);

} // namespace springproof::cases
