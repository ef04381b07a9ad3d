#include "mechanics/dynamics/follow_motion.hpp"

#include "cases/case/case.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/dynamics/slowest_vibration.hpp"
#include "mechanics/larger.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace springproof::mechanics {

namespace {

/// Records a motion, step after step.
class Record {
 public:
  Record(const cases::Scene& scene, const BodyInTime& body)
      : body_(body), dynamics_(*scene.definition.dynamics), has_volume_(cases::watches_volume(scene)) {
    trajectory_.nodes = cases::watched_nodes(scene);
  }

  void add(int step, double time, const Vector& state) {
    const std::vector<Eigen::Vector3d> displacement = body_.displacement(state);
    trajectory_.time.push_back(time);
    for (const int node : trajectory_.nodes)
      trajectory_.displacement.push_back(displacement[cases::index(node)]);
    if (has_volume_) trajectory_.volume.push_back(body_.volume(state));
    for (cases::ToolContact& tool : body_.problem.tools_at(time, state)) {
      tool.nodes.clear();
      tool.on_nodes.clear();
      trajectory_.tools.push_back(std::move(tool));
    }
    if (step % dynamics_.write_every == 0 || step == dynamics_.n_steps())
      trajectory_.bodies.push_back({step, displacement});
  }
  cases::Trajectory finish(const TimeIntegrator& motion) {
    trajectory_.halved_steps = motion.n_halvings();
    trajectory_.unfinished_steps = motion.n_unfinished();
    trajectory_.largest_residual = motion.largest_residual();
    return std::move(trajectory_);
  }

 private:
  const BodyInTime& body_;
  const cases::Dynamics& dynamics_;
  bool has_volume_;
  cases::Trajectory trajectory_;
};

} // namespace

FollowedMotion follow_motion(const cases::Scene& scene, const BodyInTime& body, Vector start,
                             const IntegrationSettings& settings) {
  cases::check_turns_in_time(scene.definition); // a study may have taken other steps than the case's
  const cases::Dynamics& dynamics = *scene.definition.dynamics;
  Record record(scene, body);
  const Vector begin = start;
  Vector at_rest = Vector::Zero(start.size());
  TimeIntegrator motion(body.problem, dynamics.scheme, {0, std::move(start), std::move(at_rest), {}},
                        settings);
  record.add(0, 0, motion.now().displacement);
  try {
    for (int step = 1; step <= dynamics.n_steps(); ++step) {
      motion.advance(step * dynamics.step);
      record.add(step, motion.now().time, motion.now().displacement);
    }
  } catch (const cases::SolveError& error) {
    cases::Solution so_far = error.so_far();
    so_far.load_reached = motion.now().time / dynamics.end;
    throw cases::SolveError(error.what(), std::move(so_far));
  }
  FollowedMotion followed{motion.now().displacement, record.finish(motion), motion.work()};
  followed.work.load_reached = 1;
  followed.work.n_unknowns = body.problem.n_unknowns();
  followed.work.work = body.problem.work(); // excludes what follows
  Contact* const contact = body.problem.contact();
  const std::optional<Contact> at_end = contact ? std::optional(*contact) : std::nullopt;
  if (contact) contact->forget(); // the vibration is that of the start, where no friction has set in
  followed.trajectory.slowest = slowest_vibration(body.problem, begin, dynamics.end);
  if (contact) *contact = *at_end;
  return followed;
}

CameToRest come_to_rest(const BodyInTime& body, Vector start, double step, double end,
                        const IntegrationSettings& settings, StillMoving still_moving) {
  constexpr double watched = 0.5, part_moved = 1e-4; // s
  cases::TimeScheme scheme;
  scheme.scheme = cases::Scheme::implicit_euler;
  Vector at_rest = Vector::Zero(start.size());
  std::vector<Eigen::Vector3d> before = body.displacement(start);
  TimeIntegrator motion(body.problem, scheme, {0, std::move(start), std::move(at_rest), {}}, settings);
  const long every = std::max(1L, std::lround(watched / step)), last = std::lround(end / step);
  const auto ended = [&](Vector state, long steps, std::optional<double> mean_from) {
    CameToRest rest{std::move(state), motion.now().time, steps, mean_from, motion.work()};
    rest.work.load_reached = 1;
    rest.work.n_unknowns = body.problem.n_unknowns();
    rest.work.work = body.problem.work();
    return rest;
  };
  if (last < every && (still_moving == StillMoving::fails || last == 0))
    throw cases::SolveError(fmt::format("cannot come to rest within {:g} s: rest is {:.3g} s without motion; "
                                        "give more time",
                                        end, double(every) * step),
                            to_solution(motion.work()));
  double moved = 0, largest = 0;
  Vector mean = Vector::Zero(motion.now().displacement.size());
  for (long n = 1; n <= last; ++n) {
    motion.advance(double(n) * step);
    if (n > last / 2) mean += motion.now().displacement / double(last - last / 2);
    if (n % every != 0) continue;
    const std::vector<Eigen::Vector3d> now = body.displacement(motion.now().displacement);
    moved = largest = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
      moved = larger(moved, (now[i] - before[i]).norm());
      largest = larger(largest, now[i].norm());
    }
    if (moved <= part_moved * largest) return ended(motion.now().displacement, n, {});
    before = now;
  }
  if (still_moving == StillMoving::has_mean) return ended(std::move(mean), last, double(last / 2) * step);
  Equilibrium work = motion.work();
  work.work = body.problem.work();
  throw cases::SolveError(
      fmt::format("does not come to rest within {:g} s: in the last {:.3g} s a node moved by "
                  "{:.3g} mm, where the largest displacement is {:.3g} mm; give more "
                  "iterations, substeps, damping or time",
                  end, double(every) * step, moved, largest),
      to_solution(work));
}

cases::Solution follow_motion(const cases::Scene& scene, DynamicProblem& problem, const StateOnMesh& on_mesh,
                              Vector& state, const IntegrationSettings& settings) {
  const BodyInTime body{problem, [&](const Vector& at) { return on_mesh.whole_displacement(at); },
                        [&](const Vector& at) { return on_mesh.volume(at); }};
  FollowedMotion followed = follow_motion(scene, body, std::move(state), settings);
  state = std::move(followed.end);
  cases::Solution solution = to_solution(followed.work);
  on_mesh.add_to(solution, state);
  solution.trajectory = std::move(followed.trajectory);
  return solution;
}

} // namespace springproof::mechanics
