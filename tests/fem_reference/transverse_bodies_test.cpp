#include "fem_reference/model.hpp"
#include "scenes.hpp"
#include "solved.hpp"
#include "tests/fem_reference/laws/point_law.hpp"
#include "tests/support/largest.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using cases::Element;
using Eigen::Vector3d;

/// Bodies of a transversely isotropic material.
namespace {

/// A unit cube on three planes of symmetry, with one face moved along its normal.
cases::Scene supported_cube(const cases::Material& material, cases::Formulation formulation,
                            Element element) {
  cases::Case definition;
  definition.body = cases::Box{Vector3d::Ones(), {2, 2, 2}};
  definition.material = material;
  definition.fem.formulation = formulation;
  definition.fem.element = element;
  for (const char* face : {"x-", "y-", "z-", "x+"}) {
    definition.fixed.push_back({{face}, {face[0] == 'x', face[0] == 'y', face[0] == 'z'}});
  }
  return cases::make_scene(definition);
}

/// Force on the face where a coordinate is 1.
Vector3d force_on_face(const Solved& body, int axis) {
  return body.force_on([=](const Vector3d& x) { return x[axis] > 1 - 1e-9; });
}

} // namespace

TEST_CASE("distorted hexahedra with a fibre askew hold an affine displacement and its stress exactly",
          "[verification]") {
  const Element element = GENERATE(Element::q1, Element::q1_bbar, Element::q1_p0, Element::q1_wilson,
                                   Element::q2, Element::q2_p1);
  const cases::Formulation formulation =
      GENERATE(cases::Formulation::small_strain, cases::Formulation::log_strain);
  const auto material = scenes::fibrous({1, 2, -0.5});
  const auto scene = scenes::distorted_box(3, scenes::Surface::fixed, material, formulation, element);
  Eigen::Matrix3d gradient;
  gradient << 0.10, 0.03, -0.02, 0.04, -0.06, 0.01, 0.02, -0.05, 0.08;
  const auto field = [&](const Vector3d& x) -> Vector3d { return gradient * x; };
  const Solved solved(scene, {nullptr, field});
  CAPTURE(cases::name_of(element), cases::name_of(formulation));
  CHECK(solved.largest_error(field) <= 1e-10);

  // The forces on a face of area 1 in a homogeneous state are the column of P of its normal.
  const Eigen::Matrix3d f = Eigen::Matrix3d::Identity() + gradient;
  const auto law = formulation == cases::Formulation::small_strain
                       ? point_laws::point_law<fem_reference::TransverseSmallStrain>(material)
                       : point_laws::point_law<fem_reference::TransverseLogStrain>(material);
  const Eigen::Matrix3d first = point_laws::whole_stress(law, f).reshaped<Eigen::RowMajor>(3, 3);
  for (int axis = 0; axis < 3; ++axis)
    CHECK((force_on_face(solved, axis) - first.col(axis)).norm() <= 1e-10 * first.norm());
}

TEST_CASE("a cube pulled along its fibre or across it is the closed form", "[verification]") {
  const Element element = GENERATE(Element::q1, Element::q1_bbar, Element::q1_p0, Element::q1_wilson,
                                   Element::q2, Element::q2_p1);
  const bool is_along = GENERATE(true, false);
  const auto m = scenes::fibrous(is_along ? Vector3d::UnitX() : Vector3d::UnitZ());
  const double modulus = is_along ? m.youngs_modulus_along : m.youngs_modulus_across;
  const Vector3d ratios =
      is_along ? Vector3d(1, -m.poissons_ratio_along, -m.poissons_ratio_along)
               : Vector3d(1, -m.poissons_ratio_across,
                          -m.poissons_ratio_along * m.youngs_modulus_across / m.youngs_modulus_along);
  CAPTURE(cases::name_of(element), is_along);
  for (const double stretch : {0.7, 1.02, 1.4}) {
    const auto pull = [=](const Vector3d& x) -> Vector3d { return (stretch - 1) * x; };
    const auto check = [&](cases::Formulation formulation, const Vector3d& stretches, double force) {
      const Solved cube(supported_cube(m, formulation, element), {nullptr, pull});
      CAPTURE(cases::name_of(formulation), stretch);
      CHECK(cube.largest_error(
                [&](const Vector3d& x) -> Vector3d { return stretches.cwiseProduct(x) - x; }) <= 1e-9);
      CHECK(std::abs(force_on_face(cube, 0).x() - force) <= 1e-10);
    };
    check(cases::Formulation::small_strain, Vector3d::Ones() + (stretch - 1) * ratios,
          modulus * (stretch - 1));
    const double strain = std::log(stretch); // Cauchy stress E ln(stretch) on the section that is left
    const Vector3d stretches = (strain * ratios).array().exp();
    check(cases::Formulation::log_strain, stretches, modulus * strain * stretches[1] * stretches[2]);
  }
}

TEST_CASE("a body turned with its fibre and its surface's motion answers with the turned displacement",
          "[verification]") {
  const cases::Formulation formulation =
      GENERATE(cases::Formulation::small_strain, cases::Formulation::log_strain);
  const Element element = GENERATE(Element::q1_bbar, Element::q2);
  const Eigen::Matrix3d q = Eigen::AngleAxisd(0.8, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const Vector3d fibre(1, 2, -0.5);
  const auto field = [](const Vector3d& x) -> Vector3d {
    return 0.1 *
           Vector3d(x.x() * x.y() + x.z() * x.z(), x.x() - x.y() * x.z(), x.y() * x.y() + x.x() * x.z());
  };
  const auto body =
      scenes::distorted_box(2, scenes::Surface::fixed, scenes::fibrous(fibre), formulation, element);
  cases::Scene turned = body;
  turned.definition.material = scenes::fibrous(q * fibre);
  for (Vector3d& node : turned.mesh.nodes.stored()) node = q * node;
  const Solved plain(body, {nullptr, field}),
      other(turned, {nullptr, [&](const Vector3d&x) -> Vector3d { return q * field(q.transpose() * x); }});
  const auto u = plain.displacement(), v = other.displacement();
  REQUIRE(u.size() == v.size());
  double largest = 0;
  for (std::size_t n = 0; n < u.size(); ++n) largest = larger(largest, (q * u[n] - v[n]).norm());
  CAPTURE(cases::name_of(formulation), cases::name_of(element));
  CHECK(largest <= 1e-9); // displacements are 0.1 mm: tolerance of either solve
}

TEST_CASE("a grid of a transversely isotropic material is assembled, and refused to the grid's backend") {
  const auto scene =
      cases::make_scene(scenes::cube(scenes::Test::shear, scenes::LoadSet::small, scenes::fibrous({0, 0, 1}),
                                     cases::Formulation::log_strain, Element::q1_bbar));
  CHECK(fem_reference::choose_backend(scene, 1331) == fem_reference::Backend::assembled);
  const auto isotropic =
      cases::make_scene(scenes::cube(scenes::Test::shear, scenes::LoadSet::small, scenes::thesis_elastic(),
                                     cases::Formulation::log_strain, Element::q1_bbar));
  CHECK(fem_reference::choose_backend(isotropic, 1331) == fem_reference::Backend::grid);
  CHECK_THROWS_WITH(fem_reference::Model(scene, MPI_COMM_SELF, fem_reference::Backend::grid),
                    Catch::Contains("isotropic material"));
}
