// Reactions are held against the loads. The defect that this is for: a load that a model was told and did not
// apply, which the solver cannot see. Looked at for the same: both models, refined and quadratic elements,
// ranks, networks, answers after a number of iterations (which balance nothing), states without a load.

#include "mechanics/field_sums.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using cases::index;

namespace {

cases::Scene body() {
  return cases::make_scene(bodies::clamped_box({2, 2, 3}, bodies::tensile(0.01)));
}

/// Internal forces that carry the loads times a factor: opposite ones on the supports.
mechanics::FieldSums carried(const cases::Scene& scene, double factor) {
  mechanics::FieldSums sums({0, scene.mesh.nodes.size()}, {0, scene.mesh.cells.size()});
  const int support = scene.constrained.front().selection.nodes.front();
  for (const auto& [node, force] : cases::loaded_nodes(scene)) {
    sums.force(index(node)) += factor * force;
    sums.force(index(support)) -= factor * force;
  }
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    sums.cell(c).rest_volume() = sums.cell(c).volume() = 1;
  return sums;
}

mechanics::FieldsOf of_equilibrium(mechanics::Balance balance) {
  return {1, mechanics::StrainMeasure::linear, cases::PointMass::cells, balance};
}

} // namespace

TEST_CASE("reactions that do not balance the loads are no answer") {
  const cases::Scene scene = body();
  const auto fields = [&](double factor, mechanics::Balance balance = mechanics::Balance::at_nodes) {
    return mechanics::fields_of(scene, carried(scene, factor), nullptr, of_equilibrium(balance));
  };
  Eigen::Vector3d reaction = Eigen::Vector3d::Zero(), load = reaction;
  for (const Eigen::Vector3d& of_node : fields(1).reaction) reaction += of_node;
  for (const auto& [node, force] : cases::loaded_nodes(scene)) load += force;
  CHECK((reaction + load).norm() <= 1e-12 * load.norm());
  CHECK_NOTHROW(fields(1 + 1e-8));
  for (const double factor : {0., 0.5, 1 + 1e-5}) {
    INFO(factor);
    CHECK_THROWS_AS(fields(factor), cases::SolveError);
    CHECK_NOTHROW(fields(factor, mechanics::Balance::not_asked));
  }
  CHECK_NOTHROW(fields(0.99, mechanics::Balance::as_a_whole));
  CHECK_THROWS_AS(fields(0.5, mechanics::Balance::as_a_whole), cases::SolveError);
  CHECK_THROWS_WITH(fields(0), Catch::Contains("the supports bear (0, 0, 0) N"));
}
