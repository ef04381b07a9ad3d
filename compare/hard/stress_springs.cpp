#include "compare/hard/stress_springs.hpp"

#include "compare/solve/design.hpp"
#include "compare/solve/solve_side.hpp"
#include "msm/model.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <random>

namespace springproof::compare {

namespace {

using Eigen::Vector3d;

/// The springs of every cell: what the case gives or its design answers, stiffer where the case says so.
std::vector<msm::CellStiffness> springs_of_cells(const cases::HardCase& hard_case,
                                                 const cases::Scene& scene) {
  std::vector<msm::CellStiffness> springs;
  if (hard_case.stiffness) {
    const auto& [edge, face_diagonal, internal_diagonal] = *hard_case.stiffness;
    springs = {{1e-3 * edge, 1e-3 * face_diagonal, 1e-3 * internal_diagonal, 0}}; // N/m in N/mm
  } else {
    springs = stiffness_of_cells(design_for(scene));
  }
  if (!hard_case.stiffer) return springs;
  if (springs.size() == 1) springs.resize(scene.mesh.cells.size(), springs.front());
  const auto& [axis, beyond, factor] = *hard_case.stiffer;
  for (std::size_t c = 0; c < springs.size(); ++c) {
    Vector3d centre = Vector3d::Zero();
    for (const Vector3d& vertex : cases::cell_vertices(scene.mesh, c)) centre += vertex / 8;
    if (!(centre[static_cast<int>(axis)] > beyond)) continue;
    for (double* k :
         {&springs[c].edge, &springs[c].face_diagonal, &springs[c].internal_diagonal, &springs[c].volume})
      *k *= factor;
  }
  return springs;
}

/// Displacements to start from, mm; empty: rest.
msm::Points start_points(const cases::HardCase& hard_case, const cases::HexMesh& mesh) {
  msm::Points start;
  if (hard_case.start == cases::Start::perturbed) {
    std::mt19937 generator(static_cast<unsigned>(hard_case.seed));
    // Not std::uniform_real_distribution, whose numbers a standard library may choose.
    const auto any = [&] { return hard_case.amplitude * (2 * (double(generator()) / 4294967295.0) - 1); };
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const double x = any(), y = any(), z = any();
      start.emplace_back(x, y, z);
    }
  }
  if (hard_case.start == cases::Start::inverted) {
    double lowest = mesh.nodes.front().z();
    for (const Vector3d& node : mesh.nodes) lowest = std::min(lowest, node.z());
    for (const Vector3d& node : mesh.nodes) start.emplace_back(0, 0, 2 * (lowest - node.z()));
  }
  return start;
}

bool is_finite(const cases::Solution& s) {
  return std::isfinite(s.residual) && std::isfinite(s.load_reached) &&
         std::isfinite(s.lowest_eigenvalue.value_or(0)) &&
         std::all_of(s.displacement.begin(), s.displacement.end(),
                     [](const Vector3d& u) { return u.allFinite(); });
}

} // namespace

mechanics::EquilibriumSettings limited_by(const cases::HardCase& hard_case, const Stopwatch& stopwatch,
                                          mechanics::EquilibriumSettings settings) {
  settings.first_load_step = settings.largest_load_step = 1.0 / hard_case.least_load_steps;
  settings.max_newton_iterations = hard_case.max_iterations;
  settings.lowest_eigenvalue = mechanics::LowestEigenvalue::report;
  settings.should_stop = [&hard_case, &stopwatch] { return stopwatch.seconds() > hard_case.max_seconds; };
  return settings;
}

Answer or_refused(const std::function<Answer()>& solve) {
  try {
    return solve();
  } catch (const cases::InputError& error) {
    Answer refused;
    refused.solution.status = cases::Status::failed;
    refused.solution.outcome = cases::Outcome::refused;
    refused.solution.message = error.what();
    return refused;
  }
}

Answer solve_springs(cases::Side which, const cases::HardCase& hard_case, int n_threads) {
  const Stopwatch stopwatch;
  return or_refused([&] {
    cases::Scene scene = cases::make_scene(hard_case.definition);
    if (which == cases::Side::hybrid) {
      cases::Msm hybrid;
      hybrid.design = cases::Design::hybrid;
      hybrid.where = scene.definition.msm.where;
      scene.definition.msm = hybrid;
    }
    return solve_side(
        [&] {
          return msm::Model(scene, springs_of_cells(hard_case, scene), {msm::Path::automatic, n_threads});
        },
        [&](msm::Model& model) {
          return model.solve(limited_by(hard_case, stopwatch, {}), start_points(hard_case, scene.mesh));
        });
  });
}

std::vector<std::string> misses(const cases::HardCase& hard_case, const cases::ExpectedOutcome& expected,
                                const Answer& answer) {
  const cases::Solution& s = answer.solution;
  std::vector<std::string> found;
  if (s.outcome != expected.outcome)
    found.push_back(fmt::format("outcome {}, expected {}", name_of(s.outcome), name_of(expected.outcome)));
  if (expected.load_reached) {
    const auto& [lower, upper] = *expected.load_reached;
    if (!(lower <= s.load_reached && s.load_reached <= upper))
      found.push_back(
          fmt::format("load reached {:.5g} is outside [{:.5g}, {:.5g}]", s.load_reached, lower, upper));
  }
  if (expected.inverted_cells && s.inverted_cells != *expected.inverted_cells)
    found.push_back(
        fmt::format("{} inverted cells, expected {}", s.inverted_cells, *expected.inverted_cells));
  const double seconds = answer.setup_seconds + answer.solve_seconds;
  if (!(seconds <= hard_case.max_seconds))
    found.push_back(fmt::format("{:.1f} s, above the limit of {:.1f} s", seconds, hard_case.max_seconds));
  if (!(s.newton_iterations <= hard_case.max_iterations))
    found.push_back(
        fmt::format("{} iterations, above the limit of {}", s.newton_iterations, hard_case.max_iterations));
  if (!is_finite(s)) found.emplace_back("a result is not finite");
  return found;
}

} // namespace springproof::compare
