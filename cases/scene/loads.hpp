#pragma once

#include "cases/scene/scene.hpp"

#include <functional>
#include <map>

/// Loads of a scene as forces on its nodes, and its masses: kg/m³, kg and m/s² of the case become t/mm³, t
/// and mm/s² here, and nowhere else.
namespace springproof::cases {

constexpr double tonnes_per_kg = 1e-3;

/// Part of a node's load or added mass that the modelled part of a symmetric scene carries, as a function of
/// the node: halved by each symmetry plane through it.
std::function<double(int node)> modelled_share(const Scene& scene);

/// Makes nodes and parts of a patch's load from its points: a nodal force shared by their weights, all of it
/// on the modelled part of a symmetric scene.
/// @param mesh  the points' mesh     @param share  modelled_share() of the scene
void give_to_nodes(Scene::AppliedLoad& patch, const Mesh& mesh, const std::function<double(int node)>& share);

/// A force (N) or a displacement (mm) of one node.
struct NodeVector {
  int node;
  Eigen::Vector3d value;
};

/// All loads as forces on the nodes that loads act on, N, in ascending order: point forces as they are (a
/// node on symmetry planes carries the modelled part alone: half, a quarter, an eighth), tractions and
/// torques integrated with bilinear shape functions on the rest faces. Gravity is none of them: models have
/// masses of their own.
std::vector<NodeVector> loaded_nodes(const Scene& scene);
/// The same for some of the scene's loads alone.
std::vector<NodeVector> loaded_nodes(const Scene& scene, const std::vector<Scene::AppliedLoad>& loads);

/// Area of a selection's faces at rest, mm²; 0 for nodes and edges. Exact for planar faces.
double area(const Mesh& mesh, const Selection& selection);

/// One sentence for each traction on a patch whose faces' area differs by more than a tenth from that which
/// the sphere cuts from the case's [surface], or from a flat circle's: faces of voxels are stairs.
std::vector<std::string> warnings_of_loads(const Scene& scene);

/// The point forces (nodal_force, total_force) alone.
std::vector<NodeVector> nodes_with_point_forces(const Scene& scene);

/// One vector for each of n nodes, zero where there is none.
std::vector<Eigen::Vector3d> on_all_nodes(const std::vector<NodeVector>& some, std::size_t n);

/// The same for all nodes of the mesh.
std::vector<Eigen::Vector3d> nodal_forces(const Scene& scene);

/// The dead surface traction (MPa) of a load on an area, as a function of a point (mm) of its region at rest;
/// empty for other loads.
std::function<Eigen::Vector3d(const Eigen::Vector3d& point)>
surface_traction(const Mesh& mesh, const Scene::AppliedLoad& applied);

/// A Gauss point of a bilinear face.
struct FacePoint {
  double s, t;        ///< in the unit square: along the face's first edge, and along its last one
  Eigen::Vector3d at; ///< mm
  double area;        ///< mm², its weight
};

/// @param vertices  around the face, mm    @param n  points in each direction, 2 or 4
std::vector<FacePoint> gauss_points(const std::array<Eigen::Vector3d, 4>& vertices, int n);

/// Integral of r² over the rest faces of a torque's region (mm⁴), r the distance from its axis, exact for
/// bilinear planar faces.
double polar_moment(const Mesh& mesh, const Selection& selection, const loads::Torque& torque);

/// Damping and density of a cell's material, t/mm³; without a density in the case nothing has mass.
struct CellDynamics {
  double density;           ///< t/mm³, >= 0
  double mass_damping;      ///< 1/s
  double stiffness_damping; ///< s
};
CellDynamics dynamics_of(const Scene& scene, std::size_t cell);

/// Masses (t) of some nodes, by their numbers.
using NodeMasses = std::map<int, double>;

/// Masses that [[mass]] adds to nodes. A region's nodes share its mass equally; a node on symmetry planes has
/// the modelled part alone, as with a force.
NodeMasses added_masses(const Scene& scene);
/// The mass of a node; 0 where there is none.
double mass_of(const NodeMasses& added, int node);

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
