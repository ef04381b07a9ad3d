#include "fem_reference/element_stiffness.hpp"

#include "cases/case/error.hpp"
#include "fem_reference/rest_shape.hpp"

#include <cmath>

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
  const cases::CellCorners corners(vertices.begin(), vertices.end());
  return stiffness_of(RestShape(corners), material, element);
}

} // namespace springproof::fem_reference
