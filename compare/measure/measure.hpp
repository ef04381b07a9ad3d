#pragma once

#include "compare/measure/over_time.hpp"
#include "compare/solve/answers.hpp"

/// Where ranks share a solution (Solution::sharing), what takes it is collective, and gives the same on each.
namespace springproof::compare {

/// Value of a measure on a converged solution, in unit_of(measure).
///   coordinate, displacement: of the node; tilt: atan2(d_toward, d_up) of the vector from bottom to top;
///   twist: rotation of the segment from centre to node about the axis against its rest direction; both with
///   whole turns, counted through the body (count_turns()), of a motion from step to step; volume: of all
///   cells of the body's mesh; displacement_field_l2: root of the mean of |u|² over the body at rest
///   (trilinear between nodes); displacement_field_max: the largest |u| of a node. reaction: sum over the
///   region's nodes of the supports' force on the body; strain_energy: of all cells; stress, strain: of the
///   cell of the body's mesh that holds the point at rest, the mean of several where they share it;
///   cases::Fields has what they are of a cell.
/// Source: thesis sections 4.3.3 and 5.3.1.3 but for the two norms and the fields.
double evaluate(const cases::Measure& measure, const cases::Scene& scene, const cases::Solution& solution);

/// Whether a solution has what a measure is of: a displacement alone, another program's for one, has no
/// fields.
bool can_evaluate(const cases::Measure& measure, const cases::Solution& solution);
/// A measure of a motion at the start and after every step, in the unit of its values, with its zero.
/// @param solution  has its trajectory; a measure for which is_field_norm() holds is taken at the end alone
TimeSeries series_of(const cases::Measure& measure, const cases::Scene& scene,
                     const cases::Solution& solution);

/// What a case's measure is of a converged solution, in unit_of(measure): evaluate(), or the number of its
/// course over time that a dynamic case asks for.
/// @return nothing where the course has no such number
std::optional<double> value_of(const cases::Measure& measure, const cases::Scene& scene,
                               const cases::Solution& solution);

/// The same, or why it is no finite value.
std::variant<double, std::string> finite_value(const cases::Measure& measure, const cases::Scene& scene,
                                               const cases::Solution& solution);

/// The norm of a field on a mesh's nodes that a measure of the displacement field is.
/// @param kind  one for which is_field_norm() holds   @param field  a vector per node that is here
/// @param sharing  the ranks that share the field; null: all of it is here
double field_norm(const cases::measures::Kind& kind, const cases::Mesh& mesh,
                  const std::vector<Eigen::Vector3d>& field, const cases::Sharing* sharing = nullptr);

/// Error of a displacement in a field's norm, percent of the reference's; never negative.
/// @param zero  up to which size the reference's norm is zero
std::optional<double> field_error_percent(const cases::measures::Kind& kind, const cases::Mesh& mesh,
                                          const std::vector<Eigen::Vector3d>& reference,
                                          const std::vector<Eigen::Vector3d>& other, double zero,
                                          const cases::Sharing* sharing = nullptr);

/// Error of the springs in a measure, percent: field_error_percent() of a field norm,
/// trajectory_error_percent() of a trajectory_l2, otherwise error_percent() of the two values.
std::optional<double> measure_error_percent(const cases::Measure& measure, const cases::Scene& scene,
                                            const cases::Solution& fem, const cases::Solution& msm);

using cases::is_field_norm;

/// Whether a measure's error is that of a difference of its courses over time.
bool is_trajectory_norm(const cases::Measure& measure);

/// "mm", "deg", "mm3", "N", "N mm", "MPa", or "1" of a strain; of numbers over time also "s", "Hz", "%".
std::string unit_of(const cases::Measure& measure);

/// Largest size at which a displacement counts as zero, mm: 1e-8 of the body's largest, for a motion of the
/// largest at any time kept. A solve leaves 1e-9 of its forces.
double zero_of_displacements(const cases::Scene& scene, const cases::Solution& solution);

/// Largest size at which a measure's value counts as zero, in its unit. Displacements have that of the finite
/// elements' solution, angles the same over the body's size, coordinates 1e-8 of the size, reactions 1e-8 of
/// the sum of all nodes' reactions, stress and strain 1e-8 of the body's largest. A time, a frequency and a
/// ratio have none.
double zero_of(const cases::Measure& measure, const cases::Scene& scene, const cases::Solution& fem);

/// r = (msm - fem)/fem x 100 %, as in the thesis; nothing when fem is zero, or next to msm, or either is not
/// finite.
/// @param zero  up to which size fem is zero
std::optional<double> error_percent(double fem, double msm, double zero);

/// What has that name, or null.
template<class Named>
const Named* find_named(const std::vector<Named>& all, const std::string& name) {
  for (const Named& one : all)
    if (one.name == name) return &one;
  return nullptr;
}

// Measures of tensors in cells, and of a solution over a region.

/// A component of a symmetric tensor, its von Mises equivalent or a principal value, in the tensor's unit.
double component_of(const cases::SymmetricTensor& tensor, cases::TensorComponent component);

/// sqrt(3/2 dev(sigma) : dev(sigma))
double von_mises(const cases::SymmetricTensor& tensor);

/// sqrt(sigma : sigma)
double tensor_norm(const cases::SymmetricTensor& tensor);

/// A statistic of a component of the cells' tensors, over the cells that have a face in the measure's region,
/// or over all; means are weighted by the cells' volume at rest.
/// @param of_cells  tensors of the cells that are here
double of_region(const cases::measures::OfCells& measure, const cases::Scene& scene,
                 const cases::Solution& solution, const std::vector<cases::SymmetricTensor>& of_cells);

/// The largest curvature, 1/mm, of the lines of nodes along an axis of the body at rest that lie in the
/// measure's region: of three neighbours, the inverse radius of the circle through their deformed places,
///   4 A / (a b c),  A the area and a, b, c the sides of their triangle.
/// 0 where no three nodes follow each other.
double largest_curvature(const cases::measures::Curvature& measure, const cases::Scene& scene,
                         const cases::Solution& solution);

// Angles beyond half a turn. Where two nodes end tells an angle but for whole turns; the body between them
// and its supports tells these.

constexpr double degrees_per_radian = 57.295779513082320877;

/// The deformation gradient at the centre of a cell.
/// @param displacement  mm, one per node from the first on
Eigen::Matrix3d deformation_gradient(const cases::Mesh& mesh, std::size_t cell,
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
