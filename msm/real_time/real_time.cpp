#include "msm/real_time/real_time.hpp"

#include "cases/case/error.hpp"
#include "msm/direct/direct_system.hpp"
#include "msm/real_time/step_method.hpp"
#include "msm/tangent.hpp"

#include <cmath>
#include <fmt/format.h>

namespace springproof::msm {

namespace {

MakeStep make_step(const cases::RealTime& real_time, const Problem& problem, int n_threads) {
#pragma GCC diagnostic error "-Wswitch" // a method that is forgotten here must not compile
  switch (real_time.method) {
  case cases::StepMethod::xpbd:
    return make_xpbd(problem.lattice, real_time.iterations, n_threads);
  case cases::StepMethod::projective_dynamics:
    return make_projective_dynamics(problem.lattice, real_time.iterations);
  case cases::StepMethod::vertex_block_descent:
    return make_vertex_block_descent(problem.lattice, real_time.iterations, n_threads);
  case cases::StepMethod::implicit_euler:
    return make_implicit_euler(problem, real_time.iterations);
  case cases::StepMethod::symplectic_euler:
    break;
  }
  return make_symplectic_euler(problem.lattice);
}

/// Steps that keep explicit ones stable: 80 % of 2/omega, where Gershgorin's circles bound omega² by the
/// largest sum of a row of M^-1 |K| at rest.
int stable_substeps(const cases::Scene& scene, const SpringBody& springs, double step) {
  const Lattice lattice = make_lattice(scene.mesh, springs);
  Tangent tangent(lattice, cases::constrained_dofs(scene));
  const std::vector<double> masses = cases::point_masses(scene);
  const Tangent::Matrix whole = tangent.assemble(lattice.rest, Clamp::no).selfadjointView<Eigen::Lower>();
  double squared = 0; // omega², 1/s²
  for (std::size_t dof = 0; dof < tangent.free_number().size(); ++dof)
    if (const int column = tangent.free_number()[dof]; column >= 0)
      squared = std::max(squared, whole.col(column).cwiseAbs().sum() / masses[dof / 3]);
  constexpr double most = 1e6;
  const double n = std::ceil(step * std::sqrt(squared) / (0.8 * 2));
  if (!(n <= most))
    throw cases::InputError(
        scene.definition.msm.where,
        fmt::format("real_time: symplectic_euler needs {:.3g} substeps of a step of {:g} s "
                    "to be stable, above {:g}; take an implicit method or a shorter step",
                    n, step, most));
  return std::max(1, static_cast<int>(n));
}

/// All components of points, point after point.
Eigen::Map<Vector> flat(Points& points) {
  return {points.front().data(), static_cast<Eigen::Index>(3 * points.size())};
}

/// The places in flat() of the entries of a problem's vectors.
Eigen::VectorXi components_of(const Problem& problem) {
  Points number;
  for (std::size_t p = 0; p < problem.lattice.rest.size(); ++p) {
    const auto first = static_cast<double>(3 * p);
    number.emplace_back(first, first + 1, first + 2);
  }
  return to_vector(problem, number).cast<int>();
}

} // namespace

MovingSprings::StepMethod step_method(const cases::RealTime& real_time, const Problem& problem,
                                      int n_threads) {
  const Points zero(problem.lattice.rest.size(), Eigen::Vector3d::Zero());
  return [components = components_of(problem), step = StepEquation{zero, zero, zero}, points = zero,
          make = make_step(real_time, problem, n_threads)](const mechanics::StepTerms& terms,
                                                           const Vector& inertia, Vector& at) mutable {
    flat(step.inertia)(components) = inertia;
    flat(step.origin)(components) = terms.origin;
    flat(step.force)(components) = terms.force;
    flat(points)(components) = at;
    const int iterations = make(step, points);
    at = flat(points)(components);
    return iterations;
  };
}

mechanics::IntegrationSettings in_substeps(const cases::Scene& scene, const SpringBody& springs,
                                           double step) {
  const cases::RealTime& real_time = *scene.definition.msm.real_time;
  mechanics::IntegrationSettings settings;
  settings.max_halvings = 0;
  settings.substeps = real_time.substeps ? *real_time.substeps
                      : real_time.method == cases::StepMethod::symplectic_euler
                          ? stable_substeps(scene, springs, step)
                          : 1;
  return settings;
}

cases::Scene in_motion(cases::Scene scene) {
  const cases::RealTime& real_time = *scene.definition.msm.real_time;
  cases::Dynamics& dynamics = scene.definition.dynamics.emplace();
  dynamics.scheme.scheme = cases::Scheme::implicit_euler;
  dynamics.step = real_time.step;
  dynamics.end = real_time.end;
  scene.definition.material_dynamics.mass_damping = real_time.damping;
  for (cases::RegionMaterial& region : scene.definition.region_materials)
    region.dynamics.mass_damping = real_time.damping;
  return scene;
}

cases::Solution come_to_rest(const cases::Scene& scene, const SpringBody& springs, int n_threads,
                             const StepLimits& limits) {
  const cases::RealTime& real_time = *scene.definition.msm.real_time;
  MovingBody body(in_motion(scene), springs, {Path::direct, n_threads, {}, {}});
  const auto points = [&](const Vector& state) { return body.to_points(state); };
  const Points start(scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
  mechanics::IntegrationSettings settings = in_substeps(scene, springs, real_time.step);
  settings.newton.should_stop = limits.should_stop;
  const mechanics::CameToRest rest = mechanics::come_to_rest(
      {body.motion(), points, {}}, body.to_vector(start), real_time.step, real_time.end, settings,
      limits.tell_moving ? mechanics::StillMoving::has_mean : mechanics::StillMoving::fails);
  if (rest.mean_from) limits.tell_moving(rest);
  Problem problem = make_problem(scene);
  problem.lattice = make_lattice(scene.mesh, springs);
  const auto statics = make_direct_system(problem);
  const Points displacement = points(rest.state);
  const Vector at = to_vector(problem, displacement);
  cases::Solution solution = solution_of(problem, rest.work, displacement);
  solution.residual = statics->size(statics->residual(at, 1), at).relative;
  solution.relaxation_iterations = solution.linear_iterations;
  cases::FromEquilibrium& from = solution.from_equilibrium.emplace(
      cases::FromEquilibrium{mechanics::EquilibriumSettings{}.tolerance, {}, {}, {}, {}, {}});
  if (!rest.mean_from) from.rest = {rest.time, rest.steps};
  return solution;
}

} // namespace springproof::msm
