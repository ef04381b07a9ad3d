#include "msm/moving_springs.hpp"

#include "msm/model.hpp"
#include "tests/msm/moving_bodies.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace springproof;

namespace moving_bodies {

namespace {

/// A place with a node on the moved end, by weights of both signs.
std::vector<cases::NodeWeight> place_of(const cases::Scene& scene) {
  const auto node = [&](const Vector3d& at) {
    for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n)
      if ((scene.mesh.nodes[n] - at).norm() < 1e-9) return static_cast<int>(n);
    throw std::logic_error("no node there");
  };
  return {{node({60, 20, 50}), 0.5}, {node({60, 20, 40}), 0.7}, {node({60, 20, 30}), -0.2}};
}

/// A block on one of both paths, that something holds by its place.
struct Held {
  cases::Scene scene;
  msm::MovingBody body;
  msm::Pull* pull;

  Held(cases::Scene of, msm::Path path, double stiffness)
      : scene(std::move(of)), body(scene, {hybrid_springs}, {path, 1, {}, {}}),
        pull(&body.hold(place_of(scene), stiffness)) {}

  Vector zero() const { return body.to_vector(msm::Points(scene.mesh.nodes.size(), Vector3d::Zero())); }
  Vector random_motion(double size, unsigned seed) const {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> value(-size, size);
    msm::Points points;
    const std::vector<bool> is_constrained = cases::constrained_dofs(scene);
    for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
      points.emplace_back(value(generator), value(generator), value(generator));
      for (std::size_t c = 0; c < 3; ++c)
        if (is_constrained[3 * n + c]) points.back()[static_cast<int>(c)] = 0;
    }
    return body.to_vector(points);
  }
};

constexpr msm::Path both_paths[] = {msm::Path::multigrid, msm::Path::direct};
const mechanics::IntegrationSettings tight = [] {
  mechanics::IntegrationSettings settings;
  settings.newton.tolerance = 1e-11;
  return settings;
}();

} // namespace

TEST_CASE("the inverse with a pull is that of the matrix with its tangent", "[unit]") {
  constexpr int n = 12;
  const Eigen::MatrixXd any = Eigen::MatrixXd::Random(n, n);
  const Eigen::MatrixXd matrix = any * any.transpose() + Eigen::MatrixXd::Identity(n, n);
  for (const double stiffness : {1e-3, 1., 1e6}) {
    CAPTURE(stiffness);
    msm::Pull::Entries entries;
    for (int c = 0; c < 3; ++c)
      entries[cases::index(c)] = {{c, 0.7, true}, {c + 3, 0.4, true}, {c + 6, -0.1, true}};
    const msm::Pull pull(entries, stiffness);
    Eigen::MatrixXd with = matrix;
    for (int column = 0; column < n; ++column) {
      Vector product = Vector::Zero(n);
      pull.add_product(Vector(Vector::Unit(n, column)), product);
      with.col(column) += product;
    }
    const Eigen::LLT<Eigen::MatrixXd> without(matrix);
    msm::WithPull<double> inverse;
    inverse.prepare(pull, n, [&](const Vector& right, Vector& solution) { solution = without.solve(right); });
    const Vector right = Vector::Random(n), expected = with.llt().solve(right);
    Vector solution = without.solve(right);
    CHECK((solution - expected).norm() > 1e-6 * expected.norm()); // there is something to correct
    inverse.correct(pull, solution);
    // What is stiffened by 1e6 keeps ten digits.
    CHECK((solution - expected).norm() <= 1e-9 * expected.norm());
  }
}

TEST_CASE("the forces of a pull are minus the gradient of its energy", "[unit]") {
  for (const msm::Path path : both_paths) {
    Held held(turned_block(steps(cases::Scheme::implicit_euler, 0.01, 0.1), {1000., 5, 0.001}), path, 0.8);
    const Vector origin = held.random_motion(0.5, 1), at = held.random_motion(0.5, 2),
                 way = held.random_motion(1, 3);
    held.pull->draw_to({4, -2, 7});
    Vector force;
    held.body.motion().external_force(0, force);
    held.body.motion().set_step({10, 1, origin, force, origin, 1});
    constexpr double h = 1e-5; // mm: the difference's error, h², and its rounding, 1e-16/h, are alike
    const double slope =
        (held.body.motion().energy(at + h * way, 0) - held.body.motion().energy(at - h * way, 0)) / (2 * h);
    const Vector residual = held.body.motion().residual(at, 0);
    CHECK(std::abs(residual.dot(way)) > 0.1);
    CHECK(residual.dot(way) == Approx(-slope).epsilon(1e-6)); // error of the differences
    held.body.motion().let_go();
    CHECK((held.body.motion().residual(at, 0) - residual).norm() > 0.1); // the pull was a part of it
  }
}

TEST_CASE("a pull of any stiffness draws a body alike on both paths, and its forces as loads do the same",
          "[verification]") {
  for (const auto scheme : {cases::Scheme::implicit_euler, cases::Scheme::newmark,
                            cases::Scheme::generalized_alpha, cases::Scheme::bdf2})
    for (const double stiffness : {0.05, 1., 1e5}) {
      CAPTURE(cases::name_of(scheme), stiffness);
      const cases::Scene scene = block(steps(scheme, 0.01, 0.1), {1000., 5, 0.001});
      Held on_grid(scene, msm::Path::multigrid, stiffness), direct(scene, msm::Path::direct, stiffness);
      const mechanics::Motion at_rest{0, on_grid.zero(), on_grid.zero(), {}},
          direct_at_rest{0, direct.zero(), direct.zero(), {}};
      mechanics::TimeIntegrator one(on_grid.body.motion(), scene.definition.dynamics->scheme, at_rest, tight),
          other(direct.body.motion(), scene.definition.dynamics->scheme, direct_at_rest, tight);
      for (int step = 1; step <= 10; ++step) {
        const Vector3d target(0.4 * step, -0.2 * step, 0.3);
        on_grid.pull->draw_to(target);
        direct.pull->draw_to(target);
        one.advance(0.01 * step);
        other.advance(0.01 * step);
      }
      const msm::Points a = on_grid.body.to_points(one.now().displacement),
                        b = direct.body.to_points(other.now().displacement);
      double difference = 0, largest = 0;
      for (std::size_t n = 0; n < a.size(); ++n) {
        difference = std::max(difference, (a[n] - b[n]).norm());
        largest = std::max(largest, a[n].norm());
      }
      CHECK(largest > 0.1);
      CHECK(difference <=
            1e-7 * largest); // tolerances of 1e-11, of a largest force that is up to 1e4 times the others
      if (stiffness == 1e5 && scheme == cases::Scheme::implicit_euler) // it has no other way to go
        CHECK((on_grid.pull->place(one.now().displacement) - Vector3d(4, -2, 0.3)).norm() < 1e-2);
    }
}

TEST_CASE("a stiff pull costs conjugate gradients no iterations: the preconditioner knows of it", "[unit]") {
  const auto iterations = [](double stiffness) {
    const cases::Scene scene = block(steps(cases::Scheme::implicit_euler, 0.01, 0.1), {1000., 0, 0});
    Held held(scene, msm::Path::multigrid, stiffness);
    mechanics::TimeIntegrator motion(held.body.motion(), scene.definition.dynamics->scheme,
                                     {0, held.zero(), held.zero(), {}}, tight);
    for (int step = 1; step <= 10; ++step) {
      held.pull->draw_to({0.01 * step, 0, 0});
      motion.advance(0.01 * step);
    }
    return held.body.motion().work().linear_iterations;
  };
  const long soft = iterations(1e-3), stiff = iterations(1e4);
  CHECK(soft > 10);
  CHECK(stiff <= soft + 10); // one a step; without the correction it is twice as many
}

} // namespace moving_bodies
