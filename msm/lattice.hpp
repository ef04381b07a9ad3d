#pragma once

#include "cases/mesh/hex_mesh.hpp"
#include "msm/spring.hpp"
#include "msm/tetrahedron.hpp"

#include <optional>

namespace springproof::msm {

using Points = std::vector<Eigen::Vector3d>;
using CellPositions = std::array<Eigen::Vector3d, 8>; ///< mm, vertex v = i + 2j + 4k

/// Parameters of the law of a cell's springs, by kind: the exponents of power-log springs.
struct Exponents {
  double edge, face_diagonal, internal_diagonal;
  LawKind law = LawKind::power_log;
  bool operator==(const Exponents& other) const {
    return edge == other.edge && face_diagonal == other.face_diagonal &&
           internal_diagonal == other.internal_diagonal && law == other.law;
  }
};

/// The law of a cell's spring that crosses 1 axis (an edge), 2 (a face diagonal) or 3 (an internal diagonal).
/// @param exponents  nothing: Hooke's
inline SpringLaw law_of(const std::optional<Exponents>& exponents, int n_axes) {
  if (!exponents) return {};
  const auto& [edge, face_diagonal, internal_diagonal, law] = *exponents;
  return {law, n_axes == 1 ? edge : n_axes == 2 ? face_diagonal : internal_diagonal};
}
inline LawKind kind_of(const std::optional<Exponents>& exponents) {
  return law_of(exponents, 1).kind;
}

/// The result of a design method for one cell: the springs of its 12 edges, 12 face diagonals and 4 internal
/// diagonals, and the volume term; all of them at rest.
struct CellStiffness {
  double edge = 0;                      ///< k_e, N/mm
  double face_diagonal = 0;             ///< k_f, N/mm
  double internal_diagonal = 0;         ///< k_d, N/mm
  double volume = 0;                    ///< k_v, MPa
  std::optional<Exponents> exponents{}; ///< another law than Hooke's, with its law of the volume term in
                                        ///< place of the linear one, (k_v/2) V0 (V/V0 - 1)²
};

/// All stiffnesses times a factor.
inline CellStiffness scaled(CellStiffness k, double factor) {
  for (double* of : {&k.edge, &k.face_diagonal, &k.internal_diagonal, &k.volume}) *of *= factor;
  return k;
}

/// Two points joined by a spring. Springs of one law that cells share are one link with the sum of the cells'
/// stiffnesses.
struct Link {
  int i, j; ///< i < j
  Spring spring;
};

/// A cell that resists a change of its volume.
struct VolumeCell {
  std::array<int, 8> nodes; ///< vertex v = i + 2j + 4k
  double stiffness;         ///< k_v, MPa
  double rest_volume;       ///< mm³
  bool is_logarithmic = false;

  /// Returns the cell's law at these positions.
  VolumeLaw law(const CellPositions& x) const;
};

/// Four points joined by biquadratic springs (tetrahedron.hpp).
struct Tetrahedron {
  std::array<int, 4> nodes;
  EdgeMatrix stiffness;    ///< N/mm³
  EdgeValues rest_lengths; ///< mm
};

/// Makes a tetrahedron of an isotropic material with Lame's constants, MPa.
Tetrahedron make_tetrahedron(const std::array<int, 4>& nodes, const Points& rest, double lambda, double mu);

/// A mass-spring body at rest: its points, links, tetrahedra and volume terms. Links are sorted by (i, j) and
/// unique but for their law.
struct Lattice {
  Points rest; ///< mm
  std::vector<Link> links;
  std::vector<VolumeCell> volume_cells; ///< empty when no cell has a volume term
  std::vector<Tetrahedron> tetrahedra{};
};

/// Volume of the trilinear hexahedron, mm³, and its derivatives. It is a cubic form of the vertices,
///   V = 1/6 sum_abc T_abc x_a . (x_b x x_c),
/// with T constant and antisymmetric, so that all three are exact. The volume under a bilinear face a, b, c,
/// d, anticlockwise from outside, is the mean of what its two triangulations give: it adds (b x c + c x d + b
/// x d) / 12 to the derivative with respect to a.
double trilinear_volume(const CellPositions& x);

/// dV/dx_a, mm².
std::array<Eigen::Vector3d, 8> trilinear_volume_gradient(const CellPositions& x);

/// d²V/(dx_a dx_b) as 3x3 blocks [a][b], mm: entry (i, j) = epsilon_ijk (sum_c T_abc x_c)_k.
std::array<std::array<Eigen::Matrix3d, 8>, 8> trilinear_volume_second_derivative(const CellPositions& x);

/// Positions of the tetrahedron's vertices, mm.
TetrahedronPositions tetrahedron_positions(const Tetrahedron& tetrahedron, const Points& positions);

/// Positions of the cell's vertices, mm.
CellPositions cell_positions(const VolumeCell& cell, const Points& positions);

/// Sum of all energies of springs, tetrahedra and volume terms at these positions, N mm.
double energy(const Lattice& lattice, const Points& positions);

/// What a small motion from rest stores to second order, N mm: half the quadratic form of the tangent at
/// rest, as a sum in which nothing cancels where no stiffness is negative. A mechanism's motion stores 1e-32
/// times stiffness times motion squared; by the tangent it would be 1e-16.
/// @param motion  mm, one per point
double small_motion_energy(const Lattice& lattice, const Points& motion);

/// Internal force on every point, N: minus the gradient of energy().
Points internal_force(const Lattice& lattice, const Points& positions);

/// The same at a displacement (mm) from rest. Far from the origin positions have lost digits that the
/// differences of displacements still have: springs of 1 mm in a column of 1 m lose three.
///
/// Forces of small motions are a product of the displacement: K(u/2) u, the midpoint rule for the integral of
/// the tangent from rest to u, errs by the square of the displacement's gradient relative to itself, where
/// lengths less rest lengths err by rounding over that gradient. Both are below 1e-10 where the rule changes.
/// Their energy is u K(u/3) u / 2, which has the terms of second and third order.
double energy_at(const Lattice& lattice, const Points& displacement);
Points internal_force_at(const Lattice& lattice, const Points& displacement);
constexpr double midpoint_below = 1e-5; ///< changes of a spring's vector over its length

} // namespace springproof::msm
