#include "fem_reference/load_path.hpp"

#include "scenes.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

using namespace fem_reference;
using cases::Element;

namespace {

/// The state of a scene under prescribed displacements and body forces.
struct Solved {
  Formulation formulation;
  Discretisation discretisation;
  Equilibrium equilibrium;
  State state;

  Solved(const cases::Scene& scene, const Prescribed& prescribed)
      : formulation(make_formulation(scene.definition.fem, scene.definition.material)),
        discretisation(scene, element_type(scene.definition.fem, formulation), prescribed, MPI_COMM_WORLD),
        equilibrium(discretisation, formulation), state(equilibrium.rest()) {
    LinearSolver solver(discretisation, formulation.symmetry);
    carry_load(equilibrium, solver, state);
  }

  /// Largest distance of a node's displacement from a given field, mm.
  double largest_error(const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& exact) const {
    double largest = 0;
    const PetscScalar* values = nullptr;
    check(VecGetArrayRead(state.displacement.get(), &values));
    for (std::size_t n = 0; n < static_cast<std::size_t>(discretisation.n_owned_nodes); ++n)
      largest = std::max(
          largest,
          (Eigen::Map<const Eigen::Vector3d>(values + 3 * n) - exact(discretisation.node_point[n])).norm());
    check(VecRestoreArrayRead(state.displacement.get(), &values));
    return largest;
  }
};

} // namespace

TEST_CASE("a linear displacement of the surface of distorted hexahedra is linear inside", "[verification]") {
  const Element element =
      GENERATE(Element::q1, Element::q1_bbar, Element::q1_p0, Element::q2, Element::q2_p1);
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

TEST_CASE("an unsupported cell of rest shape has six motions without force and no more", "[verification]") {
  const Element element =
      GENERATE(Element::q1, Element::q1_bbar, Element::q1_p0, Element::q2, Element::q2_p1);
  const auto scene = scenes::distorted_box(1, scenes::Surface::free, scenes::thesis_elastic(),
                                           cases::Formulation::small_strain, element);
  const Formulation formulation = make_formulation(scene.definition.fem, scene.definition.material);
  const Discretisation discretisation(scene, element_type(scene.definition.fem, formulation), {},
                                      MPI_COMM_WORLD);
  CellKernel kernel(discretisation.element, formulation);
  const std::vector<double> rest(3 * static_cast<std::size_t>(discretisation.nodes_per_cell), 0.),
      pressure(4, 0.);
  const CellResult& cell =
      kernel.evaluate(discretisation.geometry(0), rest.data(), pressure.data(), Wanted::stress_and_tangent);
  const auto n = static_cast<Eigen::Index>(rest.size());
  const Eigen::MatrixXd stiffness = Eigen::Map<const Eigen::MatrixXd>(cell.tangent.data(), n, n);
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness).eigenvalues();
  CAPTURE(cases::name_of(element), eigenvalues.head(8).transpose());
  const double largest = eigenvalues(n - 1);
  CHECK(eigenvalues.head(6).cwiseAbs().maxCoeff() <= 1e-13 * largest); // rounding error of n additions
  CHECK(eigenvalues(6) >= 1e-3 * largest); // the softest strain of a unit cube, nu = 0.35
}
