#include "fem_reference/element_stiffness.hpp"

#include "cases/case/error.hpp"
#include "fem_reference/law_kernel.hpp"
#include "mechanics/hexahedron.hpp"

#include <Eigen/LU>
#include <cmath>
#include <string>

namespace springproof::fem_reference {

namespace {

void check_input(const cases::LinearElastic& material, cases::Element element) {
  if (element != cases::Element::q1 && element != cases::Element::q1_bbar)
    throw cases::InputError("element stiffness: the element must be q1 or q1_bbar");
  if (!(material.youngs_modulus > 0) || !std::isfinite(material.youngs_modulus))
    throw cases::InputError("youngs_modulus: must be positive and finite");
  if (!(material.poissons_ratio > -1 && material.poissons_ratio < 0.5))
    throw cases::InputError("poissons_ratio: must lie in (-1, 0.5), where the elasticity matrix is finite");
}

} // namespace

ElementStiffness element_stiffness(const std::array<Eigen::Vector3d, 8>& vertices,
                                   const cases::LinearElastic& material, cases::Element element) {
  check_input(material, element);
  Eigen::Matrix<double, 8, 24> gradients; // column 3*point + direction
  Eigen::Matrix<double, 8, 1> weights;
  for (int q = 0; q < 8; ++q) {
    const Eigen::Vector3d at = mechanics::gauss_point(q);
    const Eigen::Matrix3d jacobian = mechanics::jacobian(vertices, at);
    weights[q] = jacobian.determinant() / 8;
    if (!(weights[q] > 0))
      throw cases::InputError("the cell is inverted or degenerate: its Jacobian determinant is " +
                              std::to_string(weights[q]) + " mm³ at a Gauss point; it must be positive");
    gradients.middleCols<3>(3 * q) = mechanics::shape_gradients(at).transpose() * jacobian.inverse();
  }
  cases::Fem fem;
  fem.element = element;
  LawKernel<SmallStrain> kernel(element_type(fem, SmallStrain::traits), SmallStrain(material));
  const std::array<double, 24> rest{};
  const std::array<double, 8> constant_mode{{1, 1, 1, 1, 1, 1, 1, 1}};
  const CellResult& result =
      kernel.evaluate({8, 8, 8, gradients.data(), weights.data(), constant_mode.data()}, rest.data(),
                      rest.data(), Wanted::stress_and_tangent);
  ElementStiffness stiffness;
  for (int row = 0; row < 24; ++row) // the kernel numbers degrees of freedom i*8 + a
    for (int column = 0; column < 24; ++column)
      stiffness(3 * (row % 8) + row / 8, 3 * (column % 8) + column / 8) = result.tangent(row, column);
  return stiffness;
}

} // namespace springproof::fem_reference
