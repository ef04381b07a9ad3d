#include "msm/lattice.hpp"

#include "msm/tangent.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

namespace springproof::msm {

namespace {

using cases::index;
using Eigen::Vector3d;

/// Calls action(a, b, c, d) for every vertex a of every face; b, c, d follow it around the face.
template<class Action>
void for_each_corner(const Action& action) {
  for (const auto& face : cases::cell_faces) {
    const auto vertex = [&](std::size_t i) { return static_cast<std::size_t>(face[i % 4]); };
    for (std::size_t i = 0; i < 4; ++i) action(vertex(i), vertex(i + 1), vertex(i + 2), vertex(i + 3));
  }
}

} // namespace

std::array<Vector3d, 8> trilinear_volume_gradient(const CellPositions& x) {
  std::array<Vector3d, 8> gradient;
  gradient.fill(Vector3d::Zero());
  for_each_corner([&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    gradient[a] += (x[b].cross(x[c] + x[d]) + x[c].cross(x[d])) / 12;
  });
  return gradient;
}

double trilinear_volume(const CellPositions& x) {
  const std::array<Vector3d, 8> gradient = trilinear_volume_gradient(x);
  double triple = 0; // Euler: a cubic form is a third of its gradient times its argument
  for (std::size_t a = 0; a < 8; ++a) triple += x[a].dot(gradient[a]);
  return triple / 3;
}

std::array<std::array<Eigen::Matrix3d, 8>, 8> trilinear_volume_second_derivative(const CellPositions& x) {
  std::array<std::array<Eigen::Matrix3d, 8>, 8> blocks;
  for (auto& row : blocks) row.fill(Eigen::Matrix3d::Zero());
  const auto add = [](Eigen::Matrix3d& block, const Vector3d& w) { // T_abc x_c
    Eigen::Matrix3d cross;
    cross << 0, w.z(), -w.y(), -w.z(), 0, w.x(), w.y(), -w.x(), 0;
    block += cross;
  };
  for_each_corner([&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    for (const auto& [second, third, sign] :
         {std::tuple(b, c, 1), {b, d, 1}, {c, d, 1}, {c, b, -1}, {d, b, -1}, {d, c, -1}})
      add(blocks[a][second], sign / 12. * x[third]);
  });
  return blocks;
}

CellPositions cell_positions(const VolumeCell& cell, const Points& positions) {
  CellPositions x;
  for (std::size_t v = 0; v < 8; ++v) x[v] = positions[index(cell.nodes[v])];
  return x;
}

VolumeLaw VolumeCell::law(const CellPositions& x) const {
  return volume_law(trilinear_volume(x) / rest_volume, is_logarithmic);
}

Tetrahedron make_tetrahedron(const std::array<int, 4>& nodes, const Points& rest, double lambda, double mu) {
  Tetrahedron made{nodes, {}, {}};
  const TetrahedronPositions x = tetrahedron_positions(made, rest);
  made.stiffness = biquadratic_stiffness(x, lambda, mu);
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [a, b] = tetrahedron_edges[e];
    made.rest_lengths[static_cast<Eigen::Index>(e)] = (x[index(b)] - x[index(a)]).norm();
  }
  return made;
}

TetrahedronPositions tetrahedron_positions(const Tetrahedron& tetrahedron, const Points& positions) {
  TetrahedronPositions x;
  for (std::size_t v = 0; v < 4; ++v) x[v] = positions[index(tetrahedron.nodes[v])];
  return x;
}

namespace {

/// Returns a function for the vector from point i to point j, by positions or by displacements.
auto between(const Points& positions) {
  return [&](int i, int j) -> Vector3d { return positions[index(j)] - positions[index(i)]; };
}
auto between(const Points& rest, const Points& displacement) {
  return [&](int i, int j) -> Vector3d {
    return (rest[index(j)] - rest[index(i)]) + (displacement[index(j)] - displacement[index(i)]);
  };
}

/// The vertices of a cell as seen from the first.
template<class Between>
CellPositions cell_shape(const VolumeCell& cell, const Between& from_to) {
  CellPositions x;
  for (std::size_t v = 0; v < 8; ++v) x[v] = from_to(cell.nodes[0], cell.nodes[v]);
  return x;
}

template<class Between>
TetrahedronPositions tetrahedron_shape(const Tetrahedron& tetrahedron, const Between& from_to) {
  TetrahedronPositions x;
  for (std::size_t v = 0; v < 4; ++v) x[v] = from_to(tetrahedron.nodes[0], tetrahedron.nodes[v]);
  return x;
}

template<class Between>
double energy_of(const Lattice& lattice, const Between& from_to) {
  double sum = 0;
  for (const Link& link : lattice.links) sum += spring_energy(from_to(link.i, link.j), link.spring);
  for (const VolumeCell& cell : lattice.volume_cells)
    sum += cell.stiffness * cell.rest_volume * cell.law(cell_shape(cell, from_to)).integral;
  for (const Tetrahedron& t : lattice.tetrahedra)
    sum += biquadratic_energy(tetrahedron_shape(t, from_to), t.rest_lengths, t.stiffness);
  return sum;
}

template<class Between>
Points force_of(const Lattice& lattice, const Between& from_to) {
  Points force(lattice.rest.size(), Vector3d::Zero());
  for (const Link& link : lattice.links) {
    const Vector3d f = spring_force(from_to(link.i, link.j), link.spring);
    force[index(link.i)] += f;
    force[index(link.j)] -= f;
  }
  for (const VolumeCell& cell : lattice.volume_cells) {
    const CellPositions x = cell_shape(cell, from_to);
    const double pressure = cell.stiffness * cell.law(x).pressure;
    const auto gradient = trilinear_volume_gradient(x);
    for (std::size_t v = 0; v < 8; ++v) force[index(cell.nodes[v])] -= pressure * gradient[v];
  }
  for (const Tetrahedron& t : lattice.tetrahedra) {
    const auto forces = biquadratic_forces(tetrahedron_shape(t, from_to), t.rest_lengths, t.stiffness);
    for (std::size_t v = 0; v < 4; ++v) force[index(t.nodes[v])] += forces[v];
  }
  return force;
}

/// Whether no spring's vector, cell's edge or tetrahedron's edge changes by midpoint_below of its length, and
/// no spring is under tension at rest.
bool is_small(const Lattice& lattice, const Points& displacement) {
  const auto is_small_between = [&](int i, int j) {
    return (displacement[index(j)] - displacement[index(i)]).norm() <
           midpoint_below * (lattice.rest[index(j)] - lattice.rest[index(i)]).norm();
  };
  for (const Link& link : lattice.links) {
    const double length = (lattice.rest[index(link.j)] - lattice.rest[index(link.i)]).norm();
    if (!(std::abs(length - link.spring.rest_length) <= 1e-12 * length) || !is_small_between(link.i, link.j))
      return false;
  }
  const auto are_small = [&](const auto& nodes, const auto& edges) {
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
      return is_small_between(nodes[index(edge[0])], nodes[index(edge[1])]);
    });
  };
  return std::all_of(lattice.volume_cells.begin(), lattice.volume_cells.end(),
                     [&](const VolumeCell& cell) { return are_small(cell.nodes, cases::cell_edges); }) &&
         std::all_of(lattice.tetrahedra.begin(), lattice.tetrahedra.end(),
                     [&](const Tetrahedron& t) { return are_small(t.nodes, tetrahedron_edges); });
}

/// K(u part) u, with the tangent at a part of the way to the displacement, as seen from the first point.
Points tangent_product(const Lattice& lattice, const Points& displacement, double part) {
  Points at = lattice.rest, product(at.size(), Vector3d::Zero());
  for (std::size_t p = 0; p < at.size(); ++p)
    at[p] = (lattice.rest[p] - lattice.rest[0]) + part * displacement[p];
  visit_tangent_blocks(lattice, at, TransverseTerm::exact,
                       [&](int row, int column, const Eigen::Matrix3d& block) {
                         product[index(row)] += block * displacement[index(column)];
                         if (row != column)
                           product[index(column)] += block.transpose() * displacement[index(row)];
                       });
  return product;
}

} // namespace

double energy(const Lattice& lattice, const Points& positions) {
  return energy_of(lattice, between(positions));
}

double energy_at(const Lattice& lattice, const Points& displacement) {
  if (!is_small(lattice, displacement)) return energy_of(lattice, between(lattice.rest, displacement));
  const Points force = tangent_product(lattice, displacement, 1. / 3);
  double sum = 0;
  for (std::size_t p = 0; p < force.size(); ++p) sum += force[p].dot(displacement[p]) / 2;
  return sum;
}

double small_motion_energy(const Lattice& lattice, const Points& motion) {
  double sum = 0;
  for (const auto& [i, j, spring] : lattice.links) {
    const Vector3d along = (lattice.rest[index(j)] - lattice.rest[index(i)]).normalized();
    const double elongation = along.dot(motion[index(j)] - motion[index(i)]);
    sum += 0.5 * spring.stiffness * elongation * elongation;
  }
  for (const VolumeCell& cell : lattice.volume_cells) {
    const auto gradient = trilinear_volume_gradient(cell_positions(cell, lattice.rest));
    double change = 0;
    for (std::size_t v = 0; v < 8; ++v) change += gradient[v].dot(motion[index(cell.nodes[v])]);
    sum += 0.5 * cell.stiffness / cell.rest_volume * change * change;
  }
  for (const Tetrahedron& t : lattice.tetrahedra) {
    EdgeValues changes; // changes of squared lengths, to first order
    for (std::size_t e = 0; e < 6; ++e) {
      const int a = t.nodes[index(tetrahedron_edges[e][0])], b = t.nodes[index(tetrahedron_edges[e][1])];
      changes[static_cast<Eigen::Index>(e)] =
          2 * (lattice.rest[index(b)] - lattice.rest[index(a)]).dot(motion[index(b)] - motion[index(a)]);
    }
    sum += 0.5 * changes.dot(t.stiffness * changes);
  }
  return sum;
}

Points internal_force(const Lattice& lattice, const Points& positions) {
  return force_of(lattice, between(positions));
}

Points internal_force_at(const Lattice& lattice, const Points& displacement) {
  if (!is_small(lattice, displacement)) return force_of(lattice, between(lattice.rest, displacement));
  Points force = tangent_product(lattice, displacement, 0.5);
  for (Vector3d& of_point : force) of_point = -of_point;
  return force;
}

} // namespace springproof::msm
