#pragma once

#include "cases/mesh/vtk_functions.hpp"
#include "compare/gates/comparison.hpp"
#include "msm/spring.hpp"

#include <ostream>

namespace springproof::compare {

/// Springs as lines between points.
struct SpringLines {
  std::vector<std::array<int, 2>> ends;
  std::vector<double> stiffness;   ///< at rest, N/mm
  std::vector<double> rest_length; ///< mm

  void add(int i, int j, const msm::Spring& spring) {
    ends.push_back({i, j});
    stiffness.push_back(spring.stiffness);
    rest_length.push_back(spring.rest_length);
  }
};

/// The lines as a VTK unstructured grid (.vtu, doubles, raw binary), with their stiffness and rest_length.
/// @param points  at rest, mm    @param others  further fields of the points and the lines
std::string vtu_of_lines(const std::vector<Eigen::Vector3d>& points, const SpringLines& lines,
                         cases::GridFields others);

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
