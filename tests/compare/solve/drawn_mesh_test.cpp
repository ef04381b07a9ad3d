// The thesis's bodies drawn for gmsh answer as the boxes of the same cells do.

#include "cases/case/read_case.hpp"
#include "compare/gates/comparison.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace {

/// Both models on the drawn mesh and on the box, node by node.
/// @param as_box  settings that put the box in the drawn mesh's place
void check_same_answers(const std::string& name, const std::vector<std::string>& as_box) {
  const std::string file = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/thesis/geo/" + name;
  const compare::Comparison drawn = compare::compare_case(cases::read_case(file));
  const compare::Comparison box = compare::compare_case(cases::read_case(file, as_box));
  const auto check_side = [&](const cases::Solution& on_drawn, const cases::Solution& on_box) {
    REQUIRE(on_drawn.status == cases::Status::converged);
    REQUIRE(on_box.status == cases::Status::converged);
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < drawn.scene.mesh.nodes.size(); ++n) {
      const auto place = drawn.scene.mesh.nodes[n];
      // gmsh divides lines by numerical integration: nodes are up to 2e-11 mm off
      const cases::Region here{"", place.array().round().matrix(), {}};
      const Eigen::Vector3d& u =
          on_box.displacement[static_cast<std::size_t>(select_node(box.scene.mesh, here))];
      difference = larger(difference, (on_drawn.displacement[n] - u).norm());
      largest = larger(largest, u.norm());
    }
    CHECK(largest > 0);
    CHECK(difference <= 1e-10 * largest); // asked for; the residuals are below 1e-10
  };
  check_side(drawn.answers.fem.solution, box.answers.fem.solution);
  check_side(drawn.answers.msm.solution, box.answers.msm.solution);
}

} // namespace

TEST_CASE("the cube drawn for gmsh moves as the box does, node by node, in both models", "[verification]") {
  check_same_answers("cube_torsion_small.toml",
                     {"body={shape=\"box\", size=[10, 10, 10], cells=[10, 10, 10]}", "fixed[0].region=z-",
                      "load[0].region=z+ y-", "load[1].region=z+ x+", "load[2].region=z+ y+",
                      "load[3].region=z+ x-", "measure[1].node=z+ x- y-"});
}

TEST_CASE("the bar drawn for gmsh moves as the box does, node by node, in both models", "[verification]") {
  check_same_answers("bar.toml",
                     {"body={shape=\"box\", size=[4, 4, 16], cells=[4, 4, 16]}", "fixed[0].region=z-",
                      "load[0].region=z+ x-", "measure[0].node=z+ x- y-", "measure[1].node=z+ x- y-"});
}
