#pragma once

#include "msm/spring.hpp"

#include <array>

/// Tetrahedra of biquadratic springs: energies of the changes of squared lengths, Delta_e = l_e² - L_e², of
/// the six edges,
///   W = 1/2 sum_ef K_ef Delta_e Delta_f,  K_ef = V/4 (2 mu B_e : B_f + lambda tr B_e tr B_f),
///   B_e = sym(grad N_a (x) grad N_b) for the edge e = (a, b) and the linear shape functions N.
/// As the Green strain of a linear tetrahedron is -1/2 sum_e Delta_e B_e, this is the St. Venant-Kirchhoff
/// energy V (mu E : E + lambda/2 (tr E)²) of the linear finite element.
/// Source: Delingette 2008 (in two dimensions: triangular biquadratic springs), in three dimensions.
namespace springproof::msm {

inline constexpr std::array<std::array<int, 2>, 6> tetrahedron_edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

using TetrahedronPositions = std::array<Eigen::Vector3d, 4>; ///< mm
using EdgeValues = Eigen::Matrix<double, 6, 1>;              ///< in the order of tetrahedron_edges
using EdgeMatrix = Eigen::Matrix<double, 6, 6>;
using TetrahedronMatrix = Eigen::Matrix<double, 12, 12>;

/// @return mm³, positive or negative as the vertices are ordered
double tetrahedron_volume(const TetrahedronPositions& x);

/// K of the energy above, N/mm³.
/// @param rest  mm, of a volume that is not 0    @param lambda, mu  MPa
EdgeMatrix biquadratic_stiffness(const TetrahedronPositions& rest, double lambda, double mu);

/// Delta_e, mm².
EdgeValues squared_length_changes(const TetrahedronPositions& x, const EdgeValues& rest_lengths);

/// N mm.
double biquadratic_energy(const TetrahedronPositions& x, const EdgeValues& rest_lengths,
                          const EdgeMatrix& stiffness);

/// Tensions of the edges, N: each pulls its ends together with 2 (K Delta)_e l_e, below 0 when they are
/// pushed apart.
EdgeValues biquadratic_tensions(const TetrahedronPositions& x, const EdgeValues& rest_lengths,
                                const EdgeMatrix& stiffness);

/// Forces on the vertices, N: minus the gradient of the energy.
TetrahedronPositions biquadratic_forces(const TetrahedronPositions& x, const EdgeValues& rest_lengths,
                                        const EdgeMatrix& stiffness);

/// Second derivative of the energy, N/mm; degree of freedom 3*vertex + component. Clamped, no edge under
/// compression has its geometric part, and the matrix is positive semidefinite where K is.
TetrahedronMatrix biquadratic_tangent(const TetrahedronPositions& x, const EdgeValues& rest_lengths,
                                      const EdgeMatrix& stiffness, TransverseTerm term);

} // namespace springproof::msm
