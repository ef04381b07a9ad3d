#include "cases/case/error.hpp"
#include "fem_reference/model.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/tetrahedra.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

TEST_CASE("finite elements refuse tetrahedra, at rest and in modes, and say what solves them") {
  cases::Scene scene = cases::make_scene(bodies::clamped_box({1, 1, 1}, {}));
  scene.mesh = bodies::box_of_tetrahedra({1, 1, 1});
  CHECK_THROWS_WITH(fem_reference::Model(scene, MPI_COMM_SELF), Catch::Contains("--only msm"));
  CHECK_THROWS_WITH(fem_reference::vibrating_body(scene), Catch::Contains("mesh of tetrahedra"));
}
