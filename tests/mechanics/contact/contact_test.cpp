#include "mechanics/contact/contact.hpp"

#include "mechanics/contact/signed_distance.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/quarter_block.hpp"
#include "tests/support/tool_surfaces.hpp"

#include <catch2/catch.hpp>
#include <set>

using namespace springproof;

using Eigen::Matrix3d;
using Eigen::Vector3d;
using mechanics::Contact;

namespace {

cases::Scene pressed_box(std::vector<cases::Tool> tools) {
  cases::Case definition = bodies::clamped_box({4, 3, 2}, {});
  definition.tools = std::move(tools);
  return cases::make_scene(definition);
}

/// Sum over the pressed points.
struct Pushed {
  Vector3d force = Vector3d::Zero();
  Matrix3d tangent = Matrix3d::Zero();
};

/// What a tool does where all points have moved alike.
Pushed pushed(const Contact& contact, const Vector3d& by) {
  Pushed all;
  contact.for_each_pressed([&](int) { return by; }, 1,
                           [&](const Contact::Pressed& pressed) {
                             all.force += pressed.force;
                             all.tangent += pressed.tangent();
                           });
  return all;
}

} // namespace

TEST_CASE("surface points have the area of what a tool may touch, without planes of symmetry") {
  cases::Tool tool = quarter_block::pressed_down(cases::tools::Plane{-Vector3d::UnitZ()}, {0, 0, 2}, 0.1);
  const auto area = [&](const cases::Scene& scene) {
    double sum = 0;
    for (const auto& point : mechanics::tool_sides(scene).front().points) sum += point.area;
    return sum;
  };
  CHECK(area(pressed_box({tool})) == Approx(2 * (4 * 3 + 4 * 2 + 3 * 2)));
  tool.region = bodies::region("z+");
  CHECK(area(pressed_box({tool})) == Approx(4 * 3));
  tool.region.reset();
  cases::Case half = bodies::clamped_box({4, 3, 2}, {});
  half.symmetry = {{bodies::region("x-"), {true, false, false}}};
  half.tools = {tool};
  CHECK(area(cases::make_scene(half)) == Approx(2 * (4 * 3 + 4 * 2 + 3 * 2) - 3 * 2));
}

TEST_CASE("points that a tool presses are led to where they are as deep in it when it has moved") {
  cases::Tool tool = quarter_block::pressed_down(cases::tools::Sphere{3}, {2.1, 1.4, 5}, 0.25);
  Contact contact(mechanics::tool_sides(pressed_box({tool})));
  const auto& points = contact.sides().front().points;
  const auto depth = [&](int node, const Vector3d& by, double load_factor) {
    for (const auto& point : points)
      if (point.node == node) return 3 - (point.rest + by - tool.place(load_factor)).norm();
    FAIL("the tool does not touch node " << node);
    return 0.;
  };
  const Vector3d before(0.01, 0.02, 0.03), after(-0.1, 0.05, -0.2);
  std::set<int> pressed, led;
  contact.for_each_pressed([&](int) { return before; }, 1,
                           [&](const Contact::Pressed& one) { pressed.insert(one.node); });
  REQUIRE(pressed.size() > 1);
  contact.for_each_way_along([&](int) { return before; }, 1, [&](int) { return after; }, 0.4,
                             [&](int node, const Vector3d& way) {
                               led.insert(node);
                               CHECK(depth(node, after, 0.4) < 0); // the tool has gone from it
                               CHECK(depth(node, after + way, 0.4) == Approx(depth(node, before, 1)));
                             });
  CHECK(led == pressed);
}

TEST_CASE("forces of tools are minus the slope of their potential, before and after multipliers change") {
  const cases::tools::Kind shapes[] = {
      cases::tools::Sphere{3}, cases::tools::Cylinder{3, Vector3d(0.6, 0.8, 0)},
      cases::tools::Punch{1.3, -Vector3d::UnitZ()}, cases::tools::Plane{Vector3d(0.1, 0, -1).normalized()},
      tool_surfaces::tool(tool_surfaces::ball(3, 8))};
  constexpr double h = 1e-6; // mm; central differences then err by 1e-9 and less of forces of some N
  for (const auto& shape : shapes) {
    const bool is_round = shape.index() < 2 || shape.index() == 4;
    cases::Tool tool = quarter_block::pressed_down(shape, {2.1, 1.4, is_round ? 5. : 2.}, 0.25);
    Contact contact(mechanics::tool_sides(pressed_box({tool})));
    for (const Vector3d& by : {Vector3d(0.01, 0.02, 0.03), Vector3d(-0.02, 0.01, -0.05)}) {
      const Pushed here = pushed(contact, by);
      INFO(cases::name_of(shape));
      REQUIRE(here.force.norm() > 0);
      for (int c = 0; c < 3; ++c) {
        const Vector3d to = by + h * Vector3d::Unit(c), from = by - h * Vector3d::Unit(c);
        const double slope =
            (contact.energy([&](int) { return to; }, 1) - contact.energy([&](int) { return from; }, 1)) /
            (2 * h);
        CHECK(std::abs(slope + here.force[c]) < 1e-6 * here.force.norm());
        const Vector3d change = (pushed(contact, to).force - pushed(contact, from).force) / (2 * h);
        CHECK((change + here.tangent.col(c)).norm() < 1e-5 * here.tangent.norm());
      }
      contact.augment([&](int) { return by; }, 1);
    }
  }
}

TEST_CASE("forces with friction are minus the slope of a potential while its bounds are held") {
  const cases::tools::Kind shapes[] = {
      cases::tools::Sphere{3}, cases::tools::Cylinder{3, Vector3d(0.6, 0.8, 0)},
      cases::tools::Punch{1.3, -Vector3d::UnitZ()}, cases::tools::Plane{Vector3d(0.1, 0, -1).normalized()},
      tool_surfaces::tool(tool_surfaces::ball(3, 8))};
  constexpr double h = 1e-6; // mm
  for (const auto& shape : shapes)
    for (const double friction : {0.05, 3.}) { // most points slip; most stick
      const bool is_round = shape.index() < 2 || shape.index() == 4;
      cases::Tool tool = quarter_block::pressed_down(shape, {2.1, 1.4, is_round ? 5. : 2.}, 0.25);
      tool.friction = friction;
      Contact contact(mechanics::tool_sides(pressed_box({tool})));
      const Vector3d first(0.01, 0.02, 0.03), by(-0.02, 0.01, -0.02);
      contact.augment([&](int) { return first; }, 1);
      const Pushed here = pushed(contact, by);
      INFO(cases::name_of(shape) << ", " << friction);
      for (int c = 0; c < 3; ++c) {
        const Vector3d to = by + h * Vector3d::Unit(c), from = by - h * Vector3d::Unit(c);
        const double slope =
            (contact.energy([&](int) { return to; }, 1) - contact.energy([&](int) { return from; }, 1)) /
            (2 * h);
        CHECK(std::abs(slope + here.force[c]) < 1e-6 * here.force.norm());
        const Vector3d change = (pushed(contact, to).force - pushed(contact, from).force) / (2 * h);
        CHECK((change + here.tangent.col(c)).norm() < 1e-5 * here.tangent.norm());
      }
    }
}

TEST_CASE("a point sticks by a spring, slips at the bound, and remembers where it stuck") {
  cases::Tool tool = quarter_block::pressed_down(cases::tools::Plane{-Vector3d::UnitZ()}, {0, 0, 2}, 0.1);
  tool.region = bodies::region("z+");
  tool.friction = 0.3;
  Contact contact(mechanics::tool_sides(pressed_box({tool})));
  double stiffness = 0; // N/mm, of all points
  for (const auto& point : contact.sides().front().points) stiffness += point.stiffness;
  const double bound = 0.3 * stiffness * 0.1;
  const auto at = [](double x) { return [x](int) -> Vector3d { return {x, 0, 0}; }; };
  const auto settled_at = [&](double x) { // the force along x
    CHECK_FALSE(contact.settle(at(x), 1));
    CHECK(contact.settle(at(x), 1));
    return contact.found(at(x), 1).front().force.x();
  };
  CHECK(contact.found(at(0.01), 1).front().force.x() == 0); // no bound is known yet
  CHECK(settled_at(0.01) == Approx(-stiffness * 0.01));
  contact.end_step(at(0.01), 1);
  CHECK(contact.found(at(0.02), 1).front().force.x() == Approx(-stiffness * 0.02));
  CHECK(contact.found(at(1), 1).front().force.x() == Approx(-bound));
  CHECK(contact.found(at(0.01), 1).front().force.x() == Approx(-stiffness * 0.01)); // no end of a step
  contact.end_step(at(1), 1);
  CHECK(contact.found(at(1), 1).front().force.x() == Approx(-bound));
  CHECK(contact.found(at(0.99), 1).front().force.x() == Approx(stiffness * 0.01 - bound));
  CHECK(contact.found(at(0), 1).front().force.x() == Approx(bound));
  const auto away = [](int) -> Vector3d { return {1, 0, -1}; };
  CHECK_FALSE(contact.settle(away, 1));
  CHECK(contact.found(away, 1).front().force.norm() == 0);
  contact.forget();
  CHECK(contact.found(at(1), 1).front().force.x() == 0);
  CHECK(settled_at(1) == Approx(-bound));
}

TEST_CASE("a multiplier takes the pressure's value, and a point that leaves is pressed no more") {
  const cases::Tool tool =
      quarter_block::pressed_down(cases::tools::Plane{-Vector3d::UnitZ()}, {0, 0, 2}, 0.1);
  Contact contact(mechanics::tool_sides(pressed_box({tool})));
  const auto at_rest = [](int) -> Vector3d { return Vector3d::Zero(); };
  const auto below = [](int) -> Vector3d { return {0, 0, -0.1}; }; // the top is where the plane is
  const auto away = [](int) -> Vector3d { return {0, 0, -1}; };
  const double force = contact.found(at_rest, 1).front().force.z();
  CHECK(force < 0);
  CHECK(contact.found(at_rest, 1).front().penetration == Approx(0.1));
  CHECK(contact.found(at_rest, 1).front().area == Approx(4 * 3)); // the top's: the plane does not face sides
  CHECK(contact.found(below, 1).front().force.norm() < 1e-9 * std::abs(force));
  contact.augment(at_rest, 1);
  CHECK(contact.found(below, 1).front().force.z() == Approx(force));
  CHECK(contact.misfit(below, 1).is_small());
  CHECK_FALSE(contact.misfit(at_rest, 1).is_small());
  CHECK(contact.found(away, 1).front().force.norm() == 0);
  contact.forget();
  CHECK(contact.found(below, 1).front().force.norm() < 1e-9 * std::abs(force));
}

TEST_CASE("two tools on a node share what a step has left there") {
  const cases::Tool tool =
      quarter_block::pressed_down(cases::tools::Plane{-Vector3d::UnitZ()}, {0, 0, 2}, 0.1);
  cases::Tool other = tool;
  other.name = "other";
  const auto at_rest = [](int) -> Vector3d { return Vector3d::Zero(); };
  const auto left = [](int) -> Vector3d { return {0, 0, 1e-3}; };
  const auto force = [&](const std::vector<cases::Tool>& tools, const mechanics::DisplacementAt& unbalanced) {
    double sum = 0;
    for (const auto& found : Contact(mechanics::tool_sides(pressed_box(tools))).found(at_rest, 1, unbalanced))
      sum += found.force.z();
    return sum;
  };
  const double corrected = force({tool}, left) - force({tool}, {});
  CHECK(corrected < 0);
  CHECK(force({tool, other}, left) - force({tool, other}, {}) == Approx(corrected));
}

TEST_CASE("a penalty in time is of the modulus that a memory has at once") {
  cases::Case definition;
  definition.body = cases::Box{{1, 1, 1}, {1, 1, 1}};
  definition.material_dynamics.prony = {{0.5, 0.1, 10}, {0.4, 0.1, 0.1}};
  cases::Scene scene = cases::make_scene(definition);
  const double modulus = std::get<cases::LinearElastic>(definition.material).youngs_modulus;
  CHECK(mechanics::contact_modulus(scene) == Approx(10 * modulus));
  scene.definition.dynamics = cases::Dynamics{};
  CHECK(mechanics::contact_modulus(scene) == Approx(1000 * modulus));
}

TEST_CASE("a way is open outside a tool and into its surface, not through an edge or from side to side") {
  const auto is_open = [](const cases::tools::Kind& shape, const Vector3d& from, const Vector3d& to) {
    const mechanics::SurfacePoint point{0, from, 1, 1, Vector3d::UnitZ()}; // on a face with sides of 1 mm
    const Contact contact({{quarter_block::pressed_down(shape, Vector3d::Zero(), 0), {point}}});
    return contact.is_way_open([](int) { return Vector3d::Zero(); }, 0,
                               [&](int) -> Vector3d { return to - from; }, 1);
  };
  const cases::tools::Kind punch = cases::tools::Punch{3, -Vector3d::UnitZ()}; // its flat end is at z = 0
  CHECK(is_open(punch, {2.5, 0, -1}, {2.5, 0, 0}));                            // to the end
  CHECK(is_open(punch, {2.5, 0, -1}, {2.5, 0, 0.3}));                          // a penalty's way into it
  CHECK(is_open(punch, {3.5, 0, -1}, {3, 0, 1}));                              // along the side
  CHECK_FALSE(is_open(punch, {2.5, 0, -1}, {3, 0, 0.8}));                      // through the edge
  CHECK(is_open(punch, {2.98, 0, -1}, {3, 0, 0.8})); // no deeper than a twentieth of the face's side
  const cases::tools::Kind ball = cases::tools::Sphere{0.5};
  CHECK_FALSE(is_open(ball, {0.1, 0, -0.6}, {0.1, 0, 0.5}));
  CHECK(is_open(ball, {0.3, 0, -0.4}, {0.4, 0, -0.3})); // around it
  // Ways that are long beside the tool, and do not end where they are equal on both sides.
  CHECK_FALSE(is_open(ball, {0.1, 0, -3.3}, {0.1, 0, 29.1}));
  CHECK_FALSE(is_open(ball, {0.1, 0, -29.1}, {0.1, 0, 3.3}));
  CHECK(is_open(ball, {0.51, 0, -3.3}, {0.51, 0, 29.1})); // past it
  // A point without an area, which is deepest where its way begins.
  const mechanics::SurfacePoint vertex{0, {0, 0, -0.49}, 0, 1, Vector3d::UnitZ()};
  const Contact contact({{quarter_block::pressed_down(ball, Vector3d::Zero(), 0), {vertex}}});
  CHECK(contact.is_way_open([](int) { return Vector3d(0, 0, 0); }, 0,
                            [](int) { return Vector3d(0.3, 0, -0.01); }, 1));
}
