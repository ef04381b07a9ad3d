#include "msm/grid/grid_system.hpp"

#include "cases/case/error.hpp"
#include "mechanics/dense.hpp"
#include "msm/model.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using msm::Model;
using msm::Path;

namespace {

mechanics::EquilibriumSettings tight() {
  mechanics::EquilibriumSettings settings;
  settings.tolerance = 1e-11; // so that what differs is not the residual
  settings.lowest_eigenvalue = mechanics::LowestEigenvalue::report;
  return settings;
}

void check_agreement(const cases::Scene& scene, const std::vector<msm::CellStiffness>& stiffness) {
  const cases::Solution direct = Model(scene, stiffness, {Path::direct, 1}).solve(tight());
  const cases::Solution multigrid = Model(scene, stiffness, {Path::multigrid, 1}).solve(tight());
  CHECK(largest_difference(direct, multigrid) < 1e-8); // mm, as asked
  CHECK(multigrid.lowest_eigenvalue.value() ==
        Approx(direct.lowest_eigenvalue.value()).epsilon(0.01)); // 3 digits
  CHECK(multigrid.unknowns == direct.unknowns);
}

msm::CellStiffness with_exponents(msm::CellStiffness springs, const msm::Exponents& exponents) {
  springs.exponents = exponents;
  return springs;
}

msm::CellStiffness with_midlines(msm::CellStiffness springs) {
  springs.midline = 2.4 * springs.edge;
  springs.edge *= 0.4;
  return springs;
}

cases::Scene masked_scene() {
  cases::Grid grid;
  grid.cells = {7, 6, 8};
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 7; ++i) grid.present.push_back(!(i > 3 && j > 2 && k > 1) && !(i == 2 && j == 2));
  cases::Scene scene;
  scene.definition = bodies::clamped_box({7, 6, 8}, {});
  scene.mesh = cases::make_grid_mesh(grid);
  scene.constrained = {{cases::select(scene.mesh, bodies::region("z-")), {true, true, true}}};
  const cases::Load load = bodies::nodal_force("z+", {0.003, 0.001, 0.01});
  scene.loads = {{cases::select(scene.mesh, load.region), load}};
  return scene;
}

} // namespace

TEST_CASE("the multigrid path and the direct path find the same equilibrium", "[verification]") {
  SECTION("of a cube under large tension") {
    check_agreement(cases::make_scene(bodies::clamped_box({8, 8, 8}, bodies::tensile(0.05))),
                    {bodies::thesis_cell});
  }
  SECTION("of a box of odd numbers of cells under shear") {
    check_agreement(cases::make_scene(bodies::clamped_box({7, 9, 5}, bodies::shear(0.01))),
                    {bodies::thesis_cell});
  }
  SECTION("of a cube with a cell volume term under torsion") {
    check_agreement(cases::make_scene(bodies::clamped_box({8, 8, 8}, bodies::torsion(0.025))),
                    {bodies::hybrid_cell});
  }
  SECTION("of a cube of power-log springs under torsion") {
    check_agreement(cases::make_scene(bodies::clamped_box({8, 8, 8}, bodies::torsion(0.025))),
                    {with_exponents(bodies::hybrid_cell, {-1.3, -1.8, -2.2})});
  }
  SECTION("of a cube with midlines under torsion") {
    check_agreement(cases::make_scene(bodies::clamped_box({8, 8, 8}, bodies::torsion(0.025))),
                    {with_midlines(with_exponents(bodies::hybrid_cell, {-1.3, -1.8, -2.2}))});
  }
  SECTION("of a body with holes") {
    check_agreement(masked_scene(), {with_midlines(bodies::hybrid_cell)});
    check_agreement(masked_scene(), {bodies::hybrid_cell});
    check_agreement(masked_scene(), {with_exponents(bodies::hybrid_cell, {1.8, 1.8, 1.8})});
  }
  SECTION("of flat cells") {
    cases::Case flat = bodies::clamped_box({12, 12, 8}, bodies::tensile(0.02));
    flat.body = cases::Box{{12, 12, 0.8}, {12, 12, 8}};
    check_agreement(cases::make_scene(flat), {bodies::thesis_cell});
  }
  SECTION("of a cube of two materials") {
    const cases::Scene scene = cases::make_scene(bodies::clamped_box({6, 6, 6}, bodies::tensile(0.02)));
    std::vector<msm::CellStiffness> stiffness;
    for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
      stiffness.push_back(c % 6 < 3 ? bodies::thesis_cell : bodies::cell(310, 470, 330));
    check_agreement(scene, stiffness);
  }
}

TEST_CASE("an equilibrium does not depend on the number of threads") {
  const cases::Scene scene = cases::make_scene(bodies::clamped_box({14, 30, 40}, bodies::tensile(0.02)));
  const auto solve = [&](int n_threads) {
    mechanics::EquilibriumSettings settings;
    settings.tolerance = 1e-5; // all that differs is rounding, wherever Newton stops
    return Model(scene, {bodies::cell(31, 47, 33)}, {Path::multigrid, n_threads}).solve(settings);
  };
  CHECK(largest_difference(solve(1), solve(2)) < 1e-9); // mm, as asked
}

TEST_CASE("the multigrid path tells a mechanism and a limit point") {
  const auto outcome = [](const cases::Scene& scene, const msm::CellStiffness& stiffness) {
    try {
      return Model(scene, {stiffness}, {Path::multigrid, 1}).solve().outcome;
    } catch (const cases::SolveError& error) {
      return error.outcome();
    }
  };
  const cases::Scene cube = cases::make_scene(bodies::clamped_box({6, 6, 6}, bodies::tensile(0.02)));
  CHECK(outcome(cube, bodies::cell(31, 47, 33)) == cases::Outcome::stable_equilibrium);
  CHECK(outcome(cube, bodies::cell(31, 0, 0)) == cases::Outcome::mechanism);
  CHECK(outcome(cases::make_scene(bodies::clamped_box({4, 4, 4}, bodies::shear(0.01))),
                bodies::cell(23.3, 6.5, 22.7)) == cases::Outcome::limit_point);
}

TEST_CASE("the multigrid path refuses negative springs, two laws and a body that is no grid") {
  cases::Scene scene = cases::make_scene(bodies::clamped_box({2, 2, 2}, bodies::tensile(0.02)));
  std::vector<msm::CellStiffness> two_laws(8, bodies::thesis_cell);
  two_laws.back().exponents = {-1, -1, -1};
  CHECK_THROWS_AS(Model(scene, two_laws, {Path::multigrid, 1}), cases::InputError);
  CHECK_THROWS_AS(Model(scene, {bodies::cell(31, -4, 33)}, {Path::multigrid, 1}), cases::InputError);
  scene.mesh.grid.reset();
  CHECK_THROWS_AS(Model(scene, {bodies::cell(31, 47, 33)}, {Path::multigrid, 1}), cases::InputError);
}

TEST_CASE("a displacement that is no body's spoils nothing that comes after it") {
  const cases::Scene scene = cases::make_scene(bodies::clamped_box({10, 10, 10}, bodies::tensile(0.01)));
  const std::vector<msm::CellStiffness> springs = {bodies::cell(31, 47, 33)};
  const msm::Problem problem{scene.mesh, {}, cases::loaded_nodes(scene), cases::constrained_dofs(scene)};
  const msm::grid::GridProblem grid = msm::grid::make_grid_problem(problem, springs);
  const auto system = msm::grid::make_grid_system(grid, 1);
  const msm::Vector rest = msm::Vector::Zero(grid.load.size());
  const auto before = system->direction(rest, grid.load, 1, 1e-6, mechanics::Convexity::exact);
  REQUIRE(before);
  msm::Points collapsed; // every point in one place
  for (const Eigen::Vector3d& node : scene.mesh.nodes) collapsed.push_back(-node);
  const msm::Vector nonsense = msm::grid::to_field(problem, grid.body, collapsed);
  for (const double size : {1.0, 1e30}) { // beyond single precision
    const msm::Vector there = size * nonsense;
    system->direction(there, grid.load, 1, 1e-6, mechanics::Convexity::clamped);
    const auto after = system->direction(rest, grid.load, 1, 1e-6, mechanics::Convexity::exact);
    REQUIRE(after);
    CHECK((*after - *before).norm() <
          1e-4 * before->norm()); // 1e-6 of the forces, and how soft the softest is
  }
}

namespace {

using Place = std::array<int, 3>;

/// Cells of 4 x 3 x 3, held at some nodes.
msm::grid::Body body_of(const std::function<bool(const Place&)>& has_cell,
                        const std::function<bool(const Place&)>& is_held) {
  msm::grid::Body body;
  body.cells = {4, 3, 3};
  body.spacing = {1, 1.2, 0.8};
  msm::grid::for_each_place(body.cells, [&](int i, int j, int k) {
    body.springs.emplace_back();
    if (has_cell({i, j, k})) body.springs.back() = {{1, 1.1, 1.2}, {2, 2.1, 2.2}, 3, 0};
  });
  set_layout(body, [&](int i, int j, int k, int) { return is_held({i, j, k}); });
  return body;
}

/// Lowest eigenvalue of the tangent over the largest one.
double softest(const msm::grid::Body& body, const msm::grid::Field<double>& displacement) {
  const msm::grid::SpringField<double> springs(body, 1);
  msm::grid::Field<double> direction = msm::grid::Field<double>::Zero(3 * body.layout.size),
                           image = direction;
  std::vector<std::ptrdiff_t> free;
  msm::grid::for_each_place(body.layout.nodes, [&](int i, int j, int k) {
    for (int c = 0; c < 3; ++c)
      if (const auto entry = body.layout.at(i, j, k, c);
          !std::binary_search(body.constrained.begin(), body.constrained.end(), entry))
        free.push_back(entry);
  });
  Eigen::MatrixXd tangent(free.size(), free.size());
  for (std::size_t column = 0; column < free.size(); ++column) {
    direction[free[column]] = 1;
    springs.product(msm::Clamp::no, displacement, direction, image);
    direction[free[column]] = 0;
    for (std::size_t row = 0; row < free.size(); ++row)
      tangent(Eigen::Index(row), Eigen::Index(column)) = image[free[row]];
  }
  const Eigen::VectorXd all = mechanics::eigenvalues(tangent);
  return all[0] / all[all.size() - 1];
}

} // namespace

TEST_CASE("what counting calls rigid is, and hinges, balls and too few supports are not called so") {
  const auto at_wall = [](const Place& node) { return node[0] == 0; };
  const auto everywhere = [](const Place&) { return true; };
  const auto joined_at = [](const Place& second) { // joined to the cell 0, 0, 0
    return [second](const Place& cell) { return cell == Place{0, 0, 0} || cell == second; };
  };
  const auto held_at = [](const std::vector<Place>& nodes) {
    return [nodes](const Place& node) { return std::find(nodes.begin(), nodes.end(), node) != nodes.end(); };
  };
  const Place a{0, 0, 0}, b{0, 0, 1}, on_line{0, 0, 3}, off_line{0, 1, 0};
  const auto& [body, is_rigid] = GENERATE_COPY(table<msm::grid::Body, bool>(
      {{body_of(everywhere, at_wall), true},
       {body_of(joined_at({1, 0, 0}), at_wall), true},
       {body_of(joined_at({1, 1, 0}), at_wall), false},        // a hinge
       {body_of(joined_at({1, 1, 1}), at_wall), false},        // a ball
       {body_of(joined_at({0, 1, 1}), at_wall), true},         // a hinge, and both are held
       {body_of(everywhere, held_at({a, b, on_line})), false}, // it turns about the line
       {body_of(everywhere, held_at({a, b, off_line})), true},
       {body_of([](const Place& cell) { return (cell[0] + cell[1]) % 2 == 0 || cell[2] == 1; }, at_wall),
        true}}));
  CHECK(is_rigid_by_faces(body) == is_rigid);
  CHECK((softest(body, msm::grid::Field<double>::Zero(3 * body.layout.size)) > 1e-6) == is_rigid);
}

TEST_CASE("counting does not count on springs that are missing, negative or weak") {
  const auto all = [](const Place&) { return true; };
  msm::grid::Body body = body_of(all, [](const Place& node) { return node[2] == 0; });
  REQUIRE(is_rigid_by_faces(body));
  const double k = GENERATE(0.0, -1.0, 1e-4);
  body.springs[7].internal_diagonal = k;
  CHECK_FALSE(is_rigid_by_faces(body));
}

TEST_CASE("conjugate gradients tell a stable tangent from an unstable one as its eigenvalues do") {
  const bool has_gap = GENERATE(true, false);
  msm::grid::GridProblem problem;
  problem.body = body_of([&](const Place& cell) { return !has_gap || cell[1] != 1 || cell[0] == 0; },
                         [](const Place& node) { return node[0] == 0; });
  msm::grid::Field<double>& load = problem.load =
      msm::grid::Field<double>::Zero(3 * problem.body.layout.size);
  problem.n_unknowns = std::size_t(load.size()) - problem.body.constrained.size();
  int n_stable = 0, n_unstable = 0;
  for (int tenth = -3; tenth <= 6; ++tenth) { // stretched, pressed together
    msm::grid::Field<double> displacement =
        0.02 * msm::grid::random_field<double>(problem.body, 7, std::normal_distribution<double>());
    for (const std::ptrdiff_t entry : problem.body.constrained) displacement[entry] = 0;
    msm::grid::for_each_place(problem.body.layout.nodes, [&](int i, int j, int k) {
      if (i > 0 && has_cell(problem.body, i, j, k))
        displacement[problem.body.layout.at(i, j, k)] -= 0.1 * tenth * i;
    });
    const double lowest = softest(problem.body, displacement);
    INFO("lowest eigenvalue " << lowest << " of the largest");
    REQUIRE(std::abs(lowest) > 1e-6); // neither is near
    ++(lowest > 0 ? n_stable : n_unstable);
    CHECK(msm::grid::make_grid_system(problem, 1)->is_stable(displacement) == (lowest > 0));
  }
  CHECK(n_stable > 2);
  CHECK(n_unstable > 2);
}
