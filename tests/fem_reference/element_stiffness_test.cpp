#include "fem_reference/element_stiffness.hpp"

#include "cases/case/error.hpp"
#include "cases/mesh/mesh.hpp"
#include "mechanics/dense.hpp"
#include "tests/support/largest.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace springproof;

namespace {

using cases::Element;
using Displacement = Eigen::Matrix<double, 24, 1>;
using Vertices = std::array<Eigen::Vector3d, 8>;

const cases::LinearElastic hooke = {0.3, 0.35};

Vertices distorted() {
  Vertices vertices;
  for (int v = 0; v < 8; ++v) {
    const double s = v;
    vertices[static_cast<std::size_t>(v)] =
        1.5 * Eigen::Vector3d(v & 1, (v >> 1) & 1, (v >> 2) & 1) +
        0.15 * Eigen::Vector3d(std::sin(3 * s), std::cos(5 * s), std::sin(7 * s + 1));
  }
  return vertices;
}

Displacement affine(const Vertices& vertices, const Eigen::Matrix3d& gradient) {
  Displacement u;
  for (int v = 0; v < 8; ++v) u.segment<3>(3 * v) = gradient * vertices[static_cast<std::size_t>(v)];
  return u;
}

double volume(const Vertices& vertices) {
  return cases::cell_volume({vertices.begin(), vertices.end()});
}

} // namespace

TEST_CASE("a linear displacement of a distorted element stores the exact strain energy", "[verification]") {
  const Element element = GENERATE(Element::q1, Element::q1_bbar);
  const Vertices vertices = distorted();
  Eigen::Matrix3d strain;
  strain << 0.3, 0.1, -0.2, 0.1, -0.4, 0.25, -0.2, 0.25, 0.15;
  const double lambda = 0.3 * 0.35 / (1.35 * 0.3), mu = 0.3 / 2.7;
  const double exact =
      (lambda * std::pow(strain.trace(), 2) + 2 * mu * strain.squaredNorm()) * volume(vertices);
  const Displacement u = affine(vertices, strain);
  const double energy = u.dot(fem_reference::element_stiffness(vertices, hooke, element) * u);
  CHECK(energy == Approx(exact).epsilon(1e-13)); // 2x2x2 Gauss is exact here: round-off remains
}

TEST_CASE("an element has six zero-energy modes and no more", "[verification]") {
  const Element element = GENERATE(Element::q1, Element::q1_bbar);
  const auto stiffness = fem_reference::element_stiffness(distorted(), hooke, element);
  CHECK((stiffness - stiffness.transpose()).norm() <= 1e-14 * stiffness.norm()); // round-off of one product
  const Eigen::VectorXd eigenvalues = mechanics::eigenvalues(stiffness);
  const double zero = 1e-12 * eigenvalues(23); // round-off of a dense 24x24 eigenproblem
  CHECK(largest_entry(eigenvalues.head<6>()) <= zero);
  CHECK(eigenvalues(6) > 1e-3 * eigenvalues(23)); // a deformation costs a visible share of the stiffest one
}

TEST_CASE("B-bar leaves the deviatoric stiffness alone and softens a bending mode at nu near a half",
          "[verification]") {
  Vertices cube;
  for (int v = 0; v < 8; ++v)
    cube[static_cast<std::size_t>(v)] = Eigen::Vector3d(v & 1, (v >> 1) & 1, (v >> 2) & 1);
  const cases::LinearElastic stiff_volume = {1, 0.4999};
  Displacement bending =
      Displacement::Zero(); // u_x = (2x - 1)(2z - 1): dilatation of opposite sign above and below
  for (int v = 0; v < 8; ++v) bending(3 * v) = (v & 1 ? 1 : -1) * (v & 4 ? 1 : -1);
  const auto energy = [&](const cases::LinearElastic& m, Element element) {
    return bending.dot(fem_reference::element_stiffness(cube, m, element) * bending);
  };
  CHECK(energy(stiff_volume, Element::q1) > 500 * energy(stiff_volume, Element::q1_bbar));
  // There is no volumetric energy for B-bar to change at zero bulk modulus.
  const double deviatoric = energy({1, -0.999999999}, Element::q1);
  CHECK(energy({1, -0.999999999}, Element::q1_bbar) == Approx(deviatoric).epsilon(1e-8)); // kappa/mu = 1e-9
}

TEST_CASE("an element's stiffness refuses what has no meaning") {
  CHECK_THROWS_AS(fem_reference::element_stiffness(distorted(), hooke, Element::q2), cases::InputError);
  CHECK_THROWS_AS(fem_reference::element_stiffness(distorted(), {0.3, 0.5}, Element::q1), cases::InputError);
  CHECK_THROWS_AS(fem_reference::element_stiffness(distorted(), {0.3, std::nan("")}, Element::q1),
                  cases::InputError);
  Vertices inverted = distorted();
  std::swap(inverted[0], inverted[1]);
  std::swap(inverted[2], inverted[3]);
  std::swap(inverted[4], inverted[5]);
  std::swap(inverted[6], inverted[7]);
  CHECK_THROWS_AS(fem_reference::element_stiffness(inverted, hooke, Element::q1), cases::InputError);
}
