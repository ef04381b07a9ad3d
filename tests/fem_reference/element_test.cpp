#include "fem_reference/element.hpp"

#include "cases/case/elements.hpp"
#include "fem_reference/discretisation.hpp"
#include "fem_reference/element_stiffness.hpp"
#include "fem_reference/laws/formulation.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "scenes.hpp"
#include "solved.hpp"
#include "tests/support/largest.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

using namespace springproof;

using namespace fem_reference;
using cases::Element;

namespace {

constexpr cases::Formulation all_formulations[] = {
    cases::Formulation::small_strain, cases::Formulation::saint_venant_kirchhoff,
    cases::Formulation::log_strain, cases::Formulation::hyperelastic};

/// One distorted cell of a formulation, and its element loop.
struct OneCell {
  cases::Scene scene;
  Formulation formulation;
  Discretisation discretisation;
  std::unique_ptr<CellKernel> kernel;
  Eigen::VectorXd internal;

  OneCell(cases::Formulation name, Element element, const cases::Material& material)
      : scene(scenes::distorted_box(1, scenes::Surface::free, material, name, element)),
        formulation(make(scene)),
        discretisation(scene, element_type(scene.definition.fem, formulation), MPI_COMM_SELF),
        kernel(formulation.make_kernel(discretisation.element)), internal(Eigen::VectorXd::Zero(9)) {}

  static Formulation make(cases::Scene& scene) {
    for (std::size_t n = 0; n < 8; ++n) // a cell that is no parallelepiped
      scene.mesh.nodes.stored()[n] +=
          0.1 * Eigen::Vector3d(std::sin(5. * double(n)), std::sin(9. * double(n)), std::cos(7. * double(n)));
    return make_formulation(scene.definition.fem, scene.definition.material);
  }
  Eigen::Index n_dofs() const { return 3 * discretisation.nodes.per_cell; }

  /// Displacement of the nodes by a map, plus a little that is no affine map.
  Eigen::VectorXd displacement(const Eigen::Matrix3d& gradient, double roughness) const {
    Eigen::VectorXd u(n_dofs());
    for (int a = 0; a < discretisation.nodes.per_cell; ++a) {
      const int node = discretisation.nodes.of_cell[static_cast<std::size_t>(a)];
      const Eigen::Vector3d x = discretisation.nodes.point[static_cast<std::size_t>(node)];
      u.segment<3>(3 * a) =
          gradient * x + roughness * Eigen::Vector3d(std::sin(3. * a), std::sin(7. * a), std::cos(5. * a));
    }
    return u;
  }
  /// Evaluates at the pressures or bubbles in balance, by Newton's method at fixed displacement.
  const CellResult& balanced(const Eigen::VectorXd& u) {
    for (int i = 0; i < 30; ++i) {
      const CellResult& r = kernel->evaluate(discretisation.geometry.of(0), u.data(), internal.data(),
                                             Wanted::stress_and_tangent);
      REQUIRE(r.valid);
      const Eigen::Index n_vertices = r.force.size() - n_dofs(); // with pressures
      const Eigen::VectorXd volumes = r.force.tail(n_vertices);
      if (r.volume_mismatch <= 1e-15 && r.bubble_imbalance <= 1e-30 && volumes.squaredNorm() <= 1e-31) break;
      if (n_vertices > 0)
        internal.head(n_vertices) -=
            r.tangent.bottomRightCorner(n_vertices, n_vertices).ldlt().solve(volumes);
      else
        internal.head(r.internal_residual.size()) += r.internal_residual;
    }
    return kernel->evaluate(discretisation.geometry.of(0), u.data(), internal.data(),
                            Wanted::stress_and_tangent);
  }
  /// Internal force with its degrees of freedom in the order of the displacement.
  Eigen::VectorXd force(const Eigen::VectorXd& u) {
    const CellResult& r = balanced(u);
    const Eigen::Index n = discretisation.nodes.per_cell;
    Eigen::VectorXd f(n_dofs());
    for (Eigen::Index k = 0; k < n_dofs(); ++k) f(3 * (k % n) + k / n) = r.plain_force[k];
    return f;
  }
  Eigen::MatrixXd tangent(const Eigen::VectorXd& u) {
    const Eigen::MatrixXd condensed = condensed_tangent(balanced(u));
    const Eigen::Index n = discretisation.nodes.per_cell;
    Eigen::MatrixXd k(n_dofs(), n_dofs());
    for (Eigen::Index row = 0; row < n_dofs(); ++row)
      for (Eigen::Index column = 0; column < n_dofs(); ++column)
        k(3 * (row % n) + row / n, 3 * (column % n) + column / n) = condensed(row, column);
    return k;
  }
};

cases::Material material_of(cases::Formulation formulation) {
  if (formulation != cases::Formulation::hyperelastic) return scenes::thesis_elastic();
  return cases::Ogden{
      {0.2, 0.1}, {3.3, -2}, 4.}; // MPa; compressible enough for differences to see everything
}

/// Stiffness of a trilinear cell by K = sum w B^T D B, the volumetric part of B replaced by its mean (Hughes
/// 1980); degree of freedom 3*vertex + component.
Eigen::MatrixXd bbar_stiffness(const CellGeometry& g, const cases::LinearElastic& material) {
  const double mu = material.youngs_modulus / (2 * (1 + material.poissons_ratio));
  const double lambda = 2 * mu * material.poissons_ratio / (1 - 2 * material.poissons_ratio);
  Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero(); // xx, yy, zz, xy, yz, xz
  d.topLeftCorner<3, 3>().setConstant(lambda);
  d.diagonal() << Eigen::Vector3d::Constant(lambda + 2 * mu), Eigen::Vector3d::Constant(mu);
  Eigen::Map<const Eigen::VectorXd> weights(g.weights, 8);
  Eigen::Matrix<double, 3, 8> mean = Eigen::Matrix<double, 3, 8>::Zero();
  const auto gradients = [&](int q) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 8, Eigen::RowMajor>>(g.gradients + 24 * q);
  };
  for (int q = 0; q < 8; ++q) mean += weights[q] / weights.sum() * gradients(q);
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(24, 24);
  for (int q = 0; q < 8; ++q) {
    Eigen::Matrix<double, 6, 24> b = Eigen::Matrix<double, 6, 24>::Zero();
    for (int v = 0; v < 8; ++v) {
      const Eigen::Vector3d own = gradients(q).col(v), change = (mean.col(v) - own) / 3;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        b(i, 3 * v + i) += own[i];
        b(3 + i, 3 * v + i) = own[j]; // shear of i and j
        b(3 + i, 3 * v + j) = own[i];
        b.block<3, 1>(0, 3 * v + i).array() += change[i];
      }
    }
    stiffness += weights[q] * b.transpose() * d * b;
  }
  return stiffness;
}

bool has_meaning(cases::Formulation formulation, Element element) {
  return formulation != cases::Formulation::saint_venant_kirchhoff || !cases::facts_of(element).has_pressure;
}

} // namespace

TEST_CASE("an element's tangent is the derivative of its internal force, its pressure eliminated",
          "[verification]") {
  Eigen::Matrix3d general;
  general << 0.3, 0.1, -0.2, 0.15, -0.2, 0.05, -0.1, 0.2, 0.1;
  const struct {
    Eigen::Matrix3d gradient;
    double roughness;
  } states[] = {{Eigen::Matrix3d::Zero(), 0},                         // rest: all stretches coincide
                {Eigen::Vector3d(0.4, -0.15, -0.15).asDiagonal(), 0}, // uniaxial: two coincide
                {Eigen::Vector3d(0.3, 0.3, -0.4).asDiagonal(), 0},
                {general, 0.02}}; // and neither
  for (const auto formulation : all_formulations)
    for (const auto element : scenes::all_elements) {
      if (!has_meaning(formulation, element)) continue;
      OneCell cell(formulation, element, material_of(formulation));
      for (const auto& state : states) {
        const Eigen::VectorXd u = cell.displacement(state.gradient, state.roughness);
        const Eigen::MatrixXd tangent = cell.tangent(u);
        const double step = 1e-5; // mm: truncation and rounding both near 1e-10 of a cell of 1 mm
        double error = 0;
        for (Eigen::Index k = 0; k < cell.n_dofs(); k += 5) { // 5 has no factor in common with 3
          Eigen::VectorXd forward = u, backward = u;
          forward(k) += step;
          backward(k) -= step;
          error = larger(error,
                         ((cell.force(forward) - cell.force(backward)) / (2 * step) - tangent.col(k)).norm());
        }
        CAPTURE(cases::name_of(formulation), cases::name_of(element), state.gradient);
        CHECK(error <=
              1e-7 * tangent.norm()); // distorted cells magnify the truncation by a factor of about 100
      }
    }
}

TEST_CASE("a cell that is turned after it was deformed turns its forces with it", "[verification]") {
  Eigen::Matrix3d gradient;
  gradient << 0.3, 0.1, -0.2, 0.15, -0.2, 0.05, -0.1, 0.2, 0.1;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const auto formulation : all_formulations)
    for (const auto element : scenes::all_elements) {
      if (formulation == cases::Formulation::small_strain || !has_meaning(formulation, element)) continue;
      OneCell cell(formulation, element, material_of(formulation));
      const Eigen::VectorXd u = cell.displacement(gradient, 0.02);
      Eigen::VectorXd turned = u;
      for (int a = 0; a < cell.discretisation.nodes.per_cell; ++a) {
        const int node = cell.discretisation.nodes.of_cell[static_cast<std::size_t>(a)];
        const Eigen::Vector3d x = cell.discretisation.nodes.point[static_cast<std::size_t>(node)];
        turned.segment<3>(3 * a) = turn * (x + u.segment<3>(3 * a)) - x;
      }
      const Eigen::VectorXd before = cell.force(u), after = cell.force(turned);
      double error = 0;
      for (Eigen::Index a = 0; a < cell.discretisation.nodes.per_cell; ++a)
        error = larger(error, (after.segment<3>(3 * a) - turn * before.segment<3>(3 * a)).norm());
      CAPTURE(cases::name_of(formulation), cases::name_of(element));
      CHECK(error <= 1e-12 * before.norm()); // rounding error of a few hundred additions
    }
}

TEST_CASE("a rigid motion gives a cell no force", "[verification]") {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.2, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const auto formulation : all_formulations)
    for (const auto element : scenes::all_elements) {
      if (formulation == cases::Formulation::small_strain || !has_meaning(formulation, element)) continue;
      OneCell cell(formulation, element, material_of(formulation));
      CAPTURE(cases::name_of(formulation), cases::name_of(element));
      CHECK(cell.force(cell.displacement(turn - Eigen::Matrix3d::Identity(), 0)).norm() <=
            1e-13); // N, at moduli near 1 MPa
    }
}

TEST_CASE("in small strain a condensed constant pressure is B-bar, computed from its B matrix",
          "[verification]") {
  const auto elastic = scenes::thesis_elastic(0.49);
  OneCell cell(cases::Formulation::small_strain, Element::q1_bbar, elastic);
  const Eigen::MatrixXd bbar = bbar_stiffness(cell.discretisation.geometry.of(0), elastic);
  const Eigen::MatrixXd tangent = cell.tangent(Eigen::VectorXd::Zero(24));
  CHECK((tangent - bbar).norm() <= 1e-13 * bbar.norm()); // rounding error
  const auto own = element_stiffness(cases::cell_vertices(cell.scene.mesh, 0), elastic, Element::q1_bbar);
  CHECK((own - bbar).norm() <= 1e-13 * bbar.norm());
}

/// A cube's bending, twist and warp as Wilson's element has them: those of quadratic displacements in
/// equilibrium, in units of mu times the edge (Wilson et al. 1973; the closed forms follow from the modes).
TEST_CASE("Wilson's cube resists bending, twist and warp as quadratic displacements do", "[verification]") {
  const double nu = GENERATE(0., 0.25, 0.35, 0.45);
  const auto elastic = scenes::thesis_elastic(nu);
  cases::Scene scene = scenes::distorted_box(1, scenes::Surface::free, elastic,
                                             cases::Formulation::small_strain, Element::q1_wilson);
  for (int v = 0; v < 8; ++v) scene.mesh.nodes.stored()[v] = Eigen::Vector3d(v & 1, (v >> 1) & 1, v >> 2);
  const Formulation formulation = make_formulation(scene.definition.fem, elastic);
  const Discretisation body(scene, element_type(scene.definition.fem, formulation), MPI_COMM_SELF);
  const auto kernel = formulation.make_kernel(body.element);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(24);
  const Eigen::MatrixXd k =
      kernel->evaluate(body.geometry.of(0), rest.data(), rest.data(), Wanted::stress_and_tangent).tangent;
  const auto resistance = [&](const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& mode) {
    Eigen::VectorXd m(24);
    for (int a = 0; a < 8; ++a) {
      const Eigen::Vector3d x = 2 * body.nodes.point[static_cast<std::size_t>(body.nodes.of_cell[a])];
      const Eigen::Vector3d u = mode(x - Eigen::Vector3d::Ones());
      for (int i = 0; i < 3; ++i) m(8 * i + a) = u[i];
    }
    return m.dot(k * m) / m.squaredNorm() / mechanics::elastic_moduli(elastic).mu;
  };
  using Eigen::Vector3d;
  CHECK(resistance([](const Vector3d& x) { return Vector3d(0, x[0] * x[1], x[0] * x[2]); }) ==
        Approx((1 + nu) / (3 * (1 - nu))).epsilon(1e-12));
  CHECK(resistance([](const Vector3d& x) { return Vector3d(0, x[0] * x[1], -x[0] * x[2]); }) ==
        Approx(1. / 3).epsilon(1e-12));
  CHECK(resistance([](const Vector3d& x) { return Vector3d(-x[1] * x[2], x[0] * x[2], 0); }) ==
        Approx(1. / 6).epsilon(1e-12));
  CHECK(resistance([](const Vector3d& x) { return Vector3d(x[1] * x[2], x[0] * x[2], x[0] * x[1]); }) ==
        Approx(2. / 3).epsilon(1e-12));
}

TEST_CASE("an inverted cell is refused, and so is a state that is not a number") {
  OneCell cell(cases::Formulation::hyperelastic, Element::q1, material_of(cases::Formulation::hyperelastic));
  const auto valid = [&](const Eigen::VectorXd& u) {
    return cell.kernel->evaluate(cell.discretisation.geometry.of(0), u.data(), nullptr, Wanted::stress).valid;
  };
  CHECK(valid(cell.displacement(Eigen::Matrix3d::Zero(), 0)));
  CHECK_FALSE(valid(cell.displacement(Eigen::Vector3d(-1.5, 0, 0).asDiagonal(), 0)));
  CHECK_FALSE(valid(Eigen::VectorXd::Constant(cell.n_dofs(), std::nan(""))));
}

TEST_CASE("a law without a pressure of its own is refused by elements that need one") {
  for (const auto element : {Element::q1_bbar, Element::q1_p0, Element::q2_p1, Element::p2_p1})
    CHECK_THROWS_AS(OneCell(cases::Formulation::saint_venant_kirchhoff, element, scenes::thesis_elastic()),
                    cases::InputError);
}
