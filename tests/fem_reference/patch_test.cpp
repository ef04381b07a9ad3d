#include "mechanics/dense.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "scenes.hpp"
#include "solved.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace fem_reference;
using cases::Element;

TEST_CASE("a linear displacement of the surface of distorted cells is linear inside", "[verification]") {
  const Element element =
      GENERATE(from_range(std::begin(scenes::all_elements), std::end(scenes::all_elements)));
  const auto scene = scenes::distorted_box(3, scenes::Surface::fixed, scenes::thesis_elastic(),
                                           cases::Formulation::small_strain, element);
  Eigen::Matrix3d gradient;
  gradient << 0.010, 0.003, -0.002, 0.004, -0.006, 0.001, 0.002, -0.005, 0.008;
  const auto field = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return gradient * x; };
  const Solved solved(scene, {nullptr, field});
  CAPTURE(cases::name_of(element));
  CHECK(solved.largest_error(field) <=
        1e-10); // rounding error of the solve; the field itself is of the order 1e-2 mm
}

TEST_CASE("quadratic cells hold a quadratic displacement exactly, however they are distorted",
          "[verification]") {
  const Element element = GENERATE(Element::q2, Element::q2_p1, Element::p2, Element::p2_p1);
  const auto scene = scenes::distorted_box(3, scenes::Surface::fixed, scenes::thesis_elastic(),
                                           cases::Formulation::small_strain, element);
  const auto [lambda, mu, kappa] = mechanics::elastic_moduli(scenes::thesis_elastic());
  const auto field = [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return 0.01 * Eigen::Vector3d(x.x() * x.y() + x.z() * x.z(), x.x() * x.x() - x.y() * x.z(),
                                  x.y() * x.y() + 2 * x.x() * x.z());
  };
  // -(lambda + mu) grad div u - mu laplace u, with div u = 0.01 (2 x + y - z) and laplace u = 0.01 (2, 2, 2)
  const Eigen::Vector3d force =
      -0.01 * ((lambda + mu) * Eigen::Vector3d(2, 1, -1) + mu * Eigen::Vector3d(2, 2, 2));
  const Solved solved(scene, {[&](const Eigen::Vector3d&) { return force; }, field});
  CAPTURE(cases::name_of(element));
  CHECK(solved.largest_error(field) <=
        1e-12); // rounding error of the solve; the field is of the order 1e-2 mm
}

TEST_CASE("an unsupported cell of rest shape has six motions without force, with p2_p0 three inversions, and "
          "no more",
          "[verification]") {
  const Element element =
      GENERATE(from_range(std::begin(scenes::all_elements), std::end(scenes::all_elements)));
  const auto scene = scenes::distorted_box(1, scenes::Surface::free, scenes::thesis_elastic(),
                                           cases::Formulation::small_strain, element);
  const Formulation formulation = make_formulation(scene.definition.fem, scene.definition.material);
  const Discretisation discretisation(scene, element_type(scene.definition.fem, formulation), MPI_COMM_WORLD);
  const auto kernel = formulation.make_kernel(discretisation.element);
  const std::vector<double> rest(3 * static_cast<std::size_t>(discretisation.nodes.per_cell), 0.),
      internal(9, 0.);
  const CellResult& cell = kernel->evaluate(discretisation.geometry.of(0), rest.data(), internal.data(),
                                            Wanted::stress_and_tangent);
  const auto n = static_cast<Eigen::Index>(rest.size());
  const Eigen::MatrixXd stiffness = condensed_tangent(cell);
  const Eigen::VectorXd eigenvalues = mechanics::eigenvalues(stiffness);
  CAPTURE(cases::name_of(element), eigenvalues.head(10).transpose());
  const double largest = eigenvalues(n - 1);
  // Inversions x -> 2 (b . x) x - |x|² b have neither shear nor, in the mean, a change of volume.
  const int n_motions = element == Element::p2_p0 ? 9 : 6;
  CHECK(largest_entry(eigenvalues.head(n_motions)) <= 1e-13 * largest); // rounding error of n additions
  CHECK(eigenvalues(n_motions) >= 1e-3 * largest); // the softest strain of a unit cube, nu = 0.35
}
