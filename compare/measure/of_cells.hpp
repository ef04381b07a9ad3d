#pragma once

#include "cases/case/case.hpp"
#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"

/// Measures of tensors in cells, and of a solution over a region, of several cells or nodes. What takes a
/// solution is collective over the ranks that share it.
namespace springproof::compare {

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

} // namespace springproof::compare
