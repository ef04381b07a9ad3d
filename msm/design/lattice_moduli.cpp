#include "msm/design/lattice_moduli.hpp"

#include "msm/design/linear_method.hpp"

namespace springproof::msm {

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

} // namespace

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

} // namespace springproof::msm
