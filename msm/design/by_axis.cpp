#include "msm/design/by_axis.hpp"

#include "mechanics/dense.hpp"
#include "msm/design/minimise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace springproof::msm {

using Eigen::Vector3d;

namespace {

/// c11, c12, c13, c33, c44, c66.
using ModuliVector = Eigen::Matrix<double, 6, 1>;
/// Elasticity in an orthonormal basis of the strains (Mandel's: shear strains times sqrt(2)).
using Mandel = Eigen::Matrix<double, 6, 6>;

Mandel elasticity(const ModuliVector& c) {
  Mandel result = Mandel::Zero();
  result.topLeftCorner<3, 3>() << c[0], c[1], c[2], c[1], c[0], c[2], c[2], c[2], c[3];
  result.diagonal().tail<3>() << 2 * c[4], 2 * c[4], 2 * c[5];
  return result;
}

/// Least part of c44 that each kind of spring carries: a lattice whose face diagonals or edges carry nothing
/// has waves without energy.
constexpr double least_part = 0.05;

/// Weight of the split: energies of uniform strains leave one of a box's seven stiffnesses free.
constexpr double split_weight = 0.01;

/// Mean edges along the cell's own axes, mm.
Vector3d mean_edges(const CellVertices& x) {
  Vector3d edges = Vector3d::Zero();
  for (std::size_t v = 0; v < 8; ++v)
    for (int axis = 0; axis < 3; ++axis)
      if (((v >> axis) & 1U) == 0) edges[axis] += (x[v + (1U << axis)] - x[v]).norm() / 4;
  return edges;
}

/// Whether a cell is a box along the axes, to 1e-9 of its edges.
bool is_box(const CellVertices& x) {
  const Vector3d edges = mean_edges(x);
  for (std::size_t v = 1; v < 8; ++v) {
    const Vector3d ideal((v & 1U) != 0 ? edges[0] : 0, (v & 2U) != 0 ? edges[1] : 0,
                         (v & 4U) != 0 ? edges[2] : 0);
    if (!((x[v] - x[0] - ideal).norm() <= 1e-9 * edges.norm())) return false;
  }
  return true;
}

Elasticity elasticity_of(const CubicModuli& moduli) {
  Elasticity c = Elasticity::Zero();
  c.topLeftCorner<3, 3>().setConstant(moduli.c44 + moduli.volume);
  c.diagonal() << Vector3d::Constant(moduli.c11 + moduli.volume), Vector3d::Constant(moduli.c44);
  return c;
}

/// The two axes of the faces across an axis.
std::array<int, 2> axes_across(int axis) {
  return {(axis + 1) % 3, (axis + 2) % 3};
}

/// Stiffness of every kind that carries 1 MPa: edges C_ii, face diagonals and internal diagonals the shear
/// modulus, the latter in the largest face.
std::array<double, 7> unit_stiffness(const Vector3d& l) {
  const double volume = l.prod(), largest_face = (volume / l.array()).maxCoeff();
  std::array<double, 7> unit{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto [i, j] = axes_across(axis);
    unit[static_cast<std::size_t>(axis)] = volume / (4 * l[axis] * l[axis]);
    unit[static_cast<std::size_t>(3 + axis)] =
        (l[i] * l[i] + l[j] * l[j]) * volume / (4 * l[i] * l[i] * l[j] * l[j]);
  }
  unit[6] = l.squaredNorm() * volume / (4 * largest_face * largest_face);
  return unit;
}

Elasticity elasticity_by_axis(const AxisStiffness& k, const CellVertices& vertices) {
  return cell_elasticity({terms_by_axis(k)}, vertices);
}

/// Returns an elasticity in Mandel's orthonormal basis of the strains.
Elasticity in_mandel(Elasticity c) {
  c.bottomRows<3>() *= std::sqrt(2.);
  c.rightCols<3>() *= std::sqrt(2.);
  return c;
}

} // namespace

std::optional<AxisStiffness> exact_by_axis(const CubicModuli& moduli, double split,
                                           const CellVertices& vertices) {
  const Vector3d l = mean_edges(vertices), squared = l.array().square();
  if (!is_box(vertices)) return std::nullopt;
  const double largest_face = (l.prod() / l.array()).maxCoeff(), least = least_part * moduli.c44;
  // 4 k_e l_i²/V = c11 - c44 sum l_i²/l_j² + t c44 l_i⁴/largest face²
  const auto without_part = [&](int axis) {
    const auto [i, j] = axes_across(axis);
    return moduli.c11 - moduli.c44 * squared[axis] * (1 / squared[i] + 1 / squared[j]);
  };
  double part = split;
  for (int axis = 0; axis < 3; ++axis) {
    const double by_part = moduli.c44 * std::pow(squared[axis] / largest_face, 2);
    part = std::max(part, (least - without_part(axis)) / by_part);
  }
  if (part > std::max(split, 1 - least_part)) return std::nullopt;
  const double d = part * moduli.c44 / (largest_face * largest_face);
  const std::array<double, 7> unit = unit_stiffness(l);
  AxisStiffness result{{}, moduli.volume};
  for (int axis = 0; axis < 3; ++axis) {
    const auto [i, j] = axes_across(axis);
    const auto n = static_cast<std::size_t>(axis);
    result.springs[n] = (without_part(axis) + d * squared[axis] * squared[axis]) * unit[n];
    result.springs[3 + n] = (moduli.c44 - d * squared[i] * squared[j]) * unit[3 + n];
  }
  result.springs[6] = part * moduli.c44 * unit[6];
  return result;
}

AxisStiffness nearest_by_axis(const CubicModuli& moduli, double split, const CellVertices& vertices) {
  const Elasticity target = elasticity_of(moduli);
  const Elasticity root = mechanics::inverse_square_root(in_mandel(target));
  const auto relative = [&](const Elasticity& c) -> Elasticity { return root * in_mandel(c) * root; };
  const Vector3d l = mean_edges(vertices);
  const std::array<double, 7> unit = unit_stiffness(l);
  // What every kind has at least; a face diagonal stiffens the face's longer edge by the square of their
  // ratio.
  AxisStiffness result{{}, moduli.volume};
  for (int axis = 0; axis < 3; ++axis) {
    const auto [i, j] = axes_across(axis);
    const double ratio = std::min(l[i], l[j]) / std::max(l[i], l[j]);
    const auto n = static_cast<std::size_t>(axis);
    result.springs[n] = least_part * moduli.c44 * unit[n];
    result.springs[3 + n] = least_part * moduli.c44 * ratio * ratio * unit[3 + n];
  }
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(37, 7);
  for (std::size_t n = 0; n < 7; ++n) {
    AxisStiffness one{{}, 0};
    one.springs[n] = moduli.c44 * unit[n];
    columns.col(static_cast<Eigen::Index>(n)).head<36>() =
        relative(elasticity_by_axis(one, vertices)).reshaped();
  }
  columns(36, 6) = split_weight;
  Eigen::VectorXd missing(37);
  missing << relative(target - elasticity_by_axis(result, vertices)).reshaped(), split_weight * split;
  const Eigen::VectorXd parts = nonnegative_least_squares(columns, missing);
  for (std::size_t n = 0; n < 7; ++n)
    result.springs[n] += parts[static_cast<Eigen::Index>(n)] * moduli.c44 * unit[n];
  return result;
}

std::optional<AxisStiffness> by_axis_where_needed(const CellStiffness& four, const CubicModuli& moduli,
                                                  double split, const CellVertices& vertices) {
  if (cube_edge(vertices) > 0) return std::nullopt;
  if (auto exact = exact_by_axis(moduli, split, vertices)) return exact;
  if (!is_box(vertices) &&
      moduli_misfit(cell_elasticity(four, vertices), elasticity_of(moduli)).largest <= told_moduli_misfit)
    return std::nullopt;
  return nearest_by_axis(moduli, split, vertices);
}

NearestModuli nearest_lattice_moduli(const mechanics::TransverseModuli& m) {
  ModuliVector material, relation; // a lattice has relation . moduli = 0
  material << m.c11, m.c12, m.c13, m.c33, m.c44, m.c66;
  relation << 0, 1, -1, 0, 1, -1;
  const Mandel root = mechanics::inverse_square_root(elasticity(material));
  Eigen::Matrix<double, 36, 6>
      relative; // columns: what a unit of each modulus adds to C^-1/2 C_lattice C^-1/2
  for (int c = 0; c < 6; ++c) relative.col(c) = (root * elasticity(ModuliVector::Unit(c)) * root).reshaped();
  // least |relative change|² with relation . (material + change) = 0
  const Mandel normal = relative.transpose() * relative;
  const ModuliVector towards = mechanics::solved(normal, relation);
  const ModuliVector change = -relation.dot(material) / relation.dot(towards) * towards;
  const ModuliVector c = material + change;
  const Mandel errors = root * elasticity(change) * root;
  NearestModuli nearest{{c[0], c[1], c[2], c[3], c[4], c[5], 0}, errors.norm(), 0};
  nearest.moduli.bulk_modulus =
      1 / mechanics::solved(elasticity(c).topLeftCorner(3, 3), Eigen::Vector3d::Ones()).sum();
  nearest.misfit = mechanics::eigenvalues(errors).cwiseAbs().maxCoeff();
  return nearest;
}

AxisStiffness stiffness_by_axis(const mechanics::TransverseModuli& c, double split, int fibre, double edge) {
  const double volume = c.c13 - c.c44, internal = split * std::min(c.c44, c.c66);
  AxisStiffness result{};
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_fibre = axis == fibre;
    const double whole_edge =
        is_fibre ? c.c33 - volume - 2 * c.c44 + internal : c.c11 - volume - c.c66 - c.c44 + internal;
    result.springs[static_cast<std::size_t>(axis)] = edge * whole_edge / 4;
    result.springs[static_cast<std::size_t>(3 + axis)] = edge * ((is_fibre ? c.c66 : c.c44) - internal) / 2;
  }
  result.springs[6] = edge * 3 * internal / 4;
  result.volume = volume;
  return result;
}

} // namespace springproof::msm
