#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"

#include <array>
#include <string>
#include <vector>

namespace springproof::compare {

/// A number that is known up to an error bar.
struct ReferenceValue {
  std::string name, unit;
  double value;               ///< extrapolated to no mesh width, where there is an order to do that by
  double uncertainty_percent; ///< grid convergence index of the finest mesh
  std::string note;           ///< how it was found when there is no order
};

/// What every variant of a sweep is held against: the finite-strain answer extrapolated from three meshes,
/// each known on the nodes of a grid.
struct Reference {
  cases::Scene scene;       ///< that of the middle grid, on whose nodes displacements are compared
  cases::Solution solution; ///< the extrapolated displacement there
  ReferenceValue field;     ///< the displacement as a whole; its value is the root mean square, mm
  std::vector<ReferenceValue> measures; ///< those of the case, in its order
};

/// Extrapolates by Richardson's rule, measures by what judge_refinement() finds, the displacement by the
/// order of its differences' L2 norms on the coarsest grid's nodes. Without an order the finest mesh's value
/// stands, and its uncertainty is three times the difference to the next mesh: an order of 1 is assumed, with
/// the safety factor that Roache (1994) asks for then.
/// @param definition    its body is a box
/// @param cells         of three grids, each of twice the cells before
/// @param displacement  mm, on the nodes of each
/// @throws InputError if the case's measures have no nodes on the middle grid
Reference make_reference(const cases::Case& definition, const std::array<std::array<int, 3>, 3>& cells,
                         const std::array<std::vector<Eigen::Vector3d>, 3>& displacement);

/// Error of a displacement on another grid of the same box, percent of the reference's: L2 norm of the
/// difference, on the reference's mesh.
std::optional<double> field_error_percent(const Reference& reference, const std::array<int, 3>& cells,
                                          const std::vector<Eigen::Vector3d>& displacement);

/// Errors of the case's measures, percent, with their sign; volumes are those of the interpolated
/// displacement.
std::vector<std::optional<double>> measure_errors_percent(const Reference& reference,
                                                          const std::array<int, 3>& cells,
                                                          const std::vector<Eigen::Vector3d>& displacement);

/// The case's scene on a box of that many cells, measures and all.  @throws InputError
cases::Scene scene_on(const cases::Case& definition, const std::array<int, 3>& cells);

/// A field on the nodes of a box's grid, trilinear between them, at the nodes of another grid of the same
/// box.
/// @param field     one vector per node, x fastest
/// @param from, to  cells along x, y, z
std::vector<Eigen::Vector3d> interpolate(const std::vector<Eigen::Vector3d>& field,
                                         const std::array<int, 3>& from, const std::array<int, 3>& to);

} // namespace springproof::compare
