#include "compare/interact/pulled_body.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/scene.hpp"
#include "compare/measure/surfaces.hpp"
#include "msm/real_time/real_time.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

/// Settings for pictures: fewer digits than a measure needs, and few halvings, so that a step ends in time.
mechanics::IntegrationSettings steps_of(const cases::Scene& scene, const msm::SpringBody& springs) {
  if (scene.definition.msm.real_time)
    return msm::in_substeps(scene, springs, scene.definition.dynamics->step);
  mechanics::IntegrationSettings settings;
  settings.newton.tolerance = 1e-6;
  if (const auto enough = scene.definition.msm.iterations_per_step)
    settings = mechanics::in_real_time(*enough);
  settings.max_halvings = 4;
  return settings;
}

constexpr int most_sizes = 100; ///< what moves further has no picture

} // namespace

PulledBody::PulledBody(const cases::Scene& scene, const PullSettings& settings)
    : scene_(scene), settings_(settings) {
  if (!scene.definition.dynamics)
    throw cases::InputError(scene.definition.file + ": has no [dynamics], whose step a body in motion needs");
  const cases::Scheme scheme = scene.definition.dynamics->scheme.scheme;
  if (scheme != cases::Scheme::implicit_euler && scheme != cases::Scheme::bdf2)
    throw cases::InputError(fmt::format("{}: dynamics.scheme is \"{}\", must be \"implicit_euler\" or "
                                        "\"bdf2\": a pointer that jumps from step to "
                                        "step drives on what a scheme does not damp",
                                        scene.definition.file, cases::name_of(scheme)));
  const msm::DesignResult design = design_for(scene);
  const msm::ModelOptions options{msm::Path::automatic, settings.n_threads, {}, {}};
  body_ = std::make_unique<msm::MovingBody>(scene, design.springs, options);
  steps_ = steps_of(scene, design.springs);
  surface_ = embedded_surface(scene);
  // Were every vertex a centre, the spheres would have no radius and cover nothing between the vertices.
  const std::size_t most_spheres = std::max<std::size_t>(1, surface_.rest.vertices.size() / 2);
  spheres_ = mechanics::cover(surface_.rest.vertices, std::min(settings.n_spheres, most_spheres));
  size_ = cases::bounding_box(scene.mesh.nodes).sizes().norm();
  displacement_.assign(scene.mesh.nodes.size(), Vector3d::Zero());
  if (scene.definition.dynamics->start == cases::MotionStart::equilibrium)
    displacement_ =
        msm::Model(cases::scene_before_start(scene), design.springs, options).solve().displacement;
  start_ = body_->to_vector(displacement_);
  restart();
}

void PulledBody::restart() {
  release();
  body_->motion().begin_anew();
  const mechanics::Vector at_rest = mechanics::Vector::Zero(start_.size());
  motion_ = std::make_unique<mechanics::TimeIntegrator>(body_->motion(), scene_.definition.dynamics->scheme,
                                                        mechanics::Motion{0, start_, at_rest, {}}, steps_);
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
  const auto patch =
      mechanics::patch_within(surface_, surface_.rest.vertices[cases::index(*held_)], spheres_.radius);
  pull_ = &body_->hold(cases::on_nodes(patch, scene_.mesh), settings_.stiffness);
  grabbed_at_ = target_ = pull_->place(motion_->now().displacement);
  return held_;
}

void PulledBody::drag(const Vector3d& by) {
  if (!held_ || !by.allFinite()) return;
  const double length = by.norm();
  target_ = grabbed_at_ + (length > size_ ? Vector3d(size_ / length * by) : by);
}

void PulledBody::release() {
  held_.reset();
  pull_ = nullptr;
  body_->motion().let_go();
  force_.setZero();
}

void PulledBody::step() {
  if (pull_) pull_->draw_to(target_);
  force_.setZero();
  try {
    const int n_before = motion_->n_unfinished();
    motion_->advance(static_cast<double>(n_steps_ + 1) * scene_.definition.dynamics->step);
    if (!(body_->motion().largest(motion_->now().displacement) <= most_sizes * size_))
      throw cases::SolveError(
          fmt::format("a node has moved by more than {} times the body's size", most_sizes));
    troubles_.n_unfinished += motion_->n_unfinished() > n_before;
    troubles_.largest_residual = std::max(troubles_.largest_residual, motion_->largest_residual());
    ++n_steps_;
    is_displacement_of_now_ = false;
    if (pull_) {
      force_ = pull_->force(motion_->now().displacement);
      body_->motion().remember_pull(motion_->now().displacement);
    }
  } catch (const std::exception& error) { // memory too: nobody else takes it in this thread
    troubles_.failure = error.what();
    ++troubles_.n_failures;
    restart();
  }
}

const msm::Points& PulledBody::displacement() {
  if (!std::exchange(is_displacement_of_now_, true))
    displacement_ = body_->to_points(motion_->now().displacement);
  return displacement_;
}

std::string PulledBody::method_text() const {
  const auto counted = [](int n, const std::string& what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  const cases::Msm& given = scene_.definition.msm;
  if (!given.real_time)
    return given.iterations_per_step
               ? fmt::format("Newton's method, {} at most", counted(*given.iterations_per_step, "iteration"))
               : fmt::format("Newton's method, to {:g}", steps_.newton.tolerance);
  const std::string name = cases::name_of(given.real_time->method),
                    substeps = counted(steps_.substeps, "substep");
  return given.real_time->method == cases::StepMethod::symplectic_euler
             ? name + ", " + substeps
             : fmt::format("{}, {}, {}", name, counted(given.real_time->iterations, "iteration"), substeps);
}

int PulledBody::n_inverted() {
  return body_->motion().n_inverted(motion_->now().displacement);
}

} // namespace springproof::compare
