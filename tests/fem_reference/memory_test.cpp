#include "cases/case/elements.hpp"
#include "cases/case/error.hpp"
#include "fem_reference/assembled_body.hpp"
#include "fem_reference/model.hpp"
#include "mechanics/dynamics/time_integrator.hpp"
#include "mechanics/elastic_moduli.hpp"
#include "tests/support/creep.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace springproof;
using Eigen::Vector3d;
using fem_reference::State;

namespace {

constexpr cases::TimeScheme newmark{cases::Scheme::newmark};

/// A block of 10 mm in a tight box, which is drawn along x: a modulus K + 4/3 G resists.
cases::Case oedometer(cases::Formulation formulation, cases::Element element, double stress,
                      const std::vector<cases::PronyTerm>& prony) {
  cases::Case definition;
  definition.body = cases::Box{{10, 10, 10}, {1, 1, 1}};
  definition.material = cases::LinearElastic{0.1, 0.3};
  if (formulation == cases::Formulation::hyperelastic) definition.material = cases::Ogden{{0.04}, {3}, 0.1};
  definition.fem.formulation = formulation;
  definition.fem.element = element;
  definition.material_dynamics = {1e-9, 0, 0, prony};
  definition.fixed = {{cases::Region{"x-"}, {true, false, false}},
                      {cases::Region{"y-"}, {false, true, false}},
                      {cases::Region{"y+"}, {false, true, false}},
                      {cases::Region{"z-"}, {false, false, true}},
                      {cases::Region{"z+"}, {false, false, true}}};
  definition.measures = {{"", cases::measures::Displacement{cases::Region{"x+ y+ z+"}}}};
  definition.loads = {{cases::Region{"x+"}, cases::loads::Traction{{stress, 0, 0}}, creep::grows()}};
  return definition;
}

mechanics::ElasticModuli moduli(const cases::Material& material) {
  if (const auto* linear = std::get_if<cases::LinearElastic>(&material))
    return mechanics::elastic_moduli(*linear);
  return mechanics::elastic_moduli(cases::hyperelastic_rest(material).value());
}

/// Largest distance of the creep from the closed form, over the displacement in the end.
double error_of_creep(cases::Formulation formulation, cases::Element element, const cases::PronyTerm& term,
                      const cases::TimeScheme& scheme, double step) {
  cases::Case definition = oedometer(formulation, element, 1e-8, {term}); // MPa
  const auto [lambda, mu, kappa] = moduli(definition.material);
  const double part =
      (kappa * creep::part_of(term.k) + 4. / 3 * mu * creep::part_of(term.g)) / (kappa + 4. / 3 * mu);
  definition.dynamics = creep::steps(scheme, step);
  mechanics::IntegrationSettings settings = fem_reference::default_steps();
  settings.newton.tolerance = 1e-11;
  const cases::Solution moved = fem_reference::follow(tetrahedra::make_scene(definition), settings);
  const double end = 10 * 1e-8 / (kappa + 4. / 3 * mu);
  double largest = 0;
  for (std::size_t n = 0; n < moved.trajectory->time.size(); ++n)
    largest =
        larger(largest, std::abs(moved.trajectory->displacement[n].x() / end -
                                 creep::strain(moved.trajectory->time[n], creep::ramp, part, term.tau)));
  return largest;
}

} // namespace

TEST_CASE("finite elements creep as the closed form says, shear by g and bulk by k", "[verification]") {
  CHECK(error_of_creep(cases::Formulation::small_strain, cases::Element::q1, {0.3, 0.5, creep::tau}, newmark,
                       0.0005) <= 1e-6);
}

TEST_CASE("every formulation and element with a memory creeps at the order 2", "[verification]") {
  using cases::Element;
  using cases::Formulation;
  for (const auto& [formulation, element, k] : {std::tuple(Formulation::small_strain, Element::q1_bbar, 0.2),
                                                {Formulation::log_strain, Element::q1, 0.2},
                                                {Formulation::log_strain, Element::q1_bbar, 0.2},
                                                {Formulation::log_strain, Element::q1_wilson, 0.2},
                                                {Formulation::hyperelastic, Element::q1_p0, 0.2},
                                                {Formulation::hyperelastic, Element::p2_p0, 0.2},
                                                {Formulation::log_strain, Element::p2_p1, 0.},
                                                {Formulation::saint_venant_kirchhoff, Element::q1, 0.3}}) {
    INFO(name_of(formulation) << ", " << name_of(element));
    const auto error = [&, formulation = formulation, element = element, k = k](double step) {
      return error_of_creep(formulation, element, {0.3, k, creep::tau}, newmark, step);
    };
    CHECK(error(0.01) < 1e-2);
    CHECK(std::log2(error(0.01) / error(0.005)) == Approx(2).margin(0.1)); // the next order has a tenth of it
  }
  for (const auto scheme : {cases::Scheme::bdf2, cases::Scheme::generalized_alpha}) {
    INFO(name_of(scheme));
    const auto error = [&](double step) {
      return error_of_creep(Formulation::log_strain, Element::q1, {0.3, 0.2, creep::tau},
                            {scheme, 0.25, 0.5, 0.5}, step);
    };
    CHECK(std::log2(error(0.01) / error(0.005)) == Approx(2).margin(0.1));
  }
}

TEST_CASE("the tangent of a step with a memory is the derivative of its residual") {
  for (const auto formulation : {cases::Formulation::log_strain, cases::Formulation::hyperelastic}) {
    INFO(name_of(formulation));
    cases::Case definition = oedometer(formulation, cases::Element::q1, 0, {{0.3, 0.2, 0.1}});
    definition.material_dynamics.density = 1000.;
    definition.fixed.resize(1);
    definition.dynamics = creep::steps(newmark, 0.01);
    const cases::Scene scene = tetrahedra::make_scene(definition);
    fem_reference::AssembledBody body(scene, MPI_COMM_SELF);
    body.equations.set_in_motion(scene, body.formulations);
    mechanics::DynamicProblem& motion = body.equations;
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> value(-1, 1);
    const auto on_free = [&](double size) {
      State state = body.equations.rest();
      for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(body.discretisation.load.size()); ++i)
        if (!body.discretisation.constraints.is_constrained[cases::index(i)])
          state[i] = size * value(generator);
      return state;
    };
    const State rest = body.equations.rest(), before = on_free(1), at = on_free(1), along = on_free(1);
    motion.begin_motion(rest);
    motion.end_step(before, 0.05);
    mechanics::StepTerms terms{1e6, 0, rest, rest, rest, 1};
    terms.duration = 0.02;
    motion.set_step(terms);
    constexpr double small = 1e-5; // mm
    const auto residual = [&](double way) -> State {
      return motion.residual(at + way * along, 0, mechanics::Expect::residual);
    };
    const State product = (residual(-small) - residual(small)) / (2 * small);
    motion.residual(at, 0, mechanics::Expect::direction);
    const auto first = motion.direction(at, product, 0, 0, mechanics::Convexity::exact);
    const State other_force = rest + product;
    mechanics::StepTerms with_force{1e6, 0, rest, other_force, rest, 1};
    with_force.duration = 0.02;
    motion.set_step(with_force);
    motion.residual(at, 0, mechanics::Expect::direction);
    const auto second = motion.direction(at, product, 0, 0, mechanics::Convexity::exact);
    REQUIRE((first && second));
    CHECK((*second - *first - along).norm() <= 1e-5 * along.norm());
  }
}

TEST_CASE("finite elements that turn freely are not damped by their memory", "[verification]") {
  for (const auto formulation : {cases::Formulation::log_strain, cases::Formulation::hyperelastic}) {
    cases::Case definition = oedometer(formulation, cases::Element::q1, 0, {{0.3, 0.2, 0.1}});
    definition.material_dynamics.density = 1000.;
    definition.fixed.clear();
    definition.dynamics = creep::steps(newmark, 0.001);
    const cases::Scene scene = tetrahedra::make_scene(definition);
    fem_reference::AssembledBody body(scene, MPI_COMM_SELF);
    body.equations.set_in_motion(scene, body.formulations);
    const auto& points = body.discretisation.nodes.point;
    State velocity = body.equations.rest();
    for (std::size_t n = 0; n < points.size(); ++n)
      velocity.segment<3>(static_cast<Eigen::Index>(3 * n)) =
          Vector3d(0, 0, 0.005).cross(points[n] - Vector3d(5, 5, 5)); // 1/s: it strains by 1e-11
    mechanics::IntegrationSettings settings = fem_reference::default_steps();
    settings.newton.tolerance = 1e-13;
    mechanics::TimeIntegrator motion(body.equations, newmark, {0, body.equations.rest(), velocity, {}},
                                     settings);
    const double at_start = motion.kinetic_energy();
    // 0.04 radians, in 80 relaxation times. Longer steps h begin with a jolt, some (0.005 h)² of the energy.
    for (int n = 1; n <= 2000; ++n) motion.advance(n * 0.004);
    CHECK(motion.now().displacement.norm() > 0.5); // mm
    CHECK(std::abs(motion.kinetic_energy() / at_start - 1) <= 1e-9);
  }
}

TEST_CASE("a memory that finite elements cannot have is refused") {
  const auto settled = [](cases::Formulation formulation, cases::Element element, double k) {
    cases::Case definition = oedometer(formulation, element, 0, {{0.3, k, 0.1}});
    definition.dynamics = creep::steps(newmark, 0.01);
    cases::settle_element(definition, cases::facts_of(element).is_tetrahedron);
  };
  CHECK_NOTHROW(settled(cases::Formulation::log_strain, cases::Element::q2_p1, 0));
  CHECK_THROWS_WITH(settled(cases::Formulation::log_strain, cases::Element::q2_p1, 0.1),
                    Catch::Contains("k = 0"));
  CHECK_THROWS_WITH(settled(cases::Formulation::saint_venant_kirchhoff, cases::Element::q1, 0),
                    Catch::Contains("k equal to g"));
}
