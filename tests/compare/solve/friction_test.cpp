// Coulomb friction of rigid tools, in both models.

#include <fmt/format.h> // first: fmt 9 calls an unqualified compare()

#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

using namespace springproof;

using namespace compare;
using Eigen::Vector3d;

namespace {

/// A block of 4 x 4 x 3 mm, whose sides along y stay in their planes: nothing slips across x.
std::string block_between_walls(const std::string& acts, const std::string& element = "q1") {
  return fmt::format(
      "schema = 1\nname = 'block'\n[body]\nshape = 'box'\nsize = [4, 4, 3]\ncells = [4, 4, 3]\n"
      "[material]\nmodel = 'linear_elastic'\nyoungs_modulus = 0.01\npoissons_ratio = 0.3\n"
      "density = 1000\n[[symmetry]]\nplane = 'y-'\n[[fixed]]\nregion = 'y+'\ncomponents = ['y']\n"
      "[[fixed]]\nregion = 'z-'\n{}"
      "[fem]\nformulation = 'log_strain'\nelement = '{}'\naccuracy = 'none'\n"
      "[[measure]]\nname = 'floor'\nkind = 'reaction'\nregion = 'z-'\ncomponent = 'z'\n",
      acts, element);
}

/// A plane on the block's top that goes down by 0.3 mm and along x.
std::string plane(double along, const std::string& keys) {
  return fmt::format("[[tool]]\nname = 'tool'\nshape = 'plane'\npoint = [0, 0, 3]\nnormal = [0, 0, -1]\n"
                     "displacement = [{}, 0, -0.3]\n{}\n",
                     along, keys);
}

struct Rubbed {
  cases::Scene scene;
  Answer fem, msm;
};
Rubbed rubbed(const std::string& text) {
  cases::Scene scene = cases::make_scene(case_text::read_text(text));
  std::optional<msm::DesignResult> design;
  Rubbed all{scene, solve_fem_as_given(scene), solve_springs(scene, 1, design)};
  INFO(all.fem.solution.message << all.msm.solution.message);
  REQUIRE(all.fem.converged());
  REQUIRE(all.msm.converged());
  return all;
}

/// What a tool does to nodes, by their numbers; elements name vertices that bear nothing too.
std::map<int, Vector3d> forces_on_nodes(const cases::ToolContact& tool) {
  std::map<int, Vector3d> all;
  for (std::size_t n = 0; n < tool.nodes.size(); ++n)
    if (tool.on_nodes[n].norm() > 1e-12 * tool.force.norm()) all[tool.nodes[n]] = tool.on_nodes[n];
  return all;
}

} // namespace

TEST_CASE("a plane that slips over a block rubs it by the coefficient times its force", "[verification]") {
  for (const char* element : {"q1", "q1_bbar", "q2"})
    for (const double friction : {0.1, 0.4})
      for (const int steps : {1, 3}) {
        if (element != std::string("q1") && (friction != 0.4 || steps != 1)) continue; // they take long
        const Rubbed slipped = rubbed(block_between_walls(
            plane(2, fmt::format("friction = {}\nsteps = {}", friction, steps)), element));
        INFO(element << ", " << friction << ", " << steps << " steps");
        for (const Answer* answer : {&slipped.fem, &slipped.msm}) {
          const cases::ToolContact& tool = answer->solution.tools.front();
          CHECK(tool.force.x() > 0);
          CHECK(tool.force.x() == Approx(-friction * tool.force.z()).epsilon(1e-6));
          CHECK(std::abs(tool.force.y()) < 1e-6 * tool.force.x());
        }
      }
}

TEST_CASE("a plane that sticks to a block takes its top along", "[verification]") {
  const Rubbed stuck = rubbed(block_between_walls(plane(0.02, "friction = 5"))),
               bonded = rubbed(block_between_walls("[[moved]]\nregion = 'z+'\ncomponents = ['x', 'z']\n"
                                                   "displacement = [0.02, 0, -0.3]\n"));
  const std::vector<int> top = cases::select(stuck.scene.mesh, {"z+"}).nodes;
  for (const auto& [by_tool, held] :
       {std::pair(&stuck.fem, &bonded.fem), std::pair(&stuck.msm, &bonded.msm)}) {
    const cases::ToolContact& tool = by_tool->solution.tools.front();
    const std::map<int, Vector3d> forces = forces_on_nodes(tool);
    CHECK(forces.size() == top.size());
    for (const auto& [node, force] : forces) CHECK(force.head<2>().norm() < -5 * force.z()); // it sticks
    for (const int node : top) {
      const Vector3d difference = by_tool->solution.displacement[cases::index(node)] -
                                  held->solution.displacement[cases::index(node)];
      CHECK(difference.head<2>().norm() < 1e-6 * 0.3);
      CHECK(std::abs(difference.z()) < 1e-3 * 0.3); // what pressures are settled to
    }
  }
}

TEST_CASE("a ball that is pressed in sideways rubs no node by more than the law allows", "[verification]") {
  constexpr double friction = 0.3;
  const Vector3d centre(2.1, 2, 5.6);
  const std::string element = GENERATE(as<std::string>{}, "q1", "q1_bbar");
  CAPTURE(element);
  const Rubbed pressed = rubbed(block_between_walls(
      fmt::format("[[tool]]\nname = 'tool'\nshape = 'sphere'\ncentre = [2, 2, 6]\nradius = 3\n"
                  "displacement = [0.1, 0, -0.4]\nfriction = {}\nsteps = 4\n",
                  friction),
      element));
  for (const Answer* answer : {&pressed.fem, &pressed.msm}) {
    const cases::ToolContact& tool = answer->solution.tools.front();
    CHECK(tool.force.x() > 0);
    int n_stuck = 0;
    for (const auto& [node, force] : forces_on_nodes(tool)) {
      const std::size_t n = cases::index(node);
      const Vector3d normal =
          (pressed.scene.mesh.nodes[n] + answer->solution.displacement[n] - centre).normalized();
      const double pushed = force.dot(normal), along = (force - pushed * normal).norm();
      CHECK(along < friction * pushed + 1e-5 * tool.force.norm());
      n_stuck += along < 0.99 * friction * pushed;
    }
    CHECK(n_stuck > 0);
  }
}

TEST_CASE("without friction a tool has the digits that it has without the key") {
  const auto same = [](const std::string& without, const std::string& with) {
    const Rubbed one = rubbed(without), other = rubbed(with);
    for (const auto& [a, b] : {std::pair(&one.fem, &other.fem), std::pair(&one.msm, &other.msm)}) {
      CHECK(a->solution.tools.front().force == b->solution.tools.front().force);
      CHECK(a->solution.tools.front().torque == b->solution.tools.front().torque);
      CHECK(a->solution.displacement == b->solution.displacement);
    }
  };
  same(block_between_walls(plane(0.1, "")), block_between_walls(plane(0.1, "friction = 0")));
}

namespace {

constexpr double gravity = 9810; // mm/s²

/// A cube of 2 mm between walls across y, which lies free on a plane that moves along x at a speed (mm/s).
std::string block_on_belt(double speed, double friction, const std::string& dynamics) {
  return fmt::format(
      "schema = 1\nname = 'belt'\n[body]\nshape = 'box'\nsize = [2, 2, 2]\ncells = [2, 2, 2]\n"
      "[material]\nmodel = 'linear_elastic'\nyoungs_modulus = 0.01\npoissons_ratio = 0.3\n"
      "density = 1000\n[[symmetry]]\nplane = 'y-'\n[[fixed]]\nregion = 'y+'\ncomponents = ['y']\n"
      "[[load]]\nkind = 'gravity'\nvalue = [0, 0, -9.81]\n"
      "[[tool]]\nname = 'tool'\nshape = 'plane'\npoint = [0, 0, 0]\nnormal = 'z'\n"
      "displacement = [{}, 0, 0]\nhistory = {{ ramp = [0, 1] }}\nfriction = {}\n"
      "[dynamics]\n{}write_every = 1\n"
      "[fem]\nformulation = 'log_strain'\nelement = 'q1'\naccuracy = 'none'\n"
      "[[measure]]\nname = 'force'\nkind = 'tool_force'\ntool = 'tool'\ncomponent = 'x'\n",
      speed, friction, dynamics);
}

} // namespace

TEST_CASE("a block on a belt is sped up by the coefficient times gravity, until it has the belt's speed",
          "[verification]") {
  constexpr double friction = 0.3, speed = 60, h = 0.0005, end = 0.04; // mm/s, s
  const Rubbed all = rubbed(block_on_belt(
      speed, friction, fmt::format("scheme = 'implicit_euler'\nstep = {}\nend = {}\n", h, end)));
  const double slips_for = speed / (friction * gravity); // s
  REQUIRE(slips_for < 0.6 * end);
  const cases::Mesh& mesh = all.scene.mesh;
  std::vector<double> share(mesh.nodes.size(), 0); // parts of the mass
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const int node : mesh.cells[c]) share[cases::index(node)] += 1. / 64;
  for (const Answer* answer : {&all.fem, &all.msm}) {
    const cases::Trajectory& seen = *answer->solution.trajectory;
    REQUIRE(seen.bodies.size() == seen.time.size());
    const auto place = [&](std::size_t step) {
      Vector3d mean = Vector3d::Zero();
      for (std::size_t n = 0; n < share.size(); ++n) mean += share[n] * seen.bodies[step].displacement[n];
      return mean;
    };
    std::size_t n_slipping = 0;
    Vector3d velocity = Vector3d::Zero(); // this scheme's, of the centre of mass
    for (std::size_t step = 1; step < seen.time.size(); ++step) {
      velocity = (place(step) - place(step - 1)) / h;
      const Vector3d& force = seen.tools[step].force;
      CHECK(std::hypot(force.x(), force.y()) <= friction * force.z() * (1 + 1e-6));
      if (seen.time[step] > 0.9 * slips_for) continue;
      ++n_slipping;
      CHECK(force.x() == Approx(friction * force.z()).epsilon(1e-6));
      if (step == 1) continue; // elements halve it: its places do not tell the velocity at its end
      // The plane bears the weight, and what the fall's momentum along z has taken up.
      CHECK(velocity.x() == Approx(friction * (gravity * seen.time[step] + velocity.z())).epsilon(2e-6));
    }
    CHECK(n_slipping > 30);
    CHECK(velocity.x() == Approx(speed).epsilon(0.01)); // it shears to and fro, less and less
  }
}
