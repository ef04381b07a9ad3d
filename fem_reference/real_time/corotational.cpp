#include "fem_reference/real_time/vertex_elements.hpp"

#include <Eigen/SVD>
#include <memory>
#include <vector>

namespace springproof::fem_reference {

namespace {

/// The rotation nearest to a matrix.
Matrix3 rotation_of(const Matrix3& f) {
  const Eigen::JacobiSVD<Matrix3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 left = svd.matrixU();
  if ((left * svd.matrixV().transpose()).determinant() < 0) left.col(2) *= -1;
  return left * svd.matrixV().transpose();
}

} // namespace

MakeCellLaw corotational_law(const RestCells& cells, cases::Element element) {
  const std::vector<cases::Material> materials = cases::materials_of(cells.scene().definition);
  const std::size_t n_materials = materials.size();
  const bool is_by_cell = cells.n_shapes() > 1;
  std::vector<Eigen::MatrixXd> of_cells; // by shape and material; a cell with a shape of its own has one
  for (std::size_t shape = 0; shape < cells.n_shapes(); ++shape)
    for (std::size_t m = 0; m < (is_by_cell ? 1 : n_materials); ++m) {
      const std::size_t own = is_by_cell ? cases::index(cases::material_of(cells.scene(), shape)) : m;
      of_cells.push_back(
          stiffness_of(cells.shape(shape), std::get<cases::LinearElastic>(materials[own]), element));
    }
  const auto stiffness = std::make_shared<std::vector<Eigen::MatrixXd>>(std::move(of_cells));
  return [&cells, stiffness, is_by_cell]() -> CellLaw {
    return [&cells, stiffness, is_by_cell](std::size_t cell, const CellVector& displacement, Wanted wanted,
                                           CellForces& found) {
      using Row = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 8>;
      const Eigen::Index n = displacement.size() / 3;
      const Eigen::MatrixXd& k =
          (*stiffness)[is_by_cell ? cell : cases::index(cases::material_of(cells.scene(), cell))];
      const cases::ShapeGradients& gradients = cells.shape(cell).mean_gradients();
      const Row u = Eigen::Map<const Row>(displacement.data(), 3, n);
      const Matrix3 turn = rotation_of(Matrix3::Identity() + u * gradients.transpose());
      // R^T x - X = R^T u + (R^T - I) X about the first vertex: K knows no translation.
      const cases::CellNodes nodes = cells.scene().mesh.cells[cell];
      Row rest(3, n), turned(3, n);
      for (Eigen::Index a = 0; a < n; ++a)
        rest.col(a) = cells.scene().mesh.nodes[cases::index(nodes[std::size_t(a)])] -
                      cells.scene().mesh.nodes[cases::index(nodes[0])];
      turned = turn.transpose() * u + (turn.transpose() - Matrix3::Identity()) * rest;
      const CellVector force = -k * Eigen::Map<const CellVector>(turned.data(), 3 * n);
      turned = turn * Eigen::Map<const Row>(force.data(), 3, n);
      found.force = Eigen::Map<const CellVector>(turned.data(), 3 * n);
      if (wanted == Wanted::stress) return true;
      found.tangent.resize(3 * n, 3 * n);
      for (Eigen::Index a = 0; a < n; ++a)
        for (Eigen::Index b = 0; b < n; ++b)
          found.tangent.block<3, 3>(3 * a, 3 * b) = turn * k.block<3, 3>(3 * a, 3 * b) * turn.transpose();
      return true;
    };
  };
}

} // namespace springproof::fem_reference
