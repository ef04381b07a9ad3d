#include "cases/case/error.hpp"
#include "mechanics/ranks/share_out.hpp"
#include "msm/grid/transfer.hpp"
#include "msm/model.hpp"
#include "msm/snes/snes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/with_mpi.hpp"

#include <catch2/catch.hpp>
#include <petscsys.h>

// Runs on one rank by itself, and on several under mpirun (compare/grid_on_*_ranks).

using namespace springproof;

using msm::grid::Body;
using msm::grid::Field;

namespace {

mechanics::EquilibriumSettings to_rounding() {
  mechanics::EquilibriumSettings settings;
  settings.tolerance = 1e-11; // so that what is compared is the answers, not where the solvers stop
  return settings;
}

int n_ranks() {
  int n = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &n);
  return n;
}

cases::Scene scene_of(cases::Case body) {
  return cases::make_scene(body);
}

cases::Scene masked_scene() {
  cases::Grid grid;
  grid.cells = {13, 12, 15};
  msm::grid::for_each_place(grid.cells, [&](int i, int j, int k) {
    grid.present.push_back(!(i > 6 && j > 5 && k > 3) && !(i == 2 && j == 2) && !(k == 7 && i < 2));
  });
  cases::Scene scene;
  scene.definition = bodies::clamped_box(grid.cells, {});
  scene.mesh = cases::make_grid_mesh(grid);
  scene.constrained = {{cases::select(scene.mesh, bodies::region("z-")), {true, true, true}}};
  const cases::Load load = bodies::nodal_force("z+", {0.001, 0.0005, 0.004});
  scene.loads = {{cases::select(scene.mesh, load.region), load}};
  return scene;
}

cases::Case moved_box() {
  cases::Case box = bodies::clamped_box({12, 11, 13}, {});
  cases::Moved twisted;
  twisted.region = bodies::region("z+");
  twisted.angle = 20;
  twisted.centre = {6, 5.5, 13};
  twisted.displacement = {0, 0, 0.5};
  box.moved = {twisted};
  return box;
}

cases::Case quarter_of_a_box() {
  cases::Case quarter = bodies::clamped_box({13, 9, 12}, bodies::tensile(0.02));
  quarter.symmetry = {{bodies::region("x-"), {true, false, false}},
                      {bodies::region("y-"), {false, true, false}}};
  return quarter;
}

/// A plate of flat cells, which is coarsened along its thickness first.
cases::Case flat_cells() {
  cases::Case flat = bodies::clamped_box({14, 12, 8}, bodies::tensile(0.004));
  flat.body = cases::Box{{14, 12, 0.8}, {14, 12, 8}};
  return flat;
}

/// A grid with holes, held at one end, with a volume term.
Body body_with_holes(const std::array<int, 3>& cells) {
  Body body;
  body.cells = cells;
  body.spacing = {1, 1, 1};
  msm::grid::for_each_place(cells, [&](int i, int j, int k) {
    body.springs.push_back({{0.02, 0.02, 0.02}, {0.025, 0.025, 0.025}, 0.02, 0.14});
    if ((i + 2 * j + 3 * k) % 11 == 0) body.springs.back() = {};
  });
  set_layout(body, [](int, int, int k, int) { return k == 0; });
  return body;
}
Body uniform_body(const std::array<int, 3>& cells) {
  Body body = body_with_holes(cells);
  body.springs = {{{0.02, 0.02, 0.02}, {0.025, 0.025, 0.025}, 0.02, 0.14}};
  set_layout(body, [](int, int, int k, int) { return k == 0; });
  return body;
}

/// Largest difference between a field of a body and of what a rank has of it, ghosts and all.
template<class Real>
double difference_here(const Body& whole, const Field<Real>& all, const Body& here, const Field<Real>& part) {
  double largest = 0;
  const std::array<int, 3> first = here.part ? here.part->first : std::array<int, 3>{0, 0, 0};
  for (int c = 0; c < 3; ++c)
    msm::grid::for_each_place(here.layout.nodes, [&](int i, int j, int k) {
      largest = larger(largest, std::abs(part[here.layout.at(i, j, k, c)] -
                                         all[whole.layout.at(first[0] + i, first[1] + j, first[2] + k, c)]));
    });
  return largest;
}

/// Counts what a rank takes part in.
class CountingRanks : public msm::grid::Ranks {
 public:
  struct Calls {
    int exchanges = 0, reductions = 0;
  };
  CountingRanks(std::shared_ptr<const Ranks> ranks, Calls& calls) : ranks_(std::move(ranks)), calls_(calls) {}
  void update_ghosts(double* field) const override { ++calls_.exchanges, ranks_->update_ghosts(field); }
  void update_ghosts(float* field) const override { ++calls_.exchanges, ranks_->update_ghosts(field); }
  void sum(double* values, std::size_t n) const override { ++calls_.reductions, ranks_->sum(values, n); }
  void sum(float* values, std::size_t n) const override { ++calls_.reductions, ranks_->sum(values, n); }
  double largest(double value) const override { return ++calls_.reductions, ranks_->largest(value); }

 private:
  std::shared_ptr<const Ranks> ranks_;
  Calls& calls_;
};

Body counted(Body body, CountingRanks::Calls& calls) {
  if (!body.part) return body;
  msm::grid::Part& part = *body.part;
  part.ranks = std::make_shared<CountingRanks>(part.ranks, calls);
  const bool is_whole = part.coarser && !part.coarser->part;
  if (part.coarser_here) part.coarser_here = std::make_shared<Body>(counted(*part.coarser_here, calls));
  if (!is_whole) part.coarser = part.coarser_here;
  return body;
}

Field<double> any_field(const Body& body, unsigned seed) {
  return msm::grid::random_field<double>(body, seed, std::normal_distribution<double>());
}

} // namespace

TEST_CASE_METHOD(WithMpi,
                 "a grid's equilibrium is the same on any number of ranks, and on full bodies the way to it",
                 "[ranks][long]") {
  msm::CellStiffness hooke = bodies::hybrid_cell, power_log = hooke;
  power_log.exponents = {-1.3, -1.8, -2.2};
  // Bodies with holes have merged cells on one rank and rediscretised lattices on several: another way.
  const auto [name, scene, cell, is_full] =
      GENERATE_REF(table<std::string, cases::Scene, msm::CellStiffness, bool>(
          {{"box", scene_of(bodies::clamped_box({16, 16, 16}, bodies::shear(0.003))), hooke, true},
           {"mask", masked_scene(), hooke, false},
           {"mask of power-log springs", masked_scene(), power_log, false},
           {"moved supports", scene_of(moved_box()), hooke, true},
           {"symmetry planes", scene_of(quarter_of_a_box()), hooke, true},
           {"flat cells", scene_of(flat_cells()), hooke, true}}));
  INFO(name);
  const std::vector<msm::CellStiffness> springs{cell};
  const cases::Solution alone = msm::solve_by_snes(scene, springs, PETSC_COMM_SELF, to_rounding());
  const cases::Solution together = msm::solve_by_snes(scene, springs, PETSC_COMM_WORLD, to_rounding());
  const double size = largest_displacement(alone);
  REQUIRE(size > 0.1); // mm: the load does something
  CHECK(largest_difference(alone, together) <= 1e-9 * size);
  CHECK(together.outcome == alone.outcome);
  CHECK(together.inverted_cells == alone.inverted_cells);
  if (is_full) { // the same method, rounded in another order
    CHECK(together.newton_iterations == alone.newton_iterations);
    const auto n_linear = static_cast<double>(together.linear_iterations);
    CHECK(n_linear == Approx(static_cast<double>(alone.linear_iterations)).epsilon(0.2));
  }
  const cases::Solution assembled = msm::Model(scene, springs, {msm::Path::direct, 1}).solve(to_rounding());
  CHECK(largest_difference(assembled, together) <= 1e-8); // mm
  // strains are differences of displacements that agree to 1e-9, over a cell's edge
  CHECK(largest_difference(msm::fields(scene, springs, alone), msm::fields(scene, springs, together),
                           part_of(alone, together)) <= 1e-7);
}

TEST_CASE_METHOD(WithMpi, "cells of terms and networks have the same fields on any number of ranks",
                 "[ranks]") {
  const cases::Scene scene = scene_of(bodies::clamped_box({5, 4, 6}, bodies::tensile(0.004)));
  const msm::BodyTerms terms{{msm::terms_of(bodies::hybrid_cell)}, {}, msm::Boundary::whole};
  const auto solved = [&](MPI_Comm communicator) {
    return msm::solve_by_snes(scene, terms, communicator, to_rounding());
  };
  cases::Solution alone = solved(PETSC_COMM_SELF), together = solved(PETSC_COMM_WORLD);
  const cases::Share here = part_of(alone, together);
  CHECK(largest_difference(msm::fields(scene, terms, alone), msm::fields(scene, terms, together), here) <=
        1e-7);
  msm::Network network; // its springs without the volume terms: not in balance
  for (const auto& [i, j, spring] : msm::make_lattice(scene.mesh, terms).links)
    network.push_back({i, j, spring.stiffness, {}, {}});
  alone.status = together.status = cases::Status::skipped;
  const cases::Fields one = msm::fields(scene, network, alone), part = msm::fields(scene, network, together);
  CHECK(part.total_energy == Approx(one.total_energy).epsilon(1e-7));
  const auto norm = [](const auto& v) { return v.norm(); };
  CHECK(largest_difference(one.reaction, part.reaction, here.nodes.begin, norm) <= 1e-9); // N
  CHECK_FALSE(part.has_stress);
  CHECK(part.strain.size() == (together.sharing ? here.cells.size() : scene.mesh.cells.size()));
}

TEST_CASE_METHOD(WithMpi, "ranks add up what they give of nodes, and deal out and gather cells' tensors",
                 "[ranks]") {
  const cases::Mesh mesh = cases::make_box_mesh({4, 4, 9}, {4, 4, 9});
  const auto sharing = mechanics::share_out(mesh, PETSC_COMM_WORLD);
  REQUIRE((sharing != nullptr) == (n_ranks() > 1));
  if (!sharing) return;
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  const double n = n_ranks();
  std::vector<cases::Numbered<Eigen::Vector3d>> of_nodes;
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node)
    of_nodes.push_back({std::int64_t(node), {double(node), double(rank), 1}});
  const auto sums = sharing->add_up(of_nodes);
  const cases::Share& here = sharing->here();
  REQUIRE(sums.size() == here.nodes.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
    CHECK(sums[i] == Eigen::Vector3d(n * double(here.nodes.begin + i), n * (n - 1) / 2, n));
  std::vector<cases::SymmetricTensor> tensors;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) tensors.push_back({double(c), 1, 2, 3, 4, -double(c)});
  std::vector<cases::Numbered<cases::SymmetricTensor>> of_cells; // half of each by the first two ranks
  for (std::size_t c = 0; c < tensors.size() && rank < 2; ++c) {
    of_cells.push_back({std::int64_t(c), tensors[c]});
    for (double& value : of_cells.back().value) value /= 2;
  }
  const auto dealt = cases::deal(*sharing, of_cells);
  REQUIRE(dealt.size() == here.cells.size());
  for (std::size_t i = 0; i < dealt.size(); ++i) CHECK(dealt[i] == tensors[here.cells.begin + i]);
  CHECK(cases::gather(*sharing, dealt) == tensors);
}

TEST_CASE_METHOD(WithMpi, "operators on parts of a grid give what they give on the whole of it", "[ranks]") {
  Body whole = GENERATE(body_with_holes({13, 11, 12}), uniform_body({13, 11, 12}));
  whole.exponents = GENERATE(as<std::optional<msm::Exponents>>{}, std::nullopt,
                             std::optional(msm::Exponents{-1.3, -1.8, 2.2}));
  if (GENERATE(true, false)) // the cells have midlines
    for (msm::grid::CellSprings& cell : whole.springs)
      if (cell.internal_diagonal > 0) cell.midline = {0.02, 0.03, 0.05};
  const Body here = msm::deal_out_to(PETSC_COMM_WORLD)(whole);
  REQUIRE(here.part.has_value() == (n_ranks() > 1));
  const Field<double> u = 0.05 * any_field(whole, 1), v = any_field(whole, 2);
  const Field<double> u_here = 0.05 * any_field(here, 1), v_here = any_field(here, 2);
  CHECK(difference_here(whole, u, here, u_here) == 0);
  // Sums over nodes or springs are the same but for their order.
  CHECK(dot(here, u_here, v_here, 1) == Approx(dot(whole, u, v, 1)).epsilon(1e-12));
  const msm::grid::SpringField<double> all(whole, 1), some(here, 1);
  CHECK(some.energy(u_here) == Approx(all.energy(u)).epsilon(1e-12));
  Field<double> product = 0 * u, product_here = 0 * u_here;
  all.product(msm::Clamp::no, u, v, product);
  some.product(msm::Clamp::no, u_here, v_here, product_here);
  CHECK(difference_here(whole, product, here, product_here) < 1e-13); // N, of about 0.1
  all.inverse_diagonal(msm::Clamp::yes, u, product);
  some.inverse_diagonal(msm::Clamp::yes, u_here, product_here);
  CHECK(difference_here<double>(whole, product.head(3 * whole.layout.size), here,
                                product_here.head(3 * here.layout.size)) < 1e-10); // mm/N, of about 10

  const Body coarse = coarsen(whole).value(), coarse_here = coarsen(here).value();
  const msm::grid::Transfer<double> transfer(whole, coarse, 1), transfer_here(here, coarse_here, 1);
  Field<double> on_coarse = Field<double>::Zero(3 * coarse.layout.size),
                on_coarse_here = Field<double>::Zero(3 * coarse_here.layout.size);
  transfer.restrict(v, on_coarse);
  transfer_here.restrict(v_here, on_coarse_here);
  CHECK(difference_here(coarse, on_coarse, coarse_here, on_coarse_here) < 1e-13);
  transfer.prolong(on_coarse, product = 0 * u);
  transfer_here.prolong(on_coarse_here, product_here = 0 * u_here);
  CHECK(difference_here(whole, product, here, product_here) < 1e-13);
}

TEST_CASE_METHOD(WithMpi, "what ranks own is the body, and coarser parts lie within finer ones", "[ranks]") {
  const Body whole = uniform_body({40, 21, 33});
  Body here = msm::deal_out_to(PETSC_COMM_WORLD)(whole);
  int n_parts = 0;
  for (Body all = whole; here.part; here = coarsen(here).value(), all = coarsen(all).value(), ++n_parts) {
    const msm::grid::Part& part = *here.part;
    double n_own = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      n_own *= part.own_last[a] - part.own_first[a];
      CHECK(part.own_last[a] > part.own_first[a]);
    }
    part.ranks->sum(&n_own, 1);
    CHECK(n_own == double(all.layout.nodes[0]) * all.layout.nodes[1] * all.layout.nodes[2]);
  }
  CHECK(n_parts == (n_ranks() > 1 ? 2 : 0)); // grids of 41 x 22 x 34 and 21 x 12 x 18 nodes
}

TEST_CASE_METHOD(WithMpi, "a grid too small to be dealt out is solved whole by every rank", "[ranks]") {
  const cases::Scene scene = scene_of(bodies::clamped_box({8, 8, 8}, bodies::tensile(0.02)));
  const cases::Solution alone =
      msm::solve_by_snes(scene, {bodies::thesis_cell}, PETSC_COMM_SELF, to_rounding());
  const cases::Solution together =
      msm::solve_by_snes(scene, {bodies::thesis_cell}, PETSC_COMM_WORLD, to_rounding());
  CHECK(largest_difference(alone, together) == 0);
}

TEST_CASE_METHOD(WithMpi, "a cycle's messages are those that docs/developing/scale.md counts", "[ranks]") {
  CountingRanks::Calls calls;
  const Body here = counted(msm::deal_out_to(PETSC_COMM_WORLD)(uniform_body({40, 21, 33})), calls);
  msm::grid::SpringLevels multigrid(here, 1);
  multigrid.linearise(0.05 * any_field(here, 1));
  const Field<double> right = any_field(here, 2);
  Field<double> found = right;
  calls = {};
  multigrid.apply(right, found);
  const int n_levels = n_ranks() > 1 ? 2 : 0; // that are dealt out
  CHECK(calls.exchanges == 7 * n_levels);
  CHECK(calls.reductions == (n_ranks() > 1 ? 2 : 0)); // the norm, and the first level that all ranks have
}

TEST_CASE_METHOD(WithMpi, "a load that cannot be carried ends on several ranks where it ends on one",
                 "[ranks]") {
  const auto end = [](MPI_Comm communicator, const cases::Scene& scene, const msm::CellStiffness& springs) {
    mechanics::EquilibriumSettings settings;
    settings.smallest_load_step = 5e-3;
    try {
      msm::solve_by_snes(scene, {springs}, communicator, settings);
    } catch (const cases::SolveError& error) {
      return std::pair(error.outcome(), error.load_reached());
    }
    return std::pair(cases::Outcome::stable_equilibrium, 1.0);
  };
  const auto& [shear, springs, outcome] = GENERATE(table<double, msm::CellStiffness, cases::Outcome>(
      {{0.01, bodies::cell(23.3, 6.5, 22.7), cases::Outcome::limit_point},
       {0.001, bodies::cell(31, 0, 0), cases::Outcome::mechanism}}));
  const cases::Scene scene = scene_of(bodies::clamped_box({10, 10, 10}, bodies::shear(shear)));
  const auto alone = end(PETSC_COMM_SELF, scene, springs), together = end(PETSC_COMM_WORLD, scene, springs);
  CHECK(alone.first == outcome);
  CHECK(together.first == outcome);
  CHECK(std::abs(together.second - alone.second) <= 0.01); // both end within twice the smallest step
}
