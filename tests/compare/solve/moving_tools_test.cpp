// Tools that move in time, in both models.

#include <fmt/format.h> // first: fmt 9 calls an unqualified compare()

#include "compare/measure/measure.hpp"
#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/case_text.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using namespace compare;
using Eigen::Vector3d;

namespace {

const std::string of_moving_tool =
    "[[measure]]\nname = 'force'\nkind = 'tool_force'\ntool = 'tool'\ncomponent = 'z'\n"
    "[[measure]]\nname = 'depth'\nkind = 'penetration'\ntool = 'tool'\n"
    "[[measure]]\nname = 'torque'\nkind = 'tool_torque'\ntool = 'tool'\ncomponent = 'y'\n"
    "[[measure]]\nname = 'area'\nkind = 'contact_area'\ntool = 'tool'\nover_time = 'peak'\n";

/// A soft block of a size in mm.
std::string block(const std::string& size, const std::string& cells, const std::string& supports,
                  const std::string& tool, const std::string& dynamics) {
  return fmt::format("schema = 1\nname = 'block'\n[body]\nshape = 'box'\nsize = {}\ncells = {}\n"
                     "[material]\nmodel = 'linear_elastic'\nyoungs_modulus = 0.01\npoissons_ratio = 0.3\n"
                     "density = 1000\n{}{}[[tool]]\nname = 'tool'\n{}"
                     "[dynamics]\n{}[fem]\nformulation = 'log_strain'\nelement = 'q1'\naccuracy = 'none'\n{}",
                     size, cells, dynamics.find("damping") == 0 ? "mass_damping = 20\n" : "", supports, tool,
                     dynamics.find("damping") == 0 ? dynamics.substr(8) : dynamics, of_moving_tool);
}

const std::string rollers = "[[symmetry]]\nplane = 'x-'\n[[symmetry]]\nplane = 'y-'\n"
                            "[[fixed]]\nregion = 'z-'\ncomponents = ['z']\n";

struct Solved {
  cases::Scene scene;
  Answer fem, msm;
};
Solved solved(const std::string& text) {
  cases::Scene scene = cases::make_scene(case_text::read_text(text));
  std::optional<msm::DesignResult> design;
  Solved all{scene, solve_fem_as_given(scene), solve_springs(scene, 1, design)};
  INFO(all.fem.solution.message << all.msm.solution.message);
  REQUIRE(all.fem.converged());
  REQUIRE(all.msm.converged());
  return all;
}

/// (1 - cos(2 pi t/T))/2 for a time T: in and out, without a jump of the velocity.
std::string in_and_out(double duration) {
  std::string points;
  constexpr int n = 200;
  for (int i = 0; i <= n; ++i)
    points += fmt::format("{}[{:.10g}, {:.10g}]", i > 0 ? ",\n" : "", duration * i / n,
                          (1 - std::cos(2 * M_PI * i / n)) / 2);
  return "history = [" + points + "]\n";
}

} // namespace

TEST_CASE("a plane that presses slowly does in the end what it does in statics", "[verification]") {
  const std::string plane = "shape = 'plane'\npoint = [0, 0, 3]\nnormal = [0, 0, -1]\n"
                            "displacement = [0, 0, -0.3]\n";
  std::string still = block("[4, 4, 3]", "[4, 4, 3]", rollers, plane, "");
  still = case_text::replaced(still, "[dynamics]\n", "");
  still = case_text::replaced(still, "over_time = 'peak'\n", "");
  const Solved pressed = solved(still),
               moved =
                   solved(block("[4, 4, 3]", "[4, 4, 3]", rollers, plane + "history = { ramp = [0, 1] }\n",
                                "damping scheme = 'implicit_euler'\nstep = 0.1\nend = 2\n"));
  for (const auto& [in_time, in_statics] :
       {std::pair(moved.fem, pressed.fem), std::pair(moved.msm, pressed.msm)}) {
    REQUIRE(in_time.solution.tools.size() == 1);
    // The penalty lets the plane into the surface by some thousandths of its way.
    CHECK(in_time.solution.tools[0].force.z() ==
          Approx(in_statics.solution.tools[0].force.z()).epsilon(0.01));
    CHECK(in_time.solution.tools[0].area == Approx(16));
    CHECK(in_time.solution.tools[0].penetration < 0.01 * 0.3);
  }
}

TEST_CASE("a motion is refused whose tool begins inside the body") {
  const auto begin_at = [](double z) {
    return cases::make_scene(case_text::read_text(
        block("[4, 4, 3]", "[4, 4, 3]", rollers,
              fmt::format("shape = 'sphere'\ncentre = [0, 0, {}]\nradius = 3\ndisplacement = [0, 0, -0.1]\n"
                          "history = {{ ramp = [0, 0.1] }}\n",
                          z),
              "damping scheme = 'implicit_euler'\nstep = 0.1\nend = 0.2\n")));
  };
  std::optional<msm::DesignResult> design;
  const auto is_inside = Catch::Contains("is 0.2 mm inside the body at time 0, must be outside");
  CHECK_THROWS_WITH(solve_springs(begin_at(5.8), 1, design), is_inside);
  CHECK_THROWS_WITH(solve_fem_as_given(begin_at(5.8)), is_inside);
  CHECK(solve_springs(begin_at(6), 1, design).converged());
}

TEST_CASE("the slowest vibration is that of the start, before friction holds a surface") {
  const auto slowest = [](double friction) {
    const Solved moved = solved(block("[4, 4, 3]", "[4, 4, 3]", "[[fixed]]\nregion = 'z-'\n",
                                      fmt::format("shape = 'plane'\nnormal = [0, 0, -1]\nfriction = {}\n"
                                                  "path = [[0, 0, 0, 3.1], [0.1, 0, 0, 2.9]]\n",
                                                  friction),
                                      "damping scheme = 'implicit_euler'\nstep = 0.02\nend = 0.1\n"));
    return std::array{moved.fem.solution.trajectory->slowest->omega,
                      moved.msm.solution.trajectory->slowest->omega};
  };
  const auto without = slowest(0), with = slowest(0.5);
  CHECK(with[0] == Approx(without[0]).epsilon(1e-2));
  CHECK(with[1] == Approx(without[1]).epsilon(1e-2));
}

TEST_CASE("a punch that comes in one step presses what it does in short ones", "[verification]") {
  const auto pressed = [](double step) {
    return solved(block("[4, 4, 3]", "[4, 4, 3]", rollers,
                        "shape = 'punch'\ncentre = [0, 0, 3]\nradius = 2.4\naxis = [0, 0, -1]\n"
                        "displacement = [0, 0, -0.8]\nhistory = { ramp = [0, 0.1] }\n",
                        fmt::format("damping scheme = 'implicit_euler'\nstep = {}\nend = 1\n", step)));
  };
  const Solved once = pressed(0.1), often = pressed(0.00625);
  for (const auto& [one, other] : {std::pair(once.fem, often.fem), std::pair(once.msm, often.msm)}) {
    const cases::ToolContact &here = one.solution.tools[0], &there = other.solution.tools[0];
    CHECK(here.force.z() == Approx(there.force.z()).epsilon(1e-3)); // both are at rest
    CHECK(here.nodes == there.nodes);
  }
}

TEST_CASE("a step begins with what a tool presses where the tool has gone") {
  const std::string ball = "shape = 'sphere'\ncentre = [0, 0, 14]\nradius = 10\n"
                           "displacement = [0, 0, -1]\nhistory = { sine = 1 }\n";
  constexpr int n_steps = 30;
  const Solved pressed =
      solved(block("[6, 6, 4]", "[6, 6, 4]", rollers, ball,
                   fmt::format("damping scheme = 'implicit_euler'\nstep = {}\nend = 0.5\n", 0.5 / n_steps)));
  // Where pressed points go on with their velocity in place of the tool's, elements take 7.6 iterations a
  // step and springs 4.1: what is not pressed any more is pressed again by the first direction.
  CHECK(pressed.fem.solution.newton_iterations < 3.6 * n_steps);
  CHECK(pressed.msm.solution.newton_iterations < 3.6 * n_steps);
}

TEST_CASE("what a tool gives a free body is its momentum", "[verification]") {
  // The plane comes along x, obliquely, and meets an edge of the body, which flies off and turns.
  const std::string plane = "shape = 'plane'\npoint = [-0.2, 0, 0]\nnormal = [1, 0, 0.2]\n"
                            "displacement = [1, 0, 0]\nhistory = { ramp = [0, 0.02] }\n";
  for (const char* scheme : {"'implicit_euler'", "'newmark'", "'bdf2'"}) {
    const Solved hit =
        solved(block("[3, 2, 2]", "[3, 2, 2]", "", plane,
                     fmt::format("scheme = {}\nstep = 0.0005\nend = 0.04\nwrite_every = 1\n", scheme)));
    INFO(scheme);
    for (const Answer* answer : {&hit.fem, &hit.msm}) {
      const cases::Trajectory& seen = *answer->solution.trajectory;
      REQUIRE(seen.tools.size() == seen.time.size());
      // Both models give a node an eighth of each of its cells, in all that a rigid velocity has.
      std::vector<double> mass(hit.scene.mesh.nodes.size(), 0);
      const cases::Mesh& mesh = hit.scene.mesh;
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
        for (const int node : mesh.cells[c]) mass[cases::index(node)] += 1e-9 / 8; // t, of 1 mm³
      const auto place = [&](std::size_t step) {
        Vector3d sum = Vector3d::Zero(); // mass times displacement
        for (std::size_t n = 0; n < mass.size(); ++n) sum += mass[n] * seen.bodies[step].displacement[n];
        return sum;
      };
      const double h = seen.time[1];
      Vector3d impulse = Vector3d::Zero(), largest = Vector3d::Zero();
      std::size_t n_pressed = 0;
      for (std::size_t step = 1; step < seen.time.size(); ++step) {
        n_pressed += !seen.tools[step].force.isZero(0);
        largest = largest.cwiseMax(seen.tools[step].force);
        if (scheme == std::string("'implicit_euler'")) impulse += h * seen.tools[step].force;
        if (scheme == std::string("'newmark'"))
          impulse += h / 2 * (seen.tools[step].force + seen.tools[step - 1].force);
        if (scheme == std::string("'bdf2'")) impulse += h * seen.tools[step].force;
      }
      CHECK(n_pressed > 3);
      CHECK(n_pressed < seen.time.size() / 2); // it has flown off
      const std::size_t end = seen.bodies.size() - 1;
      const Vector3d momentum = (place(end) - place(end - 1)) / h; // nothing acts any more
      CHECK(momentum.x() > 0);
      // bdf2's momentum is the impulse when all of it is in the past of two steps; its first step is Euler's.
      CHECK((momentum - impulse).norm() <= 1e-6 * momentum.norm());
    }
  }
}

TEST_CASE("the force of a ball that goes in and out at 60 Hz is smooth, and it stays out of the body",
          "[verification][long]") {
  const std::string ball = "shape = 'sphere'\ncentre = [0, 0, 16]\nradius = 10\n"
                           "displacement = [0, 0, -1.5]\n" +
                           in_and_out(1);
  for (const char* scheme :
       {"scheme = 'implicit_euler'", "scheme = 'bdf2'", "scheme = 'generalized_alpha'\nrho_infinity = 0"}) {
    const Solved pressed = solved(block("[9, 9, 6]", "[6, 6, 4]", rollers, ball,
                                        fmt::format("damping {}\nstep = {}\nend = 1\n", scheme, 1 / 60.)));
    INFO(scheme);
    for (const Answer* answer : {&pressed.fem, &pressed.msm}) {
      const TimeSeries force =
                           series_of(pressed.scene.definition.measures[0], pressed.scene, answer->solution),
                       depth =
                           series_of(pressed.scene.definition.measures[1], pressed.scene, answer->solution);
      const double peak = -*std::min_element(force.value.begin(), force.value.end());
      CHECK(peak > 0.01); // N
      // What a step adds to the course of its neighbours: the straight line between them goes as the tool
      // does.
      for (std::size_t n = 1; n + 1 < force.value.size(); ++n)
        CHECK(std::abs(force.value[n] - (force.value[n - 1] + force.value[n + 1]) / 2) <= 0.01 * peak);
      CHECK(*std::max_element(depth.value.begin(), depth.value.end()) < 0.01 * 1.5);
      CHECK(*std::max_element(depth.value.begin(), depth.value.end()) > 0);
    }
  }
}
