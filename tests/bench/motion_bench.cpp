#include "cases/case/read_case.hpp"
#include "cases/mesh/mesh.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/dynamics/time_integrator.hpp"
#include "msm/grid/moving_grid.hpp"
#include "msm/model.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

using namespace springproof;

namespace motions {

namespace {

/// A body on a grid, its springs in motion on the grid path.
struct Moving {
  msm::Problem problem;
  msm::grid::GridProblem grid;
  msm::grid::NodeVectors vectors;
  std::unique_ptr<msm::grid::GridSystem> statics;
  std::unique_ptr<msm::MovingSprings> motion;

  Moving(msm::Problem of, const msm::CellStiffness& cell, const msm::Inertia& inertia, int n_threads)
      : problem(std::move(of)), grid(msm::grid::make_grid_problem(problem, {cell})), vectors(grid.body),
        statics(msm::grid::make_grid_system(grid, n_threads)),
        motion(msm::grid::make_moving_grid(problem, grid, vectors, *statics, inertia, {}, n_threads)) {}
  Moving(const Moving&) = delete; // the others refer to its problem
};

/// A problem whose nodes are held up to a height.
msm::Problem held_at(const cases::Mesh& mesh, double height) {
  msm::Problem problem{mesh, {}, {}, std::vector<bool>(3 * mesh.nodes.size()), {}};
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (mesh.nodes[n].z() < height + 1e-6)
      for (std::size_t c = 0; c < 3; ++c) problem.is_constrained[3 * n + c] = true;
  return problem;
}

constexpr int n_warm = 10;  ///< steps that are not timed
constexpr int n_rounds = 4; ///< times that a tool goes in and out

/// Timed steps, under loads that go on for ever.
void run_steps(benchmark::State& state, msm::MovingSprings& body, const msm::Vector& rest, double n_unknowns,
               double step, mechanics::IntegrationSettings settings) {
  settings.newton.max_newton_iterations = 1 << 30;
  mechanics::TimeIntegrator motion(body, {cases::Scheme::implicit_euler}, {0, rest, rest, {}}, settings);
  int n = 0;
  for (int warm = 0; warm < n_warm; ++warm) motion.advance(++n * step);
  const auto before = body.work();
  const int newton_before = motion.work().newton_iterations;
  std::vector<double> milliseconds;
  milliseconds.reserve(1 << 20);
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    motion.advance(++n * step);
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
    milliseconds.push_back(elapsed.count());
    state.SetIterationTime(elapsed.count() / 1000);
  }
  std::sort(milliseconds.begin(), milliseconds.end());
  const auto n_steps = static_cast<double>(milliseconds.size());
  const auto at = [&](double part) { return milliseconds[static_cast<std::size_t>(part * (n_steps - 1))]; };
  const auto work = body.work() - before;
  state.counters["unknowns"] = n_unknowns;
  state.counters["median_ms"] = at(0.5);
  state.counters["p90_ms"] = at(0.9);
  state.counters["p99_ms"] = at(0.99);
  state.counters["most_ms"] = milliseconds.back();
  state.counters["Newton"] = (motion.work().newton_iterations - newton_before) / n_steps;
  state.counters["CG"] = static_cast<double>(work.linear_iterations) / n_steps;
  state.counters["forces"] = static_cast<double>(work.force_evaluations) / n_steps;
  state.counters["halved"] = motion.n_halvings();
  state.counters["unfinished"] = motion.n_unfinished();
  state.counters["largest_residual"] = motion.largest_residual();
  state.counters["largest_mm"] = motion.now().displacement.cwiseAbs().maxCoeff();
  state.counters["Munknowns_steps/s"] = n_unknowns / (1e3 * at(0.5));
}

void run_steps(benchmark::State& state, Moving& body, double step,
               const mechanics::IntegrationSettings& settings) {
  run_steps(state, *body.motion, msm::Vector::Zero(body.vectors.size()),
            static_cast<double>(body.grid.n_unknowns), step, settings);
}

/// Steps to a tolerance of 10^-exponent; of exponent 0, in real time with six iterations at most.
mechanics::IntegrationSettings to_tolerance(std::int64_t exponent) {
  if (exponent == 0) return mechanics::in_real_time(6);
  mechanics::IntegrationSettings settings;
  settings.newton.tolerance = std::pow(10, -static_cast<double>(exponent));
  return settings;
}

/// N/mm and MPa: the linear method's springs of cubes of 1 mm at E = 0.3 MPa and nu = 0.35, the hybrid
/// lattice at the same, and that with power-log springs.
const msm::CellStiffness springs{0.031, 0.047, 0.033, 0};
const msm::CellStiffness hybrid{0.0722, 0.0111, 0.0667, 0.1481};
const msm::CellStiffness power_log{0.0722, 0.0111, 0.0667, 0.1481, msm::Exponents{-1.485, -1.485, -1.485}};

msm::CellStiffness of_edge(msm::CellStiffness k, double edge) {
  for (double* of : {&k.edge, &k.face_diagonal, &k.internal_diagonal}) *of *= edge;
  return k;
}

/// An ellipsoid of cubes of 20 mm with 708 masses, 1.3 kg in all, and 6,998 springs, held below; two loads
/// pull a place of its surface, one hither and thither and one around: 40 mm at most.
/// Range: threads, -log10 of the tolerance (0: real time).
void interactive(benchmark::State& state, const msm::CellStiffness& cell) {
  cases::Grid grid;
  grid.cells = {11, 8, 7};
  grid.spacing = {20, 20, 20};
  grid.origin = {0, 0, 0};
  for (int k = 0; k < 7; ++k)
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 11; ++i) {
        const Eigen::Vector3d half(5.5, 4, 3.5);
        grid.present.push_back(
            (Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5) - half).cwiseQuotient(1.15 * half).squaredNorm() <=
            1);
      }
  const cases::Mesh mesh = cases::make_grid_mesh(grid);
  msm::Inertia inertia;
  inertia.mass.assign(mesh.nodes.size(), 1.3e-3 / static_cast<double>(mesh.nodes.size()));
  inertia.mass_damping.assign(mesh.nodes.size(), 0);
  int pulled = 0;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (mesh.nodes[n].x() + mesh.nodes[n].z() >
        mesh.nodes[static_cast<std::size_t>(pulled)].x() + mesh.nodes[static_cast<std::size_t>(pulled)].z())
      pulled = static_cast<int>(n);
  const std::pair<double, Eigen::Vector3d> pulls[] = {{1.0, {15, 0, 10}}, {0.7, {0, 10, -10}}};
  for (const auto& [frequency, force] : pulls) {
    cases::History swinging;
    swinging.frequency = frequency;
    inertia.loads.push_back({swinging, {{pulled, force}}});
  }
  Moving body(held_at(mesh, 0), of_edge(cell, 20), inertia, static_cast<int>(state.range(0)));
  run_steps(state, body, 0.02, to_tolerance(state.range(1)));
}

/// A cube of 40^3 cells of 1 mm, of water, held below, its top pulled to and fro by some 2 mm.
/// Range: threads, -log10 of the tolerance.
void cube(benchmark::State& state, const msm::CellStiffness& cell, bool is_consistent) {
  const int n = 40;
  const cases::Mesh mesh = cases::make_box_mesh({1.0 * n, 1.0 * n, 1.0 * n}, {n, n, n});
  msm::Inertia inertia;
  inertia.mass.assign(mesh.nodes.size(), 0);
  for (const cases::CellNodes& vertices : mesh.cells)
    for (const int node : vertices) inertia.mass[cases::index(node)] += 1e-9 / 8;
  inertia.mass_damping.assign(mesh.nodes.size(), 0);
  if (is_consistent) {
    inertia.cell_mass.assign(mesh.cells.size(), 1e-9);
    inertia.cell_mass_damping.assign(mesh.cells.size(), 0);
  }
  cases::History swinging;
  swinging.frequency = 2;
  std::vector<cases::NodeVector> pull;
  for (std::size_t p = 0; p < mesh.nodes.size(); ++p)
    if (mesh.nodes[p].z() > n - 1e-6) pull.push_back({static_cast<int>(p), {0.002, 0, 0.004}});
  inertia.loads.push_back({swinging, pull});
  Moving body(held_at(mesh, 0), cell, inertia, static_cast<int>(state.range(0)));
  run_steps(state, body, 0.02, to_tolerance(state.range(1)));
}

const char* const poked_cube = R"(
schema = 1
name = "poked-cube"
[body]
shape = "box"
size = [40, 40, 40]
cells = [16, 16, 16]
[material]
model = "linear_elastic"
youngs_modulus = 0.01
poissons_ratio = 0.35
density = 1000
stiffness_damping = 0.002
[[fixed]]
region = "z-"
[[tool]]
name = "ball"
shape = "sphere"
centre = [20, 20, 50]
radius = 10
displacement = [0, 0, -2]
history = { sine = 0.5 }
[dynamics]
scheme = "implicit_euler"
step = 0.0166666666666667
end = 1
[msm]
design = "hybrid"
)";

/// A soft cube of 16^3 cells, held below; a ball goes 2 mm into its top and out again, in 60 steps a time, as
/// beside a tool by hand.
/// Range: threads.
void beside_tool(benchmark::State& state) {
  cases::Case definition = cases::read_case_text(poked_cube, "poked_cube");
  const double step = definition.dynamics->step;
  const Eigen::Vector3d start = definition.tools.front().at, deepest = start + Eigen::Vector3d(0, 0, -2);
  auto& path = definition.tools.front().path;
  for (int n = 0; n < 2 * n_rounds + 1; ++n) {
    const Eigen::Vector3d& at = n % 2 == 0 ? start : deepest;
    path.push_back({(n_warm + 30 * n) * step, at.x(), at.y(), at.z()});
  }
  const cases::Scene scene = cases::make_scene(definition);
  const double edge = scene.mesh.grid->spacing[0], softer = 0.01 / 0.3; // than those springs
  msm::MovingBody body(scene, std::vector<msm::CellStiffness>{of_edge(power_log, edge * softer)},
                       {msm::Path::automatic, static_cast<int>(state.range(0)), {}, {}});
  const msm::Points rest(scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
  const auto n_unknowns = static_cast<double>(3 * body.problem().mesh.nodes.size());
  run_steps(state, body.motion(), body.to_vector(rest), n_unknowns, step, mechanics::to_few_digits(1e-3));
}

} // namespace

BENCHMARK_CAPTURE(interactive, springs, springs)
    ->ArgNames({"threads", "tolerance"})
    ->ArgsProduct({{1}, {0, 2, 3, 6, 9}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1000)
    ->UseManualTime();
BENCHMARK_CAPTURE(interactive, hybrid, hybrid)
    ->ArgNames({"threads", "tolerance"})
    ->ArgsProduct({{1}, {0, 2, 3}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1000)
    ->UseManualTime();
BENCHMARK_CAPTURE(interactive, power_log, power_log)
    ->ArgNames({"threads", "tolerance"})
    ->ArgsProduct({{1}, {0, 2, 3}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1000)
    ->UseManualTime();
BENCHMARK_CAPTURE(cube, springs, springs, false)
    ->ArgNames({"threads", "tolerance"})
    ->ArgsProduct({{1, 2}, {3}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(40)
    ->UseManualTime();
BENCHMARK_CAPTURE(cube, hybrid, hybrid, false)
    ->ArgNames({"threads", "tolerance"})
    ->ArgsProduct({{1}, {3}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(40)
    ->UseManualTime();
BENCHMARK_CAPTURE(cube, consistent_masses, hybrid, true)
    ->ArgNames({"threads", "tolerance"})
    ->ArgsProduct({{1}, {3}})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(40)
    ->UseManualTime();
BENCHMARK(beside_tool)
    ->ArgNames({"threads"})
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(60 * n_rounds)
    ->UseManualTime();

} // namespace motions
