#pragma once

#include "cases/case/case.hpp"
#include "cases/mesh/cell_point.hpp"
#include "cases/mesh/triangle_mesh.hpp"

#include <functional>

namespace springproof::cases {

/// A spring of a user's own network (`design = "network"`) between two nodes of the mesh, by their numbers.
struct NetworkSpring {
  int a, b;
  double stiffness;                    ///< N/mm, > 0
  std::optional<double> rest_length{}; ///< mm, > 0; absent: the distance of the nodes at rest
  std::optional<double> exponent{};    ///< power-log law; absent: Hooke's
};

/// A case with its mesh built and its regions resolved: all that a model needs.
struct Scene {
  struct ConstrainedNodes {
    Selection selection;
    std::array<bool, 3> components;
  };
  struct MovedNodes {
    Selection selection;
    Moved motion;
  };
  struct AppliedLoad {
    Selection selection;
    Load load;
    std::vector<double> part{}; ///< share of a nodal_force at each selected node; empty: all of it
    /// Points of a nodal_force on a patch of a surface, from which give_to_nodes() makes nodes and parts
    std::vector<WeightedPoint> points{};
  };
  struct AppliedMass {
    Selection selection;
    AddedMass added;
  };
  Case definition;
  Mesh mesh;
  std::vector<int> material_of_cell;         ///< in materials_of(definition); empty when there is but one
  std::vector<ConstrainedNodes> constrained; ///< [[fixed]], [[symmetry]], [[moved]] and nodes of rigid cells:
                                             ///< all constrained degrees of freedom
  std::vector<MovedNodes> moved;             ///< the sides of joined cuts after [[moved]]
  std::vector<AppliedLoad> loads;
  std::vector<AppliedMass> masses{};
  std::vector<NetworkSpring> network{}; ///< springs of design = "network", which are no cells'
  std::vector<double> node_masses{};    ///< t, of a network's own nodes; empty: cells have the masses
  std::vector<Scene> of_fem{};          ///< the finite elements' own, beside a network; empty: there is none
  TriangleMesh surface{};               ///< from the case's file; empty: it names none
  std::vector<std::string> remarks{};   ///< what was left out of files that the body is made from
};

/// Nodes, edges and faces of a region. Faces of a box are planes of the mesh's bounding box.
/// @throws InputError if it names nothing on this mesh or selects no node
Selection select(const Mesh& mesh, const Region& region);

/// The region's only node.  @throws InputError if it selects none or several
int select_node(const Mesh& mesh, const Region& region);

/// What a region of a measure has of the nodes' displacements: its only node, or the vertices of the cell
/// that its point lies in, with their shape functions.
/// @throws InputError likewise; if the point lies in no cell
std::vector<NodeWeight> weights_at(const Mesh& mesh, const Region& region);

/// Index in materials_of() of a cell's material.
int material_of(const Scene& scene, std::size_t cell);

/// Whether a cell belongs to the rigid class of a labelled volume.
bool is_rigid(const Scene& scene, std::size_t cell);

/// Builds or reads the body's mesh and resolves every region of the case (those of measures too).
/// @throws InputError with the place in the case file
Scene make_scene(const Case& definition);

/// The same scene on the mesh refined n times. Nodal forces stay on the nodes of the body's own mesh; those
/// on patches stay at their points, and go to the nodes of the fine cells there.
Scene refine(const Scene& scene, int n);

/// Whether degree of freedom 3*node + component is constrained, for every node of the mesh.
std::vector<bool> constrained_dofs(const Scene& scene);

/// Displacement (mm) that a motion prescribes at a load factor for a point with rest position `rest` (mm); 0
/// on components that the motion leaves free. Where it is scaled, that is as at a smaller load factor.
Eigen::Vector3d moved_by(const Moved& motion, const Eigen::Vector3d& rest, double load_factor);

// Networks: `file = "NAME.csv"` in [msm], or `shape = "network"` in [body]

/// The nodes of a network that brings its own.
struct NetworkNodes {
  std::vector<Eigen::Vector3d> places; ///< mm
  std::vector<double> masses;          ///< t, as many or none
};

/// Reads lines of x, y, z in mm, and perhaps mass in kg, which then every node has. Lines are skipped as in
/// read_network().
/// @throws InputError with the line and the field
NetworkNodes read_nodes(const std::string& text, const std::string& name);

/// Reads lines of node a, node b (numbers from 0, in the order of the .vtu files that --out writes),
/// stiffness in N/m, and perhaps rest length in mm and exponent of the power-log law. These two may be empty.
/// Empty lines, those that begin with #, and a heading (the first line alone may be one) are skipped.
/// @param text  the file's content    @param name  the file's, for messages    @param n_nodes  the mesh's
/// @throws InputError with the line and the field
std::vector<NetworkSpring> read_network(const std::string& text, const std::string& name,
                                        std::size_t n_nodes);

/// Likely mistakes in a network, with the number of springs: nodes that several springs join, and rest
/// lengths more than 10 % from the distance of the nodes.
std::vector<std::string> doubts_of(const std::vector<NetworkSpring>& springs,
                                   const std::function<Eigen::Vector3d(int)>& node);

// Cuts and what moves with them: pieces removed from a body, their sides joined, motions that fade out

/// A mesh without the pieces that are cut out of it.
/// @throws InputError, at the piece, if the mesh is no grid of cells or has groups of nodes, if a piece has
/// no cells or one that another has too, and if the rest is not one body whose cells hang together by faces
Mesh cut(Mesh mesh, const std::vector<Removed>& removed);

/// The first piece whose sides are joined, if there is one.
std::optional<Removed> first_joined(const Case& definition);

/// Closes the cuts that are to be joined: the nodes on both sides of the piece get a prescribed displacement
/// along the axis, that of the side's nodes that are held or moved already (the bone's), so that the sides
/// meet in one plane. There they stay, free to slide: where both sides are mirror images of each other, that
/// is as if their nodes were merged. Nodes of cells that are left between the sides stay free: a cell that
/// such a node was joined in would be shut.
/// @param scene  with its supports resolved
/// @throws InputError, at the piece, if it has nothing on one side, if nothing says how a side moves, or if
/// the sides do not meet
void join_cuts(Scene& scene);

/// @throws InputError, at the motion, if no node lies in the zone that is scaled, or none beyond it
void check_scaled(const Scene& scene);

// A dynamic case's scene at single times, and what is watched of it

/// The static scene whose equilibrium a motion may start from: loads and motions by their factors just before
/// time 0, at full load, without [dynamics].
Scene scene_before_start(const Scene& scene);

/// The same with the factors at the motion's end.
Scene scene_at_end(const Scene& scene);

/// Whether the factor of a load follows time.
bool has_load_histories(const Scene& scene);

/// Whether the factor of a load or a moved region jumps after time 0 and before the motion's end.
/// @param scene  a dynamic case's
bool jumps_on_the_way(const Scene& scene);

/// Nodes that the case's measures look at, ascending.
std::vector<int> watched_nodes(const Scene& scene);

/// Whether one of its measures needs the body's volume.
bool watches_volume(const Scene& scene);

} // namespace springproof::cases
