#include "compare/interact/pulled_body.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/in_time.hpp"
#include "compare/measure/landmarks.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

std::unique_ptr<msm::MovingBody> moving_body(const cases::Scene& scene, const msm::DesignResult& design,
                                             const msm::ModelOptions& options) {
  if (!design.terms) return std::make_unique<msm::MovingBody>(scene, stiffness_of_cells(design), options);
  MovingSprings springs = make_moving_springs(scene, design);
  return std::make_unique<msm::MovingBody>(scene, std::move(springs.lattice), std::move(springs.damping));
}

/// A picture needs fewer digits than a measure, and a step no more than a few halvings to be given up in
/// time.
mechanics::IntegrationSettings steps_of(const cases::Scene& scene) {
  mechanics::IntegrationSettings settings;
  settings.newton.tolerance = 1e-6;
  if (const auto enough = scene.definition.msm.iterations_per_step)
    settings = mechanics::in_real_time(*enough);
  settings.max_halvings = 4;
  return settings;
}

} // namespace

PulledBody::PulledBody(const cases::Scene& scene, const PullSettings& settings)
    : scene_(scene), settings_(settings) {
  if (!scene.definition.dynamics)
    throw cases::InputError(scene.definition.file + ": has no [dynamics], whose step a body in motion needs");
  const cases::Scheme scheme = scene.definition.dynamics->scheme.scheme;
  if (scheme != cases::Scheme::implicit_euler && scheme != cases::Scheme::bdf2)
    throw cases::InputError(fmt::format(
        "{}: dynamics.scheme is \"{}\", must be \"implicit_euler\" or \"bdf2\": a pull is known before its "
        "step, and drives on what a step does not damp",
        scene.definition.file, cases::name_of(scheme)));
  const msm::DesignResult design = design_for(scene);
  const msm::ModelOptions options{msm::Path::automatic, settings.n_threads, {}, {}};
  body_ = moving_body(scene, design, options);
  surface_ = embedded_surface(scene);
  // Were every vertex a centre, the spheres would have no radius and cover nothing between the vertices.
  const std::size_t most_spheres = std::max<std::size_t>(1, surface_.rest.vertices.size() / 2);
  spheres_ = mechanics::cover(surface_.rest.vertices, std::min(settings.n_spheres, most_spheres));
  Eigen::AlignedBox3d box;
  for (const Vector3d& node : scene.mesh.nodes) box.extend(node);
  size_ = box.sizes().norm();
  displacement_.assign(scene.mesh.nodes.size(), Vector3d::Zero());
  if (scene.definition.dynamics->start == cases::MotionStart::equilibrium)
    displacement_ = make_model(cases::scene_before_start(scene), design, options).solve().displacement;
  start_ = body_->to_vector(displacement_);
  restart();
}

void PulledBody::restart() {
  release();
  body_->motion().set_given_force({});
  const mechanics::Vector at_rest = mechanics::Vector::Zero(start_.size());
  motion_ = std::make_unique<mechanics::TimeIntegrator>(body_->motion(), scene_.definition.dynamics->scheme,
                                                        mechanics::Motion{0, start_, at_rest, {}},
                                                        steps_of(scene_));
  n_steps_ = 0;
  is_displacement_of_now_ = false;
}

std::optional<int> PulledBody::grab(const mechanics::Ray& ray) {
  release();
  std::vector<Vector3d> positions;
  mechanics::move(surface_, displacement(), positions);
  const auto sphere = mechanics::pick(spheres_, positions, ray);
  if (!sphere) return std::nullopt;
  held_ = spheres_.vertices[*sphere];
  grabbed_at_ = target_ = positions[cases::index(*held_)];
  stiffness_.reset();
  return held_;
}

void PulledBody::drag(const Vector3d& by) {
  if (!held_ || !by.allFinite()) return;
  const double length = by.norm();
  target_ = grabbed_at_ + (length > size_ ? Vector3d(size_ / length * by) : by);
}

void PulledBody::release() {
  held_.reset();
  force_.setZero();
}

void PulledBody::step() {
  force_.setZero();
  body_->motion().set_given_force({});
  if (held_ && n_steps_ > 0) { // before the first step there is no tangent of one
    const mechanics::EmbeddedPoint& place = surface_.vertices[cases::index(*held_)];
    if (!stiffness_) stiffness_ = std::min(settings_.stiffness, bearable_stiffness(place));
    force_ = *stiffness_ * (target_ - expected_place(*held_));
    body_->motion().set_given_force(body_->forces(on_nodes(place, force_)));
  }
  try {
    const int n_before = motion_->n_unfinished();
    motion_->advance(static_cast<double>(n_steps_ + 1) * scene_.definition.dynamics->step);
    n_unfinished_ += motion_->n_unfinished() > n_before;
    largest_residual_ = std::max(largest_residual_, motion_->largest_residual());
    ++n_steps_;
    is_displacement_of_now_ = false;
  } catch (const cases::SolveError& error) {
    failure_ = error.what();
    ++n_failures_;
    restart();
  }
}

const msm::Points& PulledBody::displacement() {
  if (!std::exchange(is_displacement_of_now_, true))
    displacement_ = body_->to_points(motion_->now().displacement);
  return displacement_;
}

int PulledBody::n_inverted() {
  return body_->motion().n_inverted(motion_->now().displacement);
}

std::vector<cases::NodeVector> PulledBody::on_nodes(const mechanics::EmbeddedPoint& place,
                                                    const Vector3d& force) const {
  std::vector<cases::NodeVector> forces;
  for (std::size_t v = 0; v < 8; ++v) forces.push_back({place.nodes[v], place.weights[v] * force});
  return forces;
}

/// Where a vertex of the surface is at the end of the next step if it goes on as it does. A force of where it
/// was would lag behind the body, and so drive it on.
Vector3d PulledBody::expected_place(int vertex) {
  const std::size_t v = cases::index(vertex);
  const mechanics::EmbeddedPoint& place = surface_.vertices[v];
  const mechanics::Motion& now = motion_->now();
  Vector3d at = surface_.rest.vertices[v];
  for (std::size_t n = 0; n < 8; ++n)
    at +=
        place.weights[n] * (body_->at_node(now.displacement, place.nodes[n]) +
                            scene_.definition.dynamics->step * body_->at_node(now.velocity, place.nodes[n]));
  return at;
}

/// A spring whose force is known before the step makes the body swing, further each time, if it is stiffer
/// than what the place resists a step with. With mu the place's mass over the square of the step and K its
/// stiffness, the implicit Euler method has z² (mu + K) + 2 z (k - mu) + mu - k = 0, whose roots are in the
/// unit circle for k < (4 mu + K)/3: a quarter of mu + K leaves room for a body that softens, and for bdf2
/// (tested, not derived). mu + K is what the tangent of a step says, here where the body is now.
double PulledBody::bearable_stiffness(const mechanics::EmbeddedPoint& place) {
  constexpr double forcing = 0.3; // the compliance, an energy, is off by its square
  double compliance = 0;          // mm/N, of the softest axis
  body_->motion().lift_limit();   // a solve that is cut off finds less compliance than there is
  mechanics::Vector step;
  for (int axis = 0; axis < 3; ++axis) {
    const mechanics::Vector unit = body_->forces(on_nodes(place, Vector3d::Unit(axis)));
    if (unit.isZero(0)) continue; // a support
    if (!body_->motion().direction(motion_->now().displacement, unit, 0, forcing,
                                   mechanics::Convexity::clamped, step))
      continue;
    compliance = std::max(compliance, body_->motion().dot(unit, step));
  }
  return compliance > 0 ? 0.25 / compliance : std::numeric_limits<double>::infinity();
}

} // namespace springproof::compare
