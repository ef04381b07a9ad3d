#include "cases/case/error.hpp"
#include "mechanics/dynamics/time_integrator.hpp"
#include "msm/model.hpp"
#include "msm/spring_memory.hpp"
#include "msm/tangent.hpp"
#include "tests/support/creep.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>

using namespace springproof;
using Eigen::Vector3d;
using mechanics::Vector;

namespace {

const msm::CellStiffness hybrid_springs{0.2, 0.1, 0.3, 0.05}; // N/mm, MPa

msm::SpringBody power_log() {
  msm::CellStiffness stiffness = hybrid_springs;
  stiffness.exponents = msm::Exponents{{2, 3, 1.5}};
  stiffness.midline = 0.1;
  return {stiffness};
}
msm::SpringBody biquadratic() {
  msm::CellTerms terms;
  for (const std::array<int, 4>& own :
       {std::array<int, 4>{0, 1, 2, 4}, {1, 3, 2, 7}, {1, 4, 5, 7}, {2, 4, 7, 6}, {1, 2, 4, 7}})
    terms.tetrahedra.push_back({own, 0.02, 0.03});
  return msm::BodyTerms{{terms}};
}

/// One cell of 10 mm that is pulled along x, between planes of symmetry, with next to no mass.
cases::Scene pulled(double force, const std::vector<cases::PronyTerm>& prony,
                    const cases::Dynamics& dynamics) {
  cases::Case definition;
  definition.body = cases::Box{{10, 10, 10}, {1, 1, 1}};
  definition.fixed = {{cases::Region{"x-"}, {true, false, false}},
                      {cases::Region{"y-"}, {false, true, false}},
                      {cases::Region{"z-"}, {false, false, true}}};
  definition.material_dynamics = {1e-9, 0, 0, prony};
  definition.measures = {{"", cases::measures::Displacement{cases::Region{"x+ y+ z+"}}}};
  definition.loads = {{cases::Region{"x+"}, cases::loads::TotalForce{{force, 0, 0}}, creep::grows()}};
  definition.dynamics = dynamics;
  return cases::make_scene(definition);
}

std::vector<double> course(const cases::Scene& scene, const msm::SpringBody& springs) {
  std::vector<double> x;
  mechanics::IntegrationSettings settings;
  settings.newton.tolerance = 1e-11;
  const cases::Solution moved = msm::follow(scene, springs, {}, settings);
  for (const Vector3d& way : moved.trajectory->displacement) x.push_back(way.x());
  return x;
}

/// Largest distance of a course from the closed form, over the displacement in the end.
double error_of_creep(const msm::SpringBody& springs, const cases::TimeScheme& scheme, double step) {
  constexpr double g = 0.3;
  const auto dynamics = creep::steps(scheme, step);
  const std::vector<double> x = course(pulled(1e-6, {{g, g, creep::tau}}, dynamics), springs);
  cases::Scene still = pulled(1e-6, {}, dynamics);
  still.definition.dynamics.reset();
  const double end = msm::Model(still, springs).solve().displacement.back().x();
  double largest = 0;
  for (std::size_t n = 0; n < x.size(); ++n)
    largest = larger(largest, std::abs(x[n] / end - creep::strain(double(n) * step, creep::ramp,
                                                                  creep::part_of(g), creep::tau)));
  return largest;
}

constexpr cases::TimeScheme bdf2{cases::Scheme::bdf2}, newmark{cases::Scheme::newmark};

} // namespace

TEST_CASE("a lattice whose shear and bulk fade alike creeps as the closed form says", "[verification]") {
  CHECK(error_of_creep({hybrid_springs}, newmark, 0.0005) <= 1e-6);
}

TEST_CASE("all springs, midlines, volume terms and tetrahedra creep at the order 2", "[verification]") {
  for (const msm::SpringBody& springs : {msm::SpringBody{hybrid_springs}, power_log(), biquadratic()})
    for (const cases::TimeScheme& scheme :
         {newmark, bdf2, {cases::Scheme::generalized_alpha, 0.25, 0.5, 0.5}}) {
      INFO(name_of(scheme.scheme));
      const double coarse = error_of_creep(springs, scheme, 0.01),
                   fine = error_of_creep(springs, scheme, 0.005);
      CHECK(coarse < 1e-2);
      CHECK(std::log2(coarse / fine) == Approx(2).margin(0.15)); // the next order has a tenth of it
    }
}

TEST_CASE("springs fade by g and volume terms by k, each by its own") {
  const auto dynamics = creep::steps(newmark, 0.01);
  const auto lattice_after = [&](double g, double k) {
    const cases::Scene scene = pulled(1e-6, {{g, k, creep::tau}}, dynamics);
    msm::Lattice lattice = msm::make_lattice(scene.mesh, {hybrid_springs});
    msm::SpringMemory memory(scene, {hybrid_springs}, lattice);
    memory.set_step(0);
    return lattice;
  };
  const msm::Lattice by_g = lattice_after(0.5, 0), by_k = lattice_after(0, 0.5), none = lattice_after(0, 0);
  for (std::size_t l = 0; l < none.links.size(); ++l) {
    CHECK(by_g.links[l].spring.stiffness == Approx(2 * none.links[l].spring.stiffness).epsilon(1e-14));
    CHECK(by_k.links[l].spring.stiffness == none.links[l].spring.stiffness);
  }
  CHECK(by_g.volume_cells[0].stiffness == none.volume_cells[0].stiffness);
  CHECK(by_k.volume_cells[0].stiffness == Approx(2 * none.volume_cells[0].stiffness).epsilon(1e-14));
}

TEST_CASE("the step of a lattice that remembers has the forces of its energy and their tangent") {
  for (const msm::SpringBody& springs : {msm::SpringBody{hybrid_springs}, power_log(), biquadratic()}) {
    const cases::Scene scene = pulled(1, {{0.3, 0.3, 0.1}}, creep::steps(newmark, 0.01));
    msm::Lattice lattice = msm::make_lattice(scene.mesh, springs);
    msm::SpringMemory memory(scene, springs, lattice);
    msm::Points before(8), at(8), along(8);
    for (std::size_t p = 0; p < 8; ++p) { // any displacements
      const double n = double(p);
      before[p] = Vector3d(std::sin(n), std::cos(2 * n), std::sin(3 * n + 1));
      at[p] = Vector3d(std::cos(3 * n), std::sin(n + 2), std::cos(n));
      along[p] = Vector3d(std::sin(2 * n), std::cos(n + 1), std::sin(5 * n));
    }
    memory.end_step(before, 0.05);
    memory.set_step(0.02);
    constexpr double small = 1e-5; // mm
    const auto moved = [&](double way) {
      msm::Points points = at;
      for (std::size_t p = 0; p < 8; ++p) points[p] += way * along[p];
      return points;
    };
    const msm::Points force = msm::internal_force_at(lattice, at),
                      less = msm::internal_force_at(lattice, moved(-small)),
                      more = msm::internal_force_at(lattice, moved(small));
    double work = 0, squared = 0, by_tangent = 0;
    for (std::size_t p = 0; p < 8; ++p) {
      work -= force[p].dot(along[p]);
      squared += (less[p] - more[p]).dot(along[p]) / (2 * small);
    }
    msm::Points positions = at;
    for (std::size_t p = 0; p < 8; ++p) positions[p] += lattice.rest[p];
    msm::visit_tangent_blocks(
        lattice, positions, msm::Clamp::no, [&](int row, int column, const Eigen::Matrix3d& block) {
          const double part = along[cases::index(row)].dot(block * along[cases::index(column)]);
          by_tangent += row == column ? part : 2 * part;
        });
    CHECK((msm::energy_at(lattice, moved(small)) - msm::energy_at(lattice, moved(-small))) / (2 * small) ==
          Approx(work).epsilon(1e-6)); // differences err by small², and by rounding over small
    CHECK(squared == Approx(by_tangent).epsilon(1e-6));
  }
}

TEST_CASE("a body of springs that turns freely is not damped by its memory", "[verification]") {
  cases::Case definition;
  definition.body = cases::Box{{20, 10, 10}, {2, 1, 1}};
  definition.material_dynamics = {1000., 0, 0, {{0.3, 0.3, 0.1}}};
  definition.dynamics = creep::steps(newmark, 0.001);
  const cases::Scene scene = cases::make_scene(definition);
  msm::MovingBody body(scene, {hybrid_springs});
  msm::Points velocity;
  for (const Vector3d& point : scene.mesh.nodes)
    velocity.push_back(Vector3d(0, 0, 0.005).cross(point - Vector3d(10, 5, 5))); // 1/s: it strains by 1e-10
  mechanics::IntegrationSettings settings;
  settings.newton.tolerance = 1e-13;
  const Vector rest = body.to_vector(msm::Points(velocity.size(), Vector3d::Zero()));
  mechanics::TimeIntegrator motion(body.motion(), newmark, {0, rest, body.to_vector(velocity), {}}, settings);
  const double at_start = motion.kinetic_energy();
  // 0.04 radians, in 80 relaxation times. Longer steps h begin with a jolt, some (0.005 h)² of the energy.
  for (int n = 1; n <= 2000; ++n) motion.advance(n * 0.004);
  CHECK(motion.now().displacement.norm() > 0.5); // mm
  CHECK(std::abs(motion.kinetic_energy() / at_start - 1) <= 1e-9);
}

TEST_CASE("what remembers nothing is refused a memory") {
  const auto dynamics = creep::steps(newmark, 0.01);
  CHECK_THROWS_WITH(msm::follow(pulled(1e-6, {{0.3, 0, 0.1}}, dynamics), biquadratic()),
                    Catch::Contains("k equal to g"));
  CHECK_THROWS_WITH(msm::follow(pulled(1e-6, {{0.3, 0, 0.1}}, dynamics), {hybrid_springs},
                                {msm::Path::multigrid, 1, {}, {}}),
                    Catch::Contains("a material without prony"));
}
