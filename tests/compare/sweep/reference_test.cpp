#include "compare/sweep/sweep.hpp"

#include "cases/case/read_case.hpp"
#include "cases/mesh/mesh.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

using namespace springproof;
using namespace compare;
using Eigen::Vector3d;

namespace {

cases::Case shear() {
  return cases::read_case(std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/sweep/cube_shear.toml");
}

constexpr std::array<std::array<int, 3>, 3> meshes{{{2, 2, 2}, {4, 4, 4}, {8, 8, 8}}};

/// A shear that is wrong by c h^p, h the width of a cell.
std::vector<Vector3d> field(const std::array<int, 3>& n, double c, double p) {
  std::vector<Vector3d> values;
  for (const Vector3d& x : cases::make_box_mesh({10, 10, 10}, n).nodes)
    values.emplace_back((0.1 + c * std::pow(10. / n[0], p)) * x.z(), 0, 0);
  return values;
}

std::array<std::vector<Vector3d>, 3> fields(double c, double p) {
  return {field(meshes[0], c, p), field(meshes[1], c, p), field(meshes[2], c, p)};
}

std::vector<Vector3d> sampled(const std::array<int, 3>& cells,
                              const std::function<Vector3d(const Vector3d&)>& field) {
  std::vector<Vector3d> values;
  for (const Vector3d& node : cases::make_box_mesh({2, 3, 5}, cells).nodes) values.push_back(field(node));
  return values;
}

Vector3d trilinear(const Vector3d& x) {
  return {1 + x.x() * x.y() * x.z(), x.x() - 2 * x.y() * x.z(), 3 - x.z()};
}

} // namespace

TEST_CASE("an error of one power of the mesh width is extrapolated away", "[verification]") {
  for (const double p : {1., 1.5, 4.}) {
    const Reference reference = make_reference(shear(), meshes, fields(1e-4, p));
    // extrapolation multiplies the rounding of the differences, 1e-16 / 1e-4, by no more than 10
    CHECK(field_error_percent(reference, meshes[0], field(meshes[0], 0, 1)).value() <= 1e-8);
    CHECK(reference.measures[0].value == Approx(1).epsilon(1e-9)); // 0.1 of the height
    CHECK(reference.field.note.empty());
    const double error_of_finest = 100 * 1e-4 * std::pow(10. / 8, p) / 0.1; // percent
    CHECK(field_error_percent(reference, meshes[2], field(meshes[2], 1e-4, p)).value() ==
          Approx(error_of_finest).epsilon(1e-6));
    CHECK(reference.field.uncertainty_percent ==
          Approx(1.25 * error_of_finest).epsilon(0.05)); // relative to the finest's size
  }
}

TEST_CASE("without an order the finest mesh stands, with three times its last change for uncertainty") {
  std::array<std::vector<Vector3d>, 3> growing{field(meshes[0], 0, 1), field(meshes[1], 1e-3, 0),
                                               field(meshes[2], 3e-3, 0)};
  const Reference reference = make_reference(shear(), meshes, growing);
  CHECK_FALSE(reference.field.note.empty());
  CHECK_FALSE(reference.measures[0].note.empty());
  CHECK(reference.measures[0].value == Approx(1.03));
  CHECK(reference.measures[0].uncertainty_percent == Approx(300 * 0.02 / 1.03));
  CHECK(reference.field.uncertainty_percent == Approx(300 * 0.02 / 1.03));
}

TEST_CASE("meshes that agree leave no uncertainty and no error") {
  const Reference reference = make_reference(shear(), meshes, fields(0, 1));
  CHECK(reference.field.uncertainty_percent <= 1e-7); // rounding
  const auto errors = measure_errors_percent(reference, meshes[0], field(meshes[0], 0, 1));
  REQUIRE(errors.size() == 3);
  for (const auto& error : errors) CHECK(std::abs(error.value()) <= 1e-9); // rounding
}

TEST_CASE("a body that stays at rest is wrong by all of it") {
  const Reference reference = make_reference(shear(), meshes, fields(0, 1));
  std::vector<Vector3d> still(27, Vector3d::Zero());
  CHECK(field_error_percent(reference, meshes[0], still).value() == Approx(100));
  const auto errors = measure_errors_percent(reference, meshes[0], still);
  REQUIRE(errors.size() == 3);
  for (const auto& error : errors) CHECK(error.value() == Approx(-100));
}

TEST_CASE("a trilinear field is carried to any other grid of the box, nested or not", "[verification]") {
  for (const std::array<int, 3> from : {std::array<int, 3>{1, 1, 1}, {2, 3, 4}, {5, 1, 2}})
    for (const std::array<int, 3> to : {std::array<int, 3>{1, 1, 1}, {3, 2, 7}, {4, 6, 8}}) {
      const auto values = compare::interpolate(sampled(from, trilinear), from, to);
      const auto exact = sampled(to, trilinear);
      REQUIRE(values.size() == exact.size());
      for (std::size_t n = 0; n < exact.size(); ++n)
        CHECK((values[n] - exact[n]).norm() <= 1e-13); // rounding of values up to 30
    }
}

TEST_CASE("nodes that two grids share keep their values to the last bit") {
  const auto rough = [](const Vector3d& x) {
    return Vector3d(std::sin(9 * x.x()), std::exp(x.y()), 1 / (1 + x.z()));
  };
  const auto coarse = sampled({3, 3, 3}, rough);
  CHECK(compare::interpolate(compare::interpolate(coarse, {3, 3, 3}, {6, 12, 3}), {6, 12, 3}, {3, 3, 3}) ==
        coarse);
}
