#include "compare/solve/estimate.hpp"

#include "cases/case/read_case.hpp"

#include <catch2/catch.hpp>
#include <map>

using namespace springproof;

using Catch::Contains;
using compare::BodySize;
using compare::Estimate;

namespace {

cases::Case cube(int cells) {
  cases::Case definition =
      cases::read_case(std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/sweep/cube_shear.toml");
  definition.measures.clear();
  std::get<cases::Box>(definition.body).cells = {cells, cells, cells};
  return definition;
}

BodySize body(const cases::Case& definition) {
  return compare::size_of(definition).value();
}

double cubed(double n) {
  return n * n * n;
}

compare::MemoryLimit limit(double megabytes) {
  return {megabytes, "the test", false};
}

} // namespace

TEST_CASE("a box has the size of its mesh before the mesh is made") {
  const cases::Case definition = cube(5);
  const BodySize before = body(definition), after = compare::size_of(cases::make_scene(definition));
  CHECK(before.n_nodes == after.n_nodes);
  CHECK(before.n_cells == after.n_cells);
  REQUIRE(before.outline.mesh.grid);
  CHECK(before.outline.mesh.grid->cells == after.outline.mesh.grid->cells);
  CHECK(before.outline.mesh.nodes.empty());
  cases::Case mesh = definition;
  mesh.body = cases::MeshFile{"no-such.msh", {}};
  CHECK_FALSE(compare::size_of(mesh));
}

TEST_CASE("unknowns are those of the refined mesh and the element") {
  cases::Case definition = cube(8);
  CHECK(compare::estimate_springs(body(definition)).unknowns == 3 * cubed(9));
  CHECK(compare::estimate_fem(body(definition)).unknowns == 3 * cubed(9));
  definition.fem.refine = 2;
  // Every edge is divided by four: the count of the surface's nodes leaves out edges, 2 % here.
  CHECK(compare::estimate_fem(body(definition)).unknowns == Approx(3 * cubed(33)).epsilon(0.05));
  definition.fem.refine = 0;
  definition.fem.element = cases::Element::q2;
  CHECK(compare::estimate_fem(body(definition)).unknowns == Approx(3 * cubed(17)).epsilon(0.05));
}

TEST_CASE("estimates name the solver that the model will take, and grow with the body") {
  cases::Case definition = cube(10);
  CHECK_THAT(compare::estimate_fem(body(definition)).model, Contains("matrix-free"));
  definition.fem.element = cases::Element::q2_p1; // which the grid's kernels do not know
  CHECK_THAT(compare::estimate_fem(body(definition)).model, Contains("factorised"));
  definition.fem.refine = 2;
  CHECK_THAT(compare::estimate_fem(body(definition)).model, Contains("assembled"));
  compare::BodySize tetrahedra = body(definition);
  tetrahedra.outline.mesh.grid.reset();
  tetrahedra.outline.definition.fem.element = cases::Element::p2_p1; // an indefinite tangent, however large
  CHECK_THAT(compare::estimate_fem(tetrahedra).model, Contains("factorised"));
  CHECK_THAT(compare::estimate_fem(tetrahedra).remedy, Contains("p2_p0"));
  std::map<std::string, Estimate> before; // by solver: from some size on a grid's takes over, and takes less
  for (const int n : {2, 6, 7, 8, 12, 30, 100})
    for (const Estimate& now :
         {compare::estimate_fem(body(cube(n))), compare::estimate_springs(body(cube(n)))}) {
      CAPTURE(n, now.model);
      CHECK(now.seconds > before[now.model].seconds);
      CHECK(now.megabytes > before[now.model].megabytes);
      CHECK(now.unknowns > before[now.model].unknowns);
      before[now.model] = now;
    }
  CHECK(before.size() == 4);
}

TEST_CASE("springs beside a tool are factorised at rest, and not in motion") {
  cases::Case definition = cube(40);
  definition.tools.emplace_back();
  const Estimate at_rest = compare::estimate_springs(body(definition));
  CHECK_THAT(at_rest.model, Contains("factorised"));
  CHECK(at_rest.megabytes > 1000);
  definition.dynamics = cases::Dynamics{};
  CHECK_THAT(compare::estimate_springs(body(definition)).model, Contains("matrix-free"));
}

TEST_CASE("the memory of models that were measured is announced") {
  cases::Case bar = cube(1); // rows of 17 and 33 nodes fill packs of 16 badly
  std::get<cases::Box>(bar.body).cells = {16, 16, 64};
  CHECK(compare::estimate_springs(body(bar)).megabytes > 27.7); // largest of sweeps' designs
  CHECK(compare::estimate_fem(body(bar)).megabytes > 78.1);     // log_strain q1_bbar
  bar.fem.element = cases::Element::q2;
  CHECK(compare::estimate_fem(body(bar)).megabytes > 754.8);
}

TEST_CASE("a question's models are those that it asks for, and of every mesh") {
  compare::Request request;
  CHECK(compare::estimate(body(cube(4)), request).size() == 2);
  request.only = cases::Side::msm;
  CHECK(compare::estimate(body(cube(4)), request).size() == 1);
  request = {};
  request.meshes = 3;
  const auto models = compare::estimate(body(cube(4)), request);
  REQUIRE(models.size() == 4);
  CHECK(compare::most_megabytes(models) == models[2].megabytes); // the finest mesh
  CHECK(compare::total_seconds(models) ==
        Approx(models[0].seconds + models[1].seconds + models[2].seconds + models[3].seconds));
}

TEST_CASE("fields need memory on both sides, and every static case makes them for its reactions") {
  cases::Case definition = cube(100);
  const auto of_static = compare::estimate(body(definition), {});
  definition.has_fields = true;
  CHECK(compare::estimate(body(definition), {}).front().megabytes == of_static.front().megabytes);
  definition.dynamics = cases::Dynamics{};
  const auto with = compare::estimate(body(definition), {});
  definition.has_fields = false;
  const auto without = compare::estimate(body(definition), {});
  REQUIRE(with.size() == without.size());
  for (std::size_t m = 0; m < with.size(); ++m) {
    CHECK(with[m].megabytes == Approx(without[m].megabytes + 400)); // a million cells
    CHECK(with[m].seconds == without[m].seconds);
  }
}

TEST_CASE("the bodies that a motion writes need memory") {
  cases::Case definition = cube(20);
  definition.dynamics.emplace();
  definition.dynamics->step = 1e-3;
  definition.dynamics->end = 1000;
  definition.dynamics->write_every = 1;
  const auto megabytes_with = [&](int write_every) {
    definition.dynamics->write_every = write_every;
    return compare::most_megabytes(compare::estimate(body(definition), {}));
  };
  CHECK_THROWS_WITH(compare::check_memory("x.toml", compare::estimate(body(definition), {}), limit(100)),
                    Contains("larger write_every"));
  const double bodies = 1e-6 * 2 * 24 * 21 * 21 * 21; // MB each
  CHECK(megabytes_with(1) - megabytes_with(1000) == Approx(999000 * bodies).epsilon(1e-3));
}

TEST_CASE("more memory than there is is refused with unknowns, estimate, limit and what to change") {
  const auto models = compare::estimate(body(cube(100)), {});
  CHECK_NOTHROW(compare::check_memory("cube.toml", models, limit(1e5)));
  CHECK_THROWS_WITH(compare::check_memory("cube.toml", models, limit(100)),
                    Contains("cube.toml: finite elements (matrix-free) with about 3.09e+06 unknowns") &&
                        Contains("GB of memory, and the test leaves 0.1 GB") && Contains("fewer cells"));
  CHECK_THROWS_AS(compare::check_memory("cube.toml", models, limit(-1)), cases::InputError);
  CHECK_THROWS_AS(compare::check_memory("cube.toml", {{"springs", 1, std::nan(""), 1}}, limit(1e9)),
                  cases::InputError);
}

TEST_CASE("a machine has to hold its ranks' part of a model, and a process its own") {
  cases::Case definition = cube(100);
  const compare::RanksOfMachine ranks{8, 2};
  const compare::MemoryLimit machine = limit(1), process{1, "ulimit -v", true};
  const Estimate fem = compare::estimate_fem(body(definition)),
                 alone = compare::estimate_springs(body(definition));
  definition.msm.solver = cases::Solver::snes;
  const Estimate shared = compare::estimate_springs(body(definition));
  for (const Estimate& model : {fem, shared}) {
    CHECK(compare::megabytes_within(machine, model, ranks) == Approx(model.megabytes / 4));
    CHECK(compare::megabytes_within(process, model, ranks) == Approx(model.megabytes / 8));
  }
  CHECK(compare::megabytes_within(machine, alone, ranks) == alone.megabytes);
  CHECK(compare::megabytes_within(process, alone, ranks) == alone.megabytes);
  const Estimate scene{"scene", 1, 100, 0, 100};
  CHECK(compare::megabytes_within(machine, scene, ranks) == 200);
  CHECK(compare::megabytes_within(process, scene, ranks) == 100);
}

TEST_CASE("finite elements in motion are divided among the ranks, but for their trajectory") {
  cases::Case definition = cube(40);
  definition.dynamics.emplace();
  definition.dynamics->step = 1e-3;
  definition.dynamics->end = 0.01;
  definition.dynamics->write_every = 10;
  const Estimate motion = compare::estimate(body(definition), {}).front();
  CHECK_FALSE(motion.is_on_first_rank);
  CHECK(motion.megabytes_of_each >= 1e-6 * 2 * 24 * 2 * cubed(41)); // two bodies kept
  CHECK(motion.megabytes > 226);                                    // measured: log_strain q1_bbar
  const double rest = motion.megabytes - motion.megabytes_of_each;
  CHECK(compare::megabytes_within(limit(1), motion, {2, 1}) == Approx(rest / 2 + motion.megabytes_of_each));
}

TEST_CASE("springs in motion are held by the first rank, and its trajectory by every rank") {
  cases::Case definition = cube(100);
  definition.dynamics.emplace();
  definition.dynamics->step = 1e-3;
  definition.dynamics->end = 1;
  definition.dynamics->write_every = 100;
  compare::Request request;
  request.only = cases::Side::msm;
  const Estimate motion = compare::estimate(body(definition), request).front();
  CHECK(motion.is_on_first_rank);
  const double bodies = 1e-6 * 2 * 24 * 11 * cubed(101); // MB of a trajectory of eleven
  CHECK(motion.megabytes_of_each == Approx(bodies));
  const compare::RanksOfMachine ranks{8, 2};
  CHECK(compare::megabytes_within(limit(1), motion, ranks) == Approx(motion.megabytes + bodies));
  CHECK(compare::megabytes_within({1, "ulimit -v", true}, motion, ranks) == Approx(motion.megabytes));
}

TEST_CASE("the machine's limit is at most its memory, and there is some left for a test") {
  const compare::MemoryLimit machine = compare::memory_limit();
  CHECK(machine.megabytes > 100);
  CHECK(machine.megabytes < 1e9);
  CHECK_FALSE(machine.of.empty());
}

TEST_CASE("as many questions are solved at the same time as have memory together, the largest first") {
  const std::vector<double> megabytes{1, 30, 20, 1};
  CHECK(compare::workers_within(limit(60), megabytes, 4) == 4);
  CHECK(compare::workers_within(limit(51), megabytes, 4) == 3);
  CHECK(compare::workers_within(limit(50), megabytes, 4) == 2);
  CHECK(compare::workers_within(limit(40), megabytes, 4) == 1);
  CHECK(compare::workers_within(limit(1), megabytes, 4) == 1);
  CHECK(compare::workers_within(limit(1000), megabytes, 2) == 2);
  CHECK(compare::workers_within({10, "ulimit -v", true}, megabytes, 4) == 4); // each process has its own
}

TEST_CASE("only long solves are announced, with every model's unknowns, memory and time") {
  CHECK(compare::long_solve_text("cube", compare::estimate(body(cube(10)), {})).empty());
  CHECK_THAT(compare::long_solve_text("cube", compare::estimate(body(cube(100)), {})),
             Contains("cube: finite elements (matrix-free): 3.09e+06 unknowns, about ") &&
                 Contains("; springs (matrix-free): 3.09e+06 unknowns, about "));
}

TEST_CASE("models in steps are not estimated by the grid's solvers, and take as long as their iterations") {
  cases::Case definition = cube(30);
  const Estimate solved = compare::estimate_springs(body(definition));
  definition.msm.real_time = cases::RealTime{cases::StepMethod::xpbd, 10, {}, {}, 0.01, 2, 2};
  const Estimate springs = compare::estimate_springs(body(definition));
  CHECK_THAT(springs.model, Contains("in steps"));
  CHECK(springs.megabytes == Approx(640).epsilon(0.2)); // as conjugate gradients took
  CHECK(springs.megabytes > 5 * solved.megabytes);
  definition.msm.real_time->substeps = 3;
  CHECK(compare::estimate_springs(body(definition)).seconds == Approx(3 * springs.seconds));
  definition.fem.real_time = cases::ElementRealTime{cases::ElementMethod::corotational, 10, {}, {}, 0.01, 2, 2};
  CHECK_THAT(compare::estimate_fem(body(definition)).model, Contains("in steps"));
}
