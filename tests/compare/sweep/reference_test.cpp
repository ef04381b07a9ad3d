#include "compare/sweep/reference.hpp"

#include "cases/case/read_case.hpp"

#include <catch2/catch.hpp>
#include <cmath>

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
          Approx(1.25 * error_of_finest).epsilon(0.05)); // of the finest's size
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
