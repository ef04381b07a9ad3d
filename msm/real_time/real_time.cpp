#include "msm/real_time/real_time.hpp"

#include "msm/direct/direct_system.hpp"
#include "msm/real_time/step_method.hpp"
#include "msm/tangent.hpp"

#include <map>
#include <memory>

namespace springproof::msm {

namespace {

mechanics::ForcesAt forces_of(const Lattice& lattice) {
  return [&lattice](const Points& displacement) { return internal_force_at(lattice, displacement); };
}

mechanics::FreeTangent tangent_of(const Lattice& lattice, const std::vector<bool>& is_constrained,
                                  Clamp clamp) {
  const auto tangent = std::make_shared<Tangent>(lattice, is_constrained);
  return {tangent->free_number(), tangent->n_free(),
          [&lattice, tangent, clamp](const Points& displacement) -> const Tangent::Matrix& {
            Points x = lattice.rest;
            for (std::size_t p = 0; p < x.size(); ++p) x[p] += displacement[p];
            return tangent->assemble(x, clamp);
          }};
}

MakeStep make_step(const cases::RealTime& real_time, const Problem& problem, int n_threads) {
#pragma GCC diagnostic error "-Wswitch" // a method that is forgotten here must not compile
  switch (real_time.method) {
  case cases::StepMethod::xpbd:
    return make_xpbd(problem.lattice, real_time.iterations, n_threads);
  case cases::StepMethod::projective_dynamics:
    return make_projective_dynamics(problem.lattice, real_time.iterations, real_time.chebyshev);
  case cases::StepMethod::vertex_block_descent:
    return make_vertex_block_descent(problem.lattice, real_time.iterations, n_threads);
  case cases::StepMethod::implicit_euler:
    return mechanics::make_implicit_euler(forces_of(problem.lattice),
                                          tangent_of(problem.lattice, problem.is_constrained, Clamp::yes),
                                          real_time.iterations);
  case cases::StepMethod::symplectic_euler:
    break;
  }
  return mechanics::make_symplectic_euler(forces_of(problem.lattice));
}

int stable_substeps(const cases::Scene& scene, const SpringBody& springs, double step) {
  const Lattice lattice = make_lattice(scene.mesh, springs);
  return mechanics::stable_substeps(
      tangent_of(lattice, cases::constrained_dofs(scene), Clamp::no), cases::point_masses(scene), step,
      cases::name_of(cases::StepMethod::symplectic_euler), scene.definition.msm.where);
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

/// @param dofs  components_of() its problem
mechanics::PullOfPoints pull_of_points(const Pull& pull, const Eigen::VectorXi& dofs) {
  std::map<std::size_t, double> weight_of; // a point's components have the same, those that are entries
  for (const auto& component : pull.entries())
    for (const Pull::Entry& entry : component) weight_of[cases::index(dofs[entry.at] / 3)] = entry.weight;
  return {{weight_of.begin(), weight_of.end()}, pull.stiffness(), pull.target()};
}

} // namespace

MovingSprings::StepMethod step_method(const cases::RealTime& real_time, const Problem& problem,
                                      int n_threads) {
  const Points zero(problem.lattice.rest.size(), Eigen::Vector3d::Zero());
  return [components = components_of(problem), step = StepEquation{zero, zero, zero, {}}, points = zero,
          inertia_before = Vector(Vector::Zero(components_of(problem).size())),
          make = make_step(real_time, problem, n_threads)](
             const mechanics::StepTerms& terms, const Vector& inertia, const Pull* pull, Vector& at) mutable {
    if (inertia != inertia_before) {
      inertia_before = inertia;
      flat(step.inertia)(components) = inertia;
    }
    double *origin = flat(step.origin).data(), *force = flat(step.force).data(), *place = flat(points).data();
    for (Eigen::Index n = 0; n < at.size(); ++n) { // one pass: a step of few springs is mostly such passes
      const int component = components[n];
      origin[component] = terms.origin[n];
      force[component] = terms.force[n];
      place[component] = at[n];
    }
    step.pull.reset();
    if (pull) step.pull = pull_of_points(*pull, components);
    const int iterations = make(step, points);
    for (Eigen::Index n = 0; n < at.size(); ++n) at[n] = place[components[n]];
    return iterations;
  };
}

mechanics::IntegrationSettings in_substeps(const cases::Scene& scene, const SpringBody& springs,
                                           double step) {
  return mechanics::in_substeps(*scene.definition.msm.real_time,
                                [&] { return stable_substeps(scene, springs, step); });
}

cases::Scene in_motion(cases::Scene scene) {
  const cases::RealTime real_time = *scene.definition.msm.real_time;
  return mechanics::in_motion(std::move(scene), real_time);
}

cases::Solution come_to_rest(const cases::Scene& scene, const SpringBody& springs, int n_threads,
                             const mechanics::StepLimits& limits) {
  const cases::RealTime& real_time = *scene.definition.msm.real_time;
  MovingBody body(in_motion(scene), springs, {Path::direct, n_threads, {}, {}});
  const auto points = [&](const Vector& state) { return body.to_points(state); };
  const Points start(scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
  mechanics::IntegrationSettings settings = in_substeps(scene, springs, real_time.step);
  const mechanics::CameToRest rest = mechanics::come_to_rest(
      {body.motion(), points, {}}, body.to_vector(start), real_time, settings, limits);
  Problem problem = make_problem(scene);
  problem.lattice = make_lattice(scene.mesh, springs);
  const auto statics = make_direct_system(problem);
  const Points displacement = points(rest.state);
  const Vector at = to_vector(problem, displacement);
  cases::Solution solution = solution_of(problem, rest.work, displacement);
  mechanics::add_rest(solution, rest, statics->size(statics->residual(at, 1), at).relative);
  return solution;
}

} // namespace springproof::msm
