#pragma once

#include "cases/scene/scene.hpp"

#include <functional>

/// Angles beyond half a turn. Where two nodes end tells an angle but for whole turns; the body between them
/// and its supports tells these.
namespace springproof::compare {

constexpr double degrees_per_radian = 57.295779513082320877;

/// The deformation gradient at the centre of a cell.
/// @param displacement  mm, one per node from the first on
Eigen::Matrix3d deformation_gradient(const cases::HexMesh& mesh, std::size_t cell,
                                     const std::vector<Eigen::Vector3d>& displacement,
                                     std::size_t first_node = 0);

/// What is turned in a plane, and at which nodes.
struct TurnedSegment {
  Eigen::Vector3d along; ///< at rest, of any length, in the plane
  int from, towards;     ///< axes of the plane; positive turns lead from the first towards the second
  std::array<int, 2> nodes;
};

/// The angle that differs by whole turns from `degrees`, and is nearest to the turn of the body at the
/// segment's nodes. That turn is of F along, F the deformation gradients of the cells at a node, counted from
/// node to node in steps of less than half a turn, through the least of them first. It begins at nodes that
/// are held in the plane, where it is less than half a turn, and at turned regions, where it is nearest to
/// theirs; without such nodes at those that are held in one of the plane's axes. Of a body that nothing holds
/// there, and of one whose cells turn by a quarter at most, the angle is in [-180, 180].
/// @param displacement  mm, one per node that is here   @param sharing  as of cases::Solution; collective
/// @param factor        returns a motion's current factor
double count_turns(double degrees, const TurnedSegment& segment, const cases::Scene& scene,
                   const std::vector<Eigen::Vector3d>& displacement, const cases::Sharing* sharing,
                   const std::function<double(const cases::Moved&)>& factor);

/// Values in degrees, each the one nearest to the value before among those that differ by whole turns.
void count_turns_in_time(std::vector<double>& degrees);

} // namespace springproof::compare
