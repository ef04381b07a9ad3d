#include "msm/grid/moving_grid.hpp"

#include "mechanics/dynamics/time_integrator.hpp"
#include "msm/direct/direct_system.hpp"
#include "msm/model.hpp"
#include "tests/msm/moving_bodies.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace springproof;

namespace moving_bodies {

namespace {

cases::Solution follow_on(msm::Path path, const cases::Scene& scene,
                          const std::vector<msm::CellStiffness>& cells) {
  return msm::follow(scene, cells, {path, 1, {}, {}});
}

/// Largest difference of the displacements that two motions keep, over the largest one of a.
double largest_difference(const cases::Solution& a, const cases::Solution& b) {
  REQUIRE(a.trajectory->bodies.size() == b.trajectory->bodies.size());
  double largest = 0, size = 0;
  for (std::size_t s = 0; s < a.trajectory->bodies.size(); ++s) {
    const auto &of_a = a.trajectory->bodies[s].displacement, &of_b = b.trajectory->bodies[s].displacement;
    for (std::size_t p = 0; p < of_a.size(); ++p) {
      largest = larger(largest, (of_a[p] - of_b[p]).norm());
      size = larger(size, of_a[p].norm());
    }
  }
  CHECK(size > 0.01); // mm: it moves
  return largest / size;
}

void check_paths_agree(const cases::Scene& scene, const std::vector<msm::CellStiffness>& cells) {
  const cases::Solution on_grid = follow_on(msm::Path::multigrid, scene, cells),
                        direct = follow_on(msm::Path::direct, scene, cells);
  CHECK(on_grid.linear_iterations > 0);
  CHECK(direct.factorisations > 0);
  CHECK(largest_difference(on_grid, direct) <= 1e-6);
  REQUIRE(on_grid.trajectory->displacement.size() == direct.trajectory->displacement.size());
}

} // namespace

TEST_CASE("motions on a grid are those of the direct path: every scheme, both dampings, gravity",
          "[verification]") {
  for (const auto scheme : {cases::Scheme::implicit_euler, cases::Scheme::newmark,
                            cases::Scheme::generalized_alpha, cases::Scheme::bdf2}) {
    INFO(cases::name_of(scheme));
    check_paths_agree(block(steps(scheme, 0.005, 0.05), {1000., 5, 0.002}), {hybrid_springs});
  }
}

TEST_CASE("motions on a grid are those of the direct path: several materials", "[verification]") {
  cases::Scene scene = block(steps(cases::Scheme::newmark, 0.005, 0.05), {1000., 0, 0.001});
  scene.definition.region_materials.emplace_back().dynamics = {3000., 8, 0};
  std::vector<msm::CellStiffness> cells;
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) {
    scene.material_of_cell.push_back(c % 3 == 0 ? 1 : 0);
    cells.push_back(msm::scaled(hybrid_springs, c % 3 == 0 ? 7 : 1));
  }
  check_paths_agree(scene, cells);
}

TEST_CASE("motions on a grid are those of the direct path: springs of three laws", "[verification]") {
  msm::CellStiffness power_log = hybrid_springs;
  power_log.exponents = msm::Exponents{-1.3, -1.8, -2.2};
  const msm::CellStiffness edges_and_diagonals{0.2, 0.1, 0.3, 0};
  msm::CellStiffness with_midlines = power_log;
  with_midlines.midline = 0.4;
  for (const auto& cell : {power_log, edges_and_diagonals, with_midlines})
    check_paths_agree(block(steps(cases::Scheme::generalized_alpha, 0.005, 0.05), {1000., 0, 0.002}), {cell});
}

TEST_CASE("motions on a grid are those of the direct path: supports that turn, weights, holes",
          "[verification]") {
  const cases::Dynamics dynamics = steps(cases::Scheme::implicit_euler, 0.01, 0.1);
  SECTION("supports that turn") {
    check_paths_agree(turned_block(dynamics, {1000., 0, 0.003}), {hybrid_springs});
  }
  SECTION("weights") {
    cases::Scene scene = block(dynamics, {1000., 0, 0});
    cases::AddedMass weight{region_of("z+"), 0.12}; // kg: as much as the block
    scene.masses.push_back({cases::select(scene.mesh, weight.region), weight});
    check_paths_agree(scene, {hybrid_springs});
  }
  SECTION("holes") {
    check_paths_agree(block(dynamics, {1000., 2, 0.001}, true), {hybrid_springs});
  }
}

TEST_CASE("motions on a grid are those of the direct path: consistent masses", "[verification]") {
  const cases::Dynamics dynamics = steps(cases::Scheme::generalized_alpha, 0.005, 0.05);
  cases::Scene scene = block(dynamics, {1000., 5, 0.002}, true);
  SECTION("dampings, holes") {
    check_paths_agree(with_consistent_masses(scene), {hybrid_springs});
  }
  SECTION("several materials, weights") {
    scene.definition.region_materials.emplace_back().dynamics = {3000., 8, 0};
    for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
      scene.material_of_cell.push_back(c % 3 == 0 ? 1 : 0);
    cases::AddedMass weight{region_of("z+"), 0.12};
    scene.masses.push_back({cases::select(scene.mesh, weight.region), weight});
    check_paths_agree(with_consistent_masses(scene),
                      std::vector<msm::CellStiffness>(scene.mesh.cells.size(), hybrid_springs));
  }
  SECTION("supports that turn") {
    check_paths_agree(with_consistent_masses(turned_block(dynamics, {1000., 3, 0.003})), {hybrid_springs});
  }
}

TEST_CASE("consistent masses on a grid are the assembled ones, holes, materials, moved supports and all",
          "[verification]") {
  cases::Scene scene = block({}, {1000., 5, 0}, true, 7);
  scene.definition.region_materials.emplace_back().dynamics = {3000., 8, 0};
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    scene.material_of_cell.push_back(c % 3 == 0 ? 1 : 0);
  for (const cases::Scene& of :
       {with_consistent_masses(scene), with_consistent_masses(turned_block({}, {1000., 3, 0}))}) {
    const msm::SpringBody springs = std::vector<msm::CellStiffness>(of.mesh.cells.size(), hybrid_springs);
    msm::MovingBody on_grid(of, springs, {msm::Path::multigrid, 1, {}, {}}),
        assembled(of, springs, {msm::Path::direct, 1, {}, {}});
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> value(-1, 1);
    msm::Points motion;
    for (std::size_t p = 0; p < of.mesh.nodes.size(); ++p)
      motion.emplace_back(value(generator), value(generator), value(generator));
    const auto& problem = on_grid.problem();
    for (std::size_t dof = 0; dof < problem.is_constrained.size(); ++dof)
      if (problem.is_constrained[dof] && !problem.supports) motion[dof / 3][static_cast<int>(dof % 3)] = 0;
    for (const bool is_mass : {true, false}) {
      const auto product_of = [&](msm::MovingBody& body) {
        Vector product;
        if (is_mass)
          body.motion().mass_product(body.to_vector(motion), product);
        else
          body.motion().damping_product(body.to_vector(motion), product);
        return body.to_points(product);
      };
      const msm::Points a = product_of(on_grid), b = product_of(assembled);
      double largest = 0, size = 0;
      for (std::size_t p = 0; p < a.size(); ++p) {
        largest = larger(largest, (a[p] - b[p]).norm());
        size = larger(size, b[p].norm());
      }
      CHECK(size > 1e-7);             // t mm
      CHECK(largest <= 1e-13 * size); // rounding
    }
  }
}

TEST_CASE("a motion on a grid starts in the equilibrium of its loads") {
  cases::Dynamics dynamics = steps(cases::Scheme::newmark, 0.005, 0.02);
  dynamics.start = cases::MotionStart::equilibrium;
  const cases::Solution motion =
      follow_on(msm::Path::multigrid, block(dynamics, {1000., 0, 0}), {hybrid_springs});
  const auto& bodies = motion.trajectory->bodies;
  double largest = 0, moved = 0;
  for (std::size_t p = 0; p < bodies.front().displacement.size(); ++p) {
    largest = larger(largest, bodies.front().displacement[p].norm());
    moved = larger(moved, (bodies.back().displacement[p] - bodies.front().displacement[p]).norm());
  }
  CHECK(largest > 0.01);
  CHECK(moved <= 1e-6 * largest);
}

TEST_CASE("steps in real time have no more iterations than allowed and say what they left") {
  // Damped so that it ends at rest, where the last step has nothing left to do.
  const int n_steps = 200, enough = 3;
  const cases::Scene scene =
      block(steps(cases::Scheme::implicit_euler, 0.02, 0.02 * n_steps), {1000., 20, 0});
  const std::vector<msm::CellStiffness> cells{hybrid_springs};
  const msm::ModelOptions options{msm::Path::multigrid, 1, {}, {}};
  const cases::Solution whole = msm::follow(scene, cells, options),
                        cut = msm::follow(scene, cells, options, mechanics::in_real_time(enough));
  CHECK(whole.trajectory->unfinished_steps == 0);
  CHECK(cut.newton_iterations <= 2 * n_steps);
  CHECK(cut.linear_iterations <= (enough + 1) * n_steps); // the second of Newton's always has one
  CHECK(whole.linear_iterations > cut.linear_iterations);
  // What is left is what it says: every step leaves at most so much of the loads, most of them 1 %.
  CHECK(cut.trajectory->unfinished_steps < n_steps / 4);
  CHECK((cut.trajectory->unfinished_steps > 0) == (cut.trajectory->largest_residual > 1e-2));
  const double of_motion = largest_difference(whole, cut);
  CAPTURE(of_motion, cut.trajectory->unfinished_steps, cut.trajectory->largest_residual);
  CHECK(of_motion > 0);
  CHECK(of_motion <= 0.05);
  const double end = (whole.displacement.back() - cut.displacement.back()).norm();
  // 1 % of the loads may stay unbalanced at rest. Some of it bends the block, which resists that least:
  // several times as far as the same force does when it is distributed as the loads are.
  CHECK(end <= 5 * 0.01 * whole.displacement.back().norm());
}

TEST_CASE("a step in real time that its iterations leave further from balance than the loads is halved") {
  // A hundredth of the stiffness: the load moves it far, and it flew off.
  const cases::Scene scene = block(steps(cases::Scheme::implicit_euler, 0.1, 2), {1000., 0, 0});
  const cases::Solution cut = msm::follow(scene, {msm::scaled(hybrid_springs, 0.01)},
                                          {msm::Path::multigrid, 1, {}, {}}, mechanics::in_real_time(1));
  CHECK(cut.trajectory->halved_steps > 0);
  CHECK(cut.trajectory->largest_residual <= 1);
}

TEST_CASE("a step on a grid is the same bit for bit on one and two threads", "[long]") {
  const auto end = [](int n_threads) {
    const cases::Scene scene = with_consistent_masses(
        block(steps(cases::Scheme::generalized_alpha, 0.01, 0.02), {1000., 1, 0.002}, false, 24));
    return msm::follow(scene, {hybrid_springs}, {msm::Path::multigrid, n_threads, {}, {}});
  };
  const cases::Solution one = end(1), two = end(2);
  CHECK(one.linear_iterations == two.linear_iterations);
  std::size_t n_different = 0;
  for (std::size_t p = 0; p < one.displacement.size(); ++p)
    n_different += one.displacement[p] != two.displacement[p];
  CHECK(n_different == 0);
}

TEST_CASE("the tangent of a step on a grid is the derivative of its residual, damping and mass included") {
  const cases::Scene lumped = block({}, {1000., 3, 0.02});
  for (const cases::Scene& scene : {lumped, with_consistent_masses(lumped)}) {
    const Moving body(scene, hybrid_springs);
    const Vector at = body.random_motion(0.3, 5), origin = body.random_motion(0.3, 6),
                 force = body.random_motion(1, 7), along = body.random_motion(1, 8);
    for (const double mass : {1e2, 1e7, 1e12}) { // the cycle goes down, or not
      INFO("mass factor " << mass << ", " << cases::name_of(scene.definition.msm.mass));
      body.motion->set_step({mass, 1e4, origin, force, origin, 1});
      constexpr double small = 1e-5; // mm
      const auto residual = [&](double way) -> Vector {
        return body.motion->residual(at + way * along, 0, mechanics::Expect::residual);
      };
      const Vector product = (residual(-small) - residual(small)) / (2 * small);
      const auto step = body.motion->direction(at, product, 0, 1e-10, mechanics::Convexity::exact);
      REQUIRE(step);
      CHECK((*step - along).norm() <= 1e-5 * along.norm());
    }
  }
}

TEST_CASE("a step's residual is minus the derivative of its energy, where damped supports move too") {
  const cases::Scene lumped = turned_block({}, {1000., 3, 0.02});
  for (const cases::Scene& scene : {lumped, with_consistent_masses(lumped)})
    for (const double mass : {1e4, 1e8}) {
      const Moving body(scene, hybrid_springs);
      Vector at = body.random_motion(0.3, 5);
      const Vector origin = body.random_motion(0.3, 6), force = body.random_motion(1, 7),
                   along = body.random_motion(1, 8);
      body.motion->supports_at(0.02, at);
      body.motion->set_step({mass, 1e2, origin, force, at, 1});
      constexpr double small = 1e-4; // mm
      const auto energy = [&](double way) { return body.motion->energy(at + way * along, 0); };
      const Vector residual = body.motion->residual(at, 0);
      CHECK((energy(-small) - energy(small)) / (2 * small) == Approx(residual.dot(along)).epsilon(1e-6));
    }
}

} // namespace moving_bodies
