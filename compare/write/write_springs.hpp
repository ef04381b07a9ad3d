#pragma once

#include "compare/gates/comparison.hpp"

#include <ostream>

namespace springproof::compare {

/// Cells of a body up to which its springs are drawn: 2 million lines, 150 MB.
constexpr std::size_t most_cells_with_springs = 150000;

/// Whether the springs' side converged with springs of ours, and the body is not too large.
bool has_drawn_springs(const Comparison& comparison);

/// Springs as lines of a VTK unstructured grid (.vtu, doubles, raw binary): stretch (deformed over rest
/// length), tension (N, below 0 when pressed), stiffness at rest (N/mm), rest_length (mm), and at points
/// msm_displacement (mm). Springs of one law that cells share are one line; so are the edges that tetrahedra
/// of biquadratic springs share, whose tension also follows the other edges of the tetrahedron.
/// @param comparison    of which has_drawn_springs() holds
/// @param displacement  of the springs, mm, of all nodes, whoever shares them
void write_springs_vtu(std::ostream& out, const Comparison& comparison,
                       const std::vector<Eigen::Vector3d>& displacement);

} // namespace springproof::compare
