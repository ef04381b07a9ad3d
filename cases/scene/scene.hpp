#pragma once

#include "cases/case/case.hpp"
#include "cases/mesh/cell_point.hpp"
#include "cases/mesh/triangle_mesh.hpp"
#include "cases/scene/network.hpp"

namespace springproof::cases {

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
  HexMesh mesh;
  std::vector<int> material_of_cell;         ///< in materials_of(definition); empty when there is but one
  std::vector<ConstrainedNodes> constrained; ///< [[fixed]], [[symmetry]], [[moved]] and nodes of rigid cells:
                                             ///< all constrained degrees of freedom
  std::vector<MovedNodes> moved;             ///< the sides of joined cuts after [[moved]]
  std::vector<AppliedLoad> loads;
  std::vector<AppliedMass> masses{};
  std::vector<NetworkSpring> network{}; ///< springs of design = "network", which are no cells'
  TriangleMesh surface{};               ///< from the case's file; empty: it names none
  std::vector<std::string> remarks{};   ///< what was left out of files that the body is made from
};

/// Nodes, edges and faces of a region. Faces of a box are planes of the mesh's bounding box.
/// @throws InputError if it names nothing on this mesh or selects no node
Selection select(const HexMesh& mesh, const Region& region);

/// The region's only node.  @throws InputError if it selects none or several
int select_node(const HexMesh& mesh, const Region& region);

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

} // namespace springproof::cases
