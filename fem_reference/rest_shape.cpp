#include "fem_reference/rest_shape.hpp"

#include "cases/case/error.hpp"
#include "fem_reference/law_kernel.hpp"
#include "mechanics/hexahedron.hpp"

#include <Eigen/LU>
#include <string>

namespace springproof::fem_reference {

RestShape::RestShape(const cases::CellCorners& corners) : n_nodes_(static_cast<int>(corners.size())) {
  const cases::CellShape shape = cases::shape_of(corners.size());
  const bool is_hexahedron = shape == cases::CellShape::hexahedron;
  const int n_points = is_hexahedron ? 8 : 1;
  mean_gradients_ = cases::ShapeGradients::Zero(3, n_nodes_);
  for (int q = 0; q < n_points; ++q) {
    const Eigen::Vector3d at = is_hexahedron ? mechanics::gauss_point(q) : Eigen::Vector3d::Constant(0.25);
    const Eigen::Matrix3d jacobian = cases::jacobian(corners, at);
    weights_.push_back(jacobian.determinant() * cases::reference_cell(shape).volume / n_points);
    if (!(weights_.back() > 0))
      throw cases::InputError("the cell is inverted or degenerate: its Jacobian determinant is " +
                              std::to_string(weights_.back()) + " mm³ at a Gauss point; it must be positive");
    const Eigen::Matrix<double, 3, Eigen::Dynamic> gradients =
        jacobian.inverse().transpose() * cases::shape_gradients(shape, at);
    for (int j = 0; j < 3; ++j)
      for (int a = 0; a < n_nodes_; ++a) gradients_.push_back(gradients(j, a));
    volume_ += weights_.back();
    mean_gradients_ += weights_.back() * gradients;
  }
  mean_gradients_ /= volume_;
  modes_.assign(weights_.size(), 1);
}

CellGeometry RestShape::geometry() const {
  return {n_nodes_,          n_nodes_,        static_cast<int>(weights_.size()),
          gradients_.data(), weights_.data(), modes_.data()};
}

Eigen::MatrixXd stiffness_of(const RestShape& shape, const cases::LinearElastic& material,
                             cases::Element element) {
  cases::Fem fem;
  fem.element = element;
  LawKernel<SmallStrain> kernel(element_type(fem, SmallStrain::traits), SmallStrain(material));
  const int n = shape.n_nodes();
  const std::vector<double> rest(static_cast<std::size_t>(3 * n));
  const RowMajorMatrix& tangent =
      kernel.evaluate(shape.geometry(), rest.data(), rest.data(), Wanted::stress_and_tangent).tangent;
  Eigen::MatrixXd stiffness(3 * n, 3 * n);
  for (int row = 0; row < 3 * n; ++row) // the kernel numbers degrees of freedom i*n + a
    for (int column = 0; column < 3 * n; ++column)
      stiffness(3 * (row % n) + row / n, 3 * (column % n) + column / n) = tangent(row, column);
  return stiffness;
}

} // namespace springproof::fem_reference
