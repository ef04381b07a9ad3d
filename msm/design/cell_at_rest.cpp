#include "msm/design/cell_at_rest.hpp"

#include "mechanics/larger.hpp"
#include "msm/tangent.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace springproof::msm {

namespace {

/// @param matrix  24x24, N/mm
Elasticity affine_elasticity(const CellMatrix& matrix, const CellVertices& vertices) {
  static constexpr int axes[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  // Columns: the displacement u = e x at the vertices, e symmetric with unit engineering strain in one
  // component.
  Eigen::Matrix<double, 24, 6> strains;
  for (int c = 0; c < 6; ++c) {
    const auto& [i, j] = axes[c];
    Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
    strain(i, j) += 0.5;
    strain(j, i) += 0.5;
    for (int v = 0; v < 8; ++v)
      strains.block<3, 1>(3 * v, c) = strain * vertices[static_cast<std::size_t>(v)];
  }
  return strains.transpose() * matrix * strains / cases::cell_volume(vertices);
}

/// Constants by axis: E along x, y, z, G between them (yz, xz, xy), nu as the strain along the second axis
/// where the first is stretched: xy, xz, yx, yz, zx, zy.
struct Constants {
  std::array<double, 3> youngs_modulus, shear_modulus;
  std::array<double, 6> poissons_ratio;
};

Constants constants_of(const Elasticity& elasticity) {
  const Elasticity compliance = elasticity.inverse();
  Constants found{};
  std::size_t n = 0;
  for (int i = 0; i < 3; ++i) {
    found.youngs_modulus[static_cast<std::size_t>(i)] = 1 / compliance(i, i);
    found.shear_modulus[static_cast<std::size_t>(i)] = 1 / compliance(3 + i, 3 + i);
    for (int j = 0; j < 3; ++j)
      if (j != i) found.poissons_ratio[n++] = -compliance(j, i) / compliance(i, i);
  }
  return found;
}

/// One number where they all print alike.
template<std::size_t n>
std::string numbers_text(const std::array<double, n>& values) {
  std::vector<std::string> texts;
  for (const double value : values)
    texts.push_back(fmt::format("{:.3g}", std::abs(value) < 5e-4 ? 0. : value));
  const bool are_alike =
      std::all_of(texts.begin(), texts.end(), [&](const auto& t) { return t == texts[0]; });
  return are_alike ? texts[0] : fmt::format("({})", fmt::join(texts, ", "));
}

std::string constants_text(const Constants& c) {
  return fmt::format("E {} MPa, nu {}, G {} MPa", numbers_text(c.youngs_modulus),
                     numbers_text(c.poissons_ratio), numbers_text(c.shear_modulus));
}

} // namespace

CellVertices cube(double edge) {
  CellVertices vertices;
  for (int v = 0; v < 8; ++v)
    vertices[static_cast<std::size_t>(v)] = edge * Eigen::Vector3d(v & 1, (v >> 1) & 1, (v >> 2) & 1);
  return vertices;
}

double cube_edge(const CellVertices& vertices) {
  const double edge = (vertices[1] - vertices[0]).norm();
  const CellVertices ideal = cube(edge);
  for (std::size_t v = 1; v < 8; ++v)
    if (!((vertices[v] - vertices[0] - ideal[v]).norm() <= 1e-9 * edge)) return 0;
  return edge;
}

CellMatrix cell_stiffness_matrix(const CellVertices& vertices, const CellTerms& terms) {
  const Lattice lattice = cell_lattice(terms, vertices);
  CellMatrix matrix = CellMatrix::Zero();
  visit_tangent_blocks(lattice, lattice.rest, TransverseTerm::exact,
                       [&](int row, int column, const Eigen::Matrix3d& block) {
                         matrix.block<3, 3>(3 * row, 3 * column) += block;
                         if (row != column) matrix.block<3, 3>(3 * column, 3 * row) += block.transpose();
                       });
  return matrix;
}

LatticeModuli cubic_moduli(double c11, double c12, double c44) {
  return {c11, c12, c44, 2 * c44 / (c11 - c12), c11 - 2 * c12 * c12 / (c11 + c12), c12 / (c11 + c12), c44};
}

LatticeModuli lattice_moduli(const CellStiffness& stiffness, double edge) {
  const double edges = 4 * stiffness.edge;
  const double face_diagonals = 2 * stiffness.face_diagonal;
  const double internal_diagonals = 4 * stiffness.internal_diagonal / 3;
  const double c44 = (face_diagonals + internal_diagonals) / edge;
  const double c11 = (edges + 2 * face_diagonals + internal_diagonals) / edge + stiffness.volume;
  return cubic_moduli(c11, c44 + stiffness.volume, c44);
}

Elasticity cell_elasticity(const std::vector<CellTerms>& kinds, const CellVertices& vertices) {
  Elasticity sum = Elasticity::Zero();
  for (const CellTerms& kind : kinds)
    sum += affine_elasticity(cell_stiffness_matrix(vertices, kind), vertices);
  return sum / static_cast<double>(kinds.size());
}

LatticeModuli averaged_moduli(const Elasticity& elasticity) {
  return cubic_moduli(elasticity.diagonal().head<3>().mean(),
                      (elasticity(0, 1) + elasticity(1, 2) + elasticity(0, 2)) / 3,
                      elasticity.diagonal().tail<3>().mean());
}

Signs signs_at_rest(const CellMatrix& matrix) {
  const auto eigenvalues =
      Eigen::SelfAdjointEigenSolver<CellMatrix>(matrix, Eigen::EigenvaluesOnly).eigenvalues().eval();
  // Far above round-off, far below any spring's share.
  const double zero = 1e-9 * eigenvalues.cwiseAbs().maxCoeff();
  return {(eigenvalues.array() < -zero).count(), (eigenvalues.array().abs() <= zero).count()};
}

std::vector<std::string> examine(const CellTerms& terms, const CellVertices& vertices) {
  std::array<std::pair<std::string, std::vector<double>>, 4> parts{{{"edge springs k_e", {}},
                                                                    {"face diagonals k_f", {}},
                                                                    {"internal diagonals k_d", {}},
                                                                    {"volume term k_v", {terms.volume}}}};
  for (const CellSpring& spring : terms.springs)
    parts[cases::index(n_axes(spring) - 1)].second.push_back(spring.stiffness);
  std::vector<std::string> warnings;
  for (const auto& [name, values] : parts) {
    if (!std::all_of(values.begin(), values.end(), [](double k) { return std::isfinite(k); }))
      return {name + ": the stiffness is not a finite number"};
    if (std::any_of(values.begin(), values.end(), [](double k) { return k < 0; }))
      warnings.push_back(name + ": the stiffness is negative");
  }
  const auto [n_negative, n_zero] = signs_at_rest(cell_stiffness_matrix(vertices, terms));
  if (n_negative > 0)
    warnings.push_back(
        fmt::format("the cell's tangent at rest is indefinite: {} negative eigenvalues", n_negative));
  if (n_zero > 6)
    warnings.push_back(
        fmt::format("the cell is a mechanism: {} zero-energy modes besides the rigid motions", n_zero - 6));
  return warnings;
}

ModuliMisfit moduli_misfit(const Elasticity& lattice, const Elasticity& material) {
  const Constants wanted = constants_of(material);
  const Eigen::SelfAdjointEigenSolver<Elasticity> solver(lattice, Eigen::EigenvaluesOnly);
  const double least = solver.eigenvalues().minCoeff(), most = solver.eigenvalues().maxCoeff();
  if (!(least > 1e-9 * most))
    return {std::numeric_limits<double>::infinity(),
            fmt::format("some strain of the lattice at rest costs no energy, where the material has {}",
                        constants_text(wanted))};
  const Constants found = constants_of(lattice);
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (const auto& [of, as] : {std::pair(found.youngs_modulus[i], wanted.youngs_modulus[i]),
                                 {found.shear_modulus[i], wanted.shear_modulus[i]}})
      largest = mechanics::larger(largest, std::abs(of / as - 1));
  for (std::size_t i = 0; i < 6; ++i)
    largest = mechanics::larger(largest, std::abs(found.poissons_ratio[i] - wanted.poissons_ratio[i]));
  return {largest,
          fmt::format("the lattice's moduli are not the material's: {} along its axes, where the material "
                      "has {}",
                      constants_text(found), constants_text(wanted))};
}

} // namespace springproof::msm
