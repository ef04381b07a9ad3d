#include "msm/direct/direct_system.hpp"

#include "mechanics/dynamics/time_integrator.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace springproof;

using Eigen::Vector3d;
using mechanics::Vector;

namespace {

const msm::CellStiffness hybrid_springs{0.2, 0.1, 0.3, 0.05}; // N/mm, MPa

cases::Load gravity(const Vector3d& value) {
  return {{}, cases::loads::Gravity{value}};
}

/// A box of 2 x 1 x 1 cells of 10 mm, of water, held at one end or nowhere.
cases::Scene two_cells(bool is_held, double mass_damping, double stiffness_damping) {
  cases::Case definition;
  definition.body = cases::Box{{20, 10, 10}, {2, 1, 1}};
  if (is_held) definition.fixed.push_back({cases::Region{"x-"}, {true, true, true}});
  definition.material_dynamics = {1000., mass_damping, stiffness_damping};
  cases::Scene scene = cases::make_scene(definition);
  scene.loads.push_back({{}, gravity({0, 0, -9.81})});
  return scene;
}

/// A lattice and all that its motion needs.
struct Moving {
  msm::Problem problem;
  std::unique_ptr<msm::SpringSystem> statics;
  std::unique_ptr<msm::MovingSprings> motion;

  explicit Moving(const cases::Scene& scene, const msm::SpringBody& springs = {hybrid_springs})
      : problem(msm::make_moving_problem(scene)) {
    problem.lattice = msm::make_lattice(scene.mesh, springs);
    statics = msm::make_direct_system(problem);
    const msm::SpringBody damping = msm::damping_springs(scene, springs);
    motion = msm::make_moving_lattice(problem, *statics,
                                      msm::make_inertia(scene, msm::make_lattice(scene.mesh, damping)));
  }
  Moving(const Moving&) = delete; // the others refer to its problem
  Vector rest() const { return Vector::Zero(statics->load().size()); }
};

Vector random_vector(Eigen::Index n) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> value(-1, 1);
  Vector result(n);
  for (double& entry : result) entry = value(generator);
  return result;
}

} // namespace

TEST_CASE("the tangent of a lattice's step is the derivative of its residual, damping and mass included") {
  cases::Scene scene = two_cells(true, 3, 0.02);
  scene.definition.msm.mass = GENERATE(cases::PointMass::cells, cases::PointMass::consistent);
  Moving lattice(scene);
  const Vector at = 0.3 * random_vector(lattice.rest().size()), origin = 0.5 * at,
               force = random_vector(at.size()), along = random_vector(at.size()).reverse();
  lattice.motion->set_step({1e7, 1e4, origin, force, origin, 1});
  constexpr double small = 1e-5; // mm
  const auto residual = [&](double way) -> Vector {
    return lattice.motion->residual(at + way * along, 0, mechanics::Expect::residual);
  };
  const Vector product = (residual(-small) - residual(small)) / (2 * small);
  const auto step = lattice.motion->direction(at, product, 0, 0, mechanics::Convexity::exact);
  REQUIRE(step);
  CHECK((*step - along).norm() <=
        1e-6 * along.norm()); // the differences err by 1e-10 for their size, 1e-11 for rounding
  const auto energy = [&](double way) { return lattice.motion->energy(at + way * along, 0); };
  CHECK((energy(-small) - energy(small)) / (2 * small) == Approx(residual(0).dot(along)).epsilon(1e-6));
}

TEST_CASE("a lattice that nothing holds falls as the parabola says, and keeps its shape", "[verification]") {
  cases::Scene scene = two_cells(false, 0, 0);
  scene.definition.msm.mass = GENERATE(cases::PointMass::cells, cases::PointMass::consistent);
  Moving lattice(scene);
  mechanics::TimeIntegrator motion(*lattice.motion, {cases::Scheme::newmark},
                                   {0, lattice.rest(), lattice.rest(), {}});
  for (int n = 1; n <= 100; ++n) motion.advance(n * 0.001);
  for (const Vector3d& moved : msm::to_points(lattice.problem, motion.now().displacement))
    CHECK((moved - Vector3d(0, 0, -9810 * 0.1 * 0.1 / 2)).norm() < 1e-6); // it falls by 49 mm
}

TEST_CASE("a damped lattice comes to rest in its static equilibrium", "[verification]") {
  for (const auto& [alpha, beta] : {std::pair{60., 0.}, std::pair{0., 0.5}, std::pair{60., 0.5}}) {
    INFO("mass damping " << alpha << ", stiffness damping " << beta);
    const cases::Scene scene = two_cells(true, alpha, beta);
    Moving lattice(scene);
    mechanics::TimeIntegrator motion(*lattice.motion, {cases::Scheme::implicit_euler},
                                     {0, lattice.rest(), lattice.rest(), {}});
    for (int n = 1; n <= 300; ++n) motion.advance(n * 0.1);
    msm::Problem still = msm::make_problem(scene);
    still.lattice = lattice.problem.lattice;
    const auto statics = msm::make_direct_system(still);
    const Vector expected = mechanics::find_equilibrium(*statics, lattice.rest(), "lattice").state;
    CHECK(expected.norm() > 0.01);
    CHECK((motion.now().displacement - expected).norm() <= 1e-6 * expected.norm());
  }
}

TEST_CASE("springs of every kind are damped in proportion to their stiffness") {
  msm::CellTerms tetrahedra; // as design = "biquadratic" has them, and nothing else
  for (const std::array<int, 4>& own :
       {std::array<int, 4>{0, 1, 2, 4}, {1, 3, 2, 7}, {1, 4, 5, 7}, {2, 4, 7, 6}, {1, 2, 4, 7}})
    tetrahedra.tetrahedra.push_back({own, 0.02, 0.03});
  for (const msm::SpringBody& springs :
       {msm::SpringBody{hybrid_springs}, msm::SpringBody{msm::BodyTerms{{tetrahedra}}}}) {
    Moving damped(two_cells(true, 0, 0.02), springs), undamped(two_cells(true, 0, 0), springs);
    const Vector rest = damped.rest(), at = 1e-7 * random_vector(rest.size());
    const auto residual = [&](Moving& lattice, const Vector& there) -> Vector {
      lattice.motion->set_step({0, 1e4, rest, rest, rest, 1});
      return lattice.motion->residual(there, 0, mechanics::Expect::residual);
    };
    const Vector elastic = residual(undamped, rest) - residual(undamped, at),
                 damping = residual(undamped, at) - residual(damped, at);
    CHECK(elastic.norm() > 0);
    CHECK((damping - 1e4 * 0.02 * elastic).norm() <= 1e-5 * damping.norm());
  }
}

TEST_CASE("springs of cells of terms are damped as those of four stiffnesses, cell by cell") {
  cases::Scene scene = two_cells(true, 0, 0.02);
  cases::RegionMaterial other;
  other.dynamics = {1000., 0., 0.05};
  scene.definition.region_materials.push_back(other);
  scene.material_of_cell = {0, 1};
  const auto damping = [&](const msm::SpringBody& springs) {
    return msm::make_lattice(scene.mesh, msm::damping_springs(scene, springs));
  };
  const msm::Lattice by_terms = damping(msm::BodyTerms{{msm::terms_of(hybrid_springs)}}),
                     by_cells = damping({hybrid_springs});
  REQUIRE(by_terms.links.size() == by_cells.links.size());
  for (std::size_t l = 0; l < by_terms.links.size(); ++l) {
    CHECK(by_terms.links[l].i == by_cells.links[l].i);
    CHECK(by_terms.links[l].j == by_cells.links[l].j);
    CHECK(by_terms.links[l].spring.stiffness == Approx(by_cells.links[l].spring.stiffness).epsilon(1e-13));
  }
  CHECK(by_terms.volume_cells.size() == 2);
  CHECK(by_terms.volume_cells[1].stiffness == Approx(0.05 * hybrid_springs.volume).epsilon(1e-13));
  // Springs of no cells: one factor for all, tension at rest and all.
  scene = two_cells(true, 0, 0.02);
  const msm::Lattice damped = damping(msm::Network{{0, 1, 3., 8., {}}});
  CHECK(damped.links.front().spring.stiffness == Approx(0.06).epsilon(1e-13));
  CHECK(damped.links.front().spring.rest_length == 8);
}

TEST_CASE("damping in proportion to stiffness resists no rigid motion, damping in proportion to mass does") {
  for (const bool is_of_mass : {true, false}) {
    cases::Scene scene = two_cells(false, is_of_mass ? 2 : 0, is_of_mass ? 0 : 2);
    scene.definition.msm.mass = GENERATE(cases::PointMass::cells, cases::PointMass::consistent);
    Moving lattice(scene);
    Vector velocity = lattice.rest(), mass = velocity, damping = velocity;
    for (Eigen::Index p = 0; p < velocity.size(); p += 3) velocity[p] = 1; // velocity along x
    lattice.motion->mass_product(velocity, mass);
    lattice.motion->damping_product(velocity, damping);
    CHECK(mass.sum() == Approx(2e-6)); // t: 2000 mm³ of water
    CHECK((damping - (is_of_mass ? 2 : 0) * mass).norm() <= 1e-12);
  }
}
