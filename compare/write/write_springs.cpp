#include "compare/write/write_springs.hpp"

#include "cases/mesh/vtk.hpp"
#include "compare/solve/springs.hpp"

#include <algorithm>
#include <map>

namespace springproof::compare {

namespace {

using cases::index;
using Eigen::Vector3d;

/// Of a deformed state.
struct Lines {
  SpringLines at_rest;
  std::vector<double> stretch, tension;

  void add(int i, int j, double length, double the_tension, const msm::Spring& spring) {
    at_rest.add(i, j, spring);
    stretch.push_back(length / spring.rest_length);
    tension.push_back(the_tension);
  }
};

/// An edge of tetrahedra, which may share it.
struct Edge {
  double rest_length = 0, tension = 0, stiffness = 0;
};

Lines lines_of(const msm::Lattice& lattice, const std::vector<Vector3d>& displacement) {
  const auto along = [&](int i, int j) -> Vector3d {
    return (lattice.rest[index(j)] - lattice.rest[index(i)]) +
           (displacement[index(j)] - displacement[index(i)]);
  };
  Lines lines;
  for (const auto& [i, j, spring] : lattice.links) {
    const double length = along(i, j).norm();
    lines.add(i, j, length, msm::spring_slopes(length, spring).transverse * length, spring);
  }
  std::map<std::pair<int, int>, Edge> edges;
  for (const msm::Tetrahedron& t : lattice.tetrahedra) {
    msm::TetrahedronPositions x;
    for (std::size_t v = 0; v < 4; ++v) x[v] = along(t.nodes[0], t.nodes[v]);
    const msm::EdgeValues tensions = msm::biquadratic_tensions(x, t.rest_lengths, t.stiffness);
    for (std::size_t e = 0; e < 6; ++e) {
      const auto& [v, w] = msm::tetrahedron_edges[e];
      const int a = t.nodes[index(v)], b = t.nodes[index(w)];
      const auto at = Eigen::Index(e);
      Edge& edge = edges[std::minmax({a, b})];
      edge.rest_length = t.rest_lengths[at];
      edge.tension += tensions[at];
      edge.stiffness += 4 * t.stiffness(at, at) * edge.rest_length * edge.rest_length; // dT/d|d| at rest
    }
  }
  for (const auto& [ends, edge] : edges)
    lines.add(ends.first, ends.second, along(ends.first, ends.second).norm(), edge.tension,
              {edge.stiffness, edge.rest_length});
  return lines;
}

} // namespace

std::string vtu_of_lines(const std::vector<Vector3d>& points, const SpringLines& lines,
                         cases::GridFields others) {
  others.cell_numbers.push_back({"stiffness", lines.stiffness, "N/mm"});
  others.cell_numbers.push_back({"rest_length", lines.rest_length, "mm"});
  return cases::vtk().write_lines(points, lines.ends, others);
}

bool has_drawn_springs(const Comparison& comparison) {
  const Answers& answers = comparison.answers;
  return answers.msm.converged() && answers.design && answers.msm_source.empty() &&
         comparison.scene.mesh.cells.size() <= most_cells_with_springs;
}

void write_springs_vtu(std::ostream& out, const Comparison& comparison,
                       const std::vector<Vector3d>& displacement) {
  const cases::Scene& scene = comparison.scene;
  const msm::Lattice lattice =
      msm::make_lattice(scene.mesh, springs_as_solved(scene, *comparison.answers.design));
  const Lines lines = lines_of(lattice, displacement);
  cases::GridFields all;
  all.point_vectors.push_back({"msm_displacement", displacement, "mm"});
  all.cell_numbers = {{"stretch", lines.stretch, "1"}, {"tension", lines.tension, "N"}};
  out << vtu_of_lines(lattice.rest, lines.at_rest, std::move(all));
}

} // namespace springproof::compare
