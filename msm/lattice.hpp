#pragma once

#include "cases/mesh/mesh.hpp"
#include "msm/spring.hpp"

#include <optional>

namespace springproof::msm {

using Points = std::vector<Eigen::Vector3d>;
using CellPositions = std::array<Eigen::Vector3d, 8>; ///< mm, vertex v = i + 2j + 4k

/// Parameters of the law of a cell's springs, by kind: the exponents of power-log springs.
struct Exponents {
  std::array<double, 3> by_kind; ///< an edge's, a face diagonal's, an internal diagonal's
  LawKind law = LawKind::power_log;
  bool operator==(const Exponents& other) const { return by_kind == other.by_kind && law == other.law; }
};

/// The law of a cell's spring that crosses 1 axis (an edge), 2 (a face diagonal) or 3 (an internal diagonal).
/// @param exponents  nothing: Hooke's
inline SpringLaw law_of(const std::optional<Exponents>& exponents, int n_axes) {
  return exponents ? SpringLaw{exponents->law, exponents->by_kind[cases::index(n_axes - 1)]} : SpringLaw{};
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
  double midline = 0;                   ///< k_m of each of the 3 midlines, N/mm

  /// k_e, k_f, k_d.
  std::array<double, 3> springs() const { return {edge, face_diagonal, internal_diagonal}; }
};

/// All stiffnesses times a factor.
inline CellStiffness scaled(CellStiffness k, double factor) {
  for (double* of : {&k.edge, &k.face_diagonal, &k.internal_diagonal, &k.volume, &k.midline}) *of *= factor;
  return k;
}

/// Where the nodes of a term are, mm.
template<std::size_t n>
using Positions = std::array<Eigen::Vector3d, n>;

/// Volume of the trilinear hexahedron and of the tetrahedron, mm³, and its derivatives. It is a cubic form of
/// the vertices,
///   V = 1/6 sum_abc T_abc x_a . (x_b x x_c),
/// with T constant and antisymmetric, so that all three are exact. The volume under a bilinear face a, b, c,
/// d, anticlockwise from outside, is the mean of what its two triangulations give: it adds (b x c + c x d + b
/// x d) / 12 to the derivative with respect to a. A triangle a, b, c adds b x c / 6.
double volume_of(const Positions<8>& x);
double volume_of(const Positions<4>& x);

/// dV/dx_a, mm².
Positions<8> volume_gradient(const Positions<8>& x);
Positions<4> volume_gradient(const Positions<4>& x);
cases::CellCorners volume_gradient(const cases::CellCorners& x);

/// d²V/(dx_a dx_b) as 3x3 blocks [a][b], mm: entry (i, j) = epsilon_ijk (sum_c T_abc x_c)_k.
template<std::size_t n>
using Blocks = std::array<std::array<Eigen::Matrix3d, n>, n>;
Blocks<8> volume_second_derivative(const Positions<8>& x);
Blocks<4> volume_second_derivative(const Positions<4>& x);

/// Two points joined by a spring. Springs of one law that cells share are one link with the sum of the cells'
/// stiffnesses.
///
/// The terms of a lattice are of several kinds: links, Midline, VolumeCell, VolumePatch, Tetrahedron. Every
/// kind has, by its nodes' positions x, the `energy`, N mm; the `forces` on the nodes, N, minus its gradient;
/// the `tangent`, its second derivative: a function that returns the 3x3 block of two nodes, N/mm, clamped
/// such that the whole is positive semidefinite where no stiffness is negative; and the
/// `small_motion_energy` from rest, to second order. Its `edges` tell how much it is deformed.
struct Link {
  static constexpr std::array<std::array<int, 2>, 1> edges{{{0, 1}}};
  int i, j; ///< i < j
  Spring spring;

  double energy(const Positions<2>& x) const { return spring_energy(x[1] - x[0], spring); }
  double small_motion_energy(const Positions<2>& rest, const Positions<2>& motion) const {
    const double elongation = (rest[1] - rest[0]).normalized().dot(motion[1] - motion[0]);
    return 0.5 * spring.stiffness * elongation * elongation;
  }
  auto tangent(const Positions<2>& x, Clamp clamp) const {
    return [block = spring_stiffness(x[1] - x[0], spring, clamp)](std::size_t a,
                                                                  std::size_t b) -> Eigen::Matrix3d {
      return a == b ? block : Eigen::Matrix3d(-block);
    };
  }
};

/// The centres of two opposite faces of a cell, means of four vertices each, joined by a spring. It follows
/// stretch and shear of the cell as the four edges beside it do, and resists no bending.
struct Midline {
  static constexpr auto& edges = cases::cell_edges;
  std::array<int, 8> nodes; ///< vertex v = i + 2j + 4k
  int axis;                 ///< from the face of the vertices whose bit `axis` is 0 to the other
  Spring spring;

  /// What vertex v adds to the vector between the centres, times its position.
  double part(std::size_t v) const { return (v >> axis & 1U) != 0 ? 0.25 : -0.25; }
  Eigen::Vector3d between_centres(const CellPositions& x) const {
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    for (std::size_t v = 0; v < 8; ++v) d += part(v) * x[v];
    return d;
  }
  double energy(const CellPositions& x) const { return spring_energy(between_centres(x), spring); }
  double small_motion_energy(const CellPositions& rest, const CellPositions& motion) const {
    const double elongation = between_centres(rest).normalized().dot(between_centres(motion));
    return 0.5 * spring.stiffness * elongation * elongation;
  }
  CellPositions forces(const CellPositions& x) const {
    const Eigen::Vector3d force = spring_force(between_centres(x), spring); // on the first centre
    CellPositions all;
    for (std::size_t v = 0; v < 8; ++v) all[v] = -part(v) * force;
    return all;
  }
  auto tangent(const CellPositions& x, Clamp clamp) const {
    return [own = *this, block = spring_stiffness(between_centres(x), spring, clamp)](
               std::size_t a, std::size_t b) -> Eigen::Matrix3d { return own.part(a) * own.part(b) * block; };
  }
};

/// A cell that resists a change of its volume. Clamped, its tangent is without the second
/// derivative of the volume under pressure.
struct VolumeCell {
  static constexpr auto& edges = cases::cell_edges;
  std::array<int, 8> nodes; ///< in the order of the reference cell
  double stiffness;         ///< k_v, MPa
  double rest_volume;       ///< mm³
  bool is_logarithmic = false;
  double remembered = 0; ///< MPa, pressure that a material's memory adds to the law's

  /// Returns the cell's law at these positions.
  VolumeLaw law(const CellPositions& x) const {
    return volume_law(volume_of(x) / rest_volume, is_logarithmic);
  }
  double energy(const CellPositions& x) const {
    const double volume = volume_of(x);
    return stiffness * rest_volume * volume_law(volume / rest_volume, is_logarithmic).integral +
           remembered * (volume - rest_volume);
  }
  double small_motion_energy(const CellPositions& rest, const CellPositions& motion) const {
    const CellPositions gradient = volume_gradient(rest);
    double change = 0;
    for (std::size_t v = 0; v < 8; ++v) change += gradient[v].dot(motion[v]);
    return 0.5 * stiffness / rest_volume * change * change;
  }
  CellPositions forces(const CellPositions& x) const {
    const double pressure = stiffness * law(x).pressure + remembered;
    CellPositions all = volume_gradient(x);
    for (Eigen::Vector3d& force : all) force *= -pressure;
    return all;
  }
  auto tangent(const CellPositions& x, Clamp clamp) const {
    const VolumeLaw at = law(x);
    return [=, pressure = stiffness * at.pressure + remembered, slope = stiffness / rest_volume * at.slope,
            gradient = volume_gradient(x),
            second = volume_second_derivative(x)](std::size_t a, std::size_t b) -> Eigen::Matrix3d {
      Eigen::Matrix3d block = slope * gradient[a] * gradient[b].transpose();
      if (clamp == Clamp::no) block += pressure * second[a][b];
      return block;
    };
  }
};
/// The tetrahedra about a node, which resist a change of the quarter of their volume that is the node's. A
/// term a tetrahedron would be five or six a node, which lock where the volume hardly changes. Clamped, the
/// tangent is without the second derivative of the volume, as VolumeCell's.
/// Source: the average nodal pressure of Bonet & Burton 1998.
struct VolumePatch {
  std::vector<int> nodes;                     ///< the node, then its neighbours
  std::vector<std::array<int, 4>> tetrahedra; ///< places among `nodes`
  std::vector<std::array<int, 2>> edges;      ///< from the node to its neighbours, places among `nodes`
  double stiffness;                           ///< MPa
  double rest_volume;                         ///< mm³
  bool is_logarithmic = false;
  double remembered = 0; ///< MPa, as VolumeCell's

  double volume(const Points& x) const;
  Points gradient(const Points& x) const; ///< dV/dx, mm²
  VolumeLaw law(const Points& x) const { return volume_law(volume(x) / rest_volume, is_logarithmic); }
  /// The law at a displacement from rest: no digits of a small change of volume are lost.
  VolumeLaw law_at(const Points& rest, const Points& displacement) const;
  double energy(const Points& x) const {
    const double now = volume(x);
    return stiffness * rest_volume * volume_law(now / rest_volume, is_logarithmic).integral +
           remembered * (now - rest_volume);
  }
  double small_motion_energy(const Points& rest, const Points& motion) const;
  Points forces(const Points& x) const;
  /// Degree of freedom 3*place + component.
  Eigen::MatrixXd tangent_matrix(const Points& x, Clamp clamp) const;
  auto tangent(const Points& x, Clamp clamp) const {
    return [matrix = tangent_matrix(x, clamp)](std::size_t a, std::size_t b) -> Eigen::Matrix3d {
      return matrix.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b));
    };
  }
};

/// Tetrahedra of biquadratic springs: energies of the changes of squared lengths, Delta_e = l_e² - L_e², of
/// the six edges,
///   W = 1/2 sum_ef K_ef Delta_e Delta_f,  K_ef = V/4 (2 mu B_e : B_f + lambda tr B_e tr B_f),
///   B_e = sym(grad N_a (x) grad N_b) for the edge e = (a, b) and the linear shape functions N.
/// As the Green strain of a linear tetrahedron is -1/2 sum_e Delta_e B_e, this is the St. Venant-Kirchhoff
/// energy V (mu E : E + lambda/2 (tr E)²) of the linear finite element.
/// Source: Delingette 2008 (in two dimensions: triangular biquadratic springs), in three dimensions.
inline constexpr std::array<std::array<int, 2>, 6> tetrahedron_edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

using TetrahedronPositions = Positions<4>;
using EdgeValues = Eigen::Matrix<double, 6, 1>; ///< in the order of tetrahedron_edges
using EdgeMatrix = Eigen::Matrix<double, 6, 6>;
using TetrahedronMatrix = Eigen::Matrix<double, 12, 12>;

/// K of the energy above, N/mm³.
/// @param rest  mm, of a volume that is not 0    @param lambda, mu  MPa
EdgeMatrix biquadratic_stiffness(const TetrahedronPositions& rest, double lambda, double mu);

/// Four points joined by biquadratic springs.
struct Tetrahedron {
  static constexpr auto& edges = tetrahedron_edges;
  std::array<int, 4> nodes;
  EdgeMatrix stiffness;                       ///< N/mm³
  EdgeValues rest_lengths;                    ///< mm
  EdgeValues remembered = EdgeValues::Zero(); ///< N/mm, what a material's memory adds to K Delta

  /// Delta_e, mm².
  EdgeValues squared_length_changes(const TetrahedronPositions& x) const;
  /// K Delta, N/mm, and what is remembered.
  EdgeValues density(const TetrahedronPositions& x) const {
    return stiffness * squared_length_changes(x) + remembered;
  }
  /// Tensions of the edges, N: each pulls its ends together with 2 (K Delta)_e l_e, below 0 when they are
  /// pushed apart.
  EdgeValues tensions(const TetrahedronPositions& x) const;
  double energy(const TetrahedronPositions& x) const;
  double small_motion_energy(const TetrahedronPositions& rest, const TetrahedronPositions& motion) const;
  TetrahedronPositions forces(const TetrahedronPositions& x) const;
  /// Degree of freedom 3*vertex + component. Clamped, no edge under compression has its geometric part, and
  /// the matrix is positive semidefinite where K is.
  TetrahedronMatrix tangent_matrix(const TetrahedronPositions& x, Clamp clamp) const;
  auto tangent(const TetrahedronPositions& x, Clamp clamp) const {
    return [matrix = tangent_matrix(x, clamp)](std::size_t a, std::size_t b) -> Eigen::Matrix3d {
      return matrix.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b));
    };
  }
};

/// Makes a tetrahedron of an isotropic material with Lame's constants, MPa.
/// @param rest  positions of its vertices, mm
Tetrahedron make_tetrahedron(const std::array<int, 4>& nodes, const TetrahedronPositions& rest, double lambda,
                             double mu);

/// A mass-spring body at rest: its points, links, tetrahedra and volume terms. Links are sorted by (i, j) and
/// unique but for their law.
struct Lattice {
  Points rest; ///< mm
  std::vector<Link> links;
  std::vector<VolumeCell> volume_cells;      ///< empty when no cell has a volume term
  std::vector<VolumePatch> volume_patches{}; ///< in the order of their first nodes
  std::vector<Tetrahedron> tetrahedra{};
  std::vector<Midline> midlines{};
};

/// Calls action(terms) for the terms of each kind.
/// @param lattice  a Lattice, constant or not
template<class AnyLattice, class Action>
void for_each_kind(AnyLattice& lattice, const Action& action) {
  action(lattice.links);
  action(lattice.volume_cells);
  action(lattice.volume_patches);
  action(lattice.tetrahedra);
  action(lattice.midlines);
}

template<class Term>
const auto& nodes_of(const Term& term) {
  return term.nodes;
}
inline std::array<int, 2> nodes_of(const Link& link) {
  return {link.i, link.j};
}

/// The values of some nodes among those of all points.
template<std::size_t n>
Positions<n> at_nodes(const std::array<int, n>& nodes, const Points& values) {
  Positions<n> picked;
  for (std::size_t v = 0; v < n; ++v) picked[v] = values[cases::index(nodes[v])];
  return picked;
}
inline Points at_nodes(const std::vector<int>& nodes, const Points& values) {
  Points picked;
  picked.reserve(nodes.size());
  for (const int node : nodes) picked.push_back(values[cases::index(node)]);
  return picked;
}

/// Where the nodes of a term are as seen from the first: far from the origin positions have lost digits.
template<class Nodes>
auto seen(const Nodes& nodes, const Points& rest, const Points& displacement) {
  auto x = at_nodes(nodes, rest);
  const auto moved = at_nodes(nodes, displacement);
  for (std::size_t v = x.size(); v-- > 0;) x[v] = (x[v] - x[0]) + (moved[v] - moved[0]);
  return x;
}

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
