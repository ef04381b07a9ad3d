#include "compare/interact/pulled_body.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/scene.hpp"
#include "compare/measure/surfaces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

constexpr int most_sizes = 100;       ///< what moves further has no picture
constexpr double largest_step = 0.02; ///< a tool's, in the body's sizes

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
  if (scene.definition.msm.real_time || settings.model == cases::Side::fem)
    cases::refuse_tools(scene.definition, "a method of simulators", "its steps know no contact");
  body_ = settings.model == cases::Side::fem ? moved_elements(scene, settings.n_threads)
                                             : moved_springs(scene, settings.n_threads);
  surface_ = embedded_surface(scene);
  // Were every vertex a centre, the spheres would have no radius and cover nothing between the vertices.
  const std::size_t most_spheres = std::max<std::size_t>(1, surface_.rest.vertices.size() / 2);
  spheres_ = mechanics::cover(surface_.rest.vertices, std::min(settings.n_spheres, most_spheres));
  size_ = cases::bounding_box(scene.mesh.nodes).sizes().norm();
  restart();
}

void PulledBody::restart() {
  release();
  body_->begin_anew();
  tools_.clear();
  for (const cases::Tool& tool : scene_.definition.tools) tools_.push_back({tool.place(0)});
  lead_tools(0, 0);
  const mechanics::Vector start = body_->start(), at_rest = mechanics::Vector::Zero(start.size());
  motion_ =
      std::make_unique<mechanics::TimeIntegrator>(body_->motion(), scene_.definition.dynamics->scheme,
                                                  mechanics::Motion{0, start, at_rest, {}}, body_->steps());
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
  body_->hold(cases::on_nodes(patch, scene_.mesh), settings_.stiffness);
  grabbed_at_ = target_ = body_->place(motion_->now().displacement);
  return held_;
}

void PulledBody::grab_tool(std::size_t tool) {
  release();
  if (tool >= tools_.size()) return;
  held_tool_ = tool;
  grabbed_at_ = target_ = tools_[tool].at;
}

void PulledBody::drag(const Vector3d& by) {
  if (!(held_ || held_tool_) || !by.allFinite()) return;
  const double length = by.norm();
  target_ = grabbed_at_ + (length > size_ ? Vector3d(size_ / length * by) : by);
}

void PulledBody::release() {
  held_.reset();
  held_tool_.reset();
  body_->let_go();
  force_.setZero();
}

/// Tools go straight, from where they are at the begin of a step (s) to where a hand has them at its end.
void PulledBody::lead_tools(double begin, double end) {
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    Vector3d& at = tools_[i].at;
    std::vector<std::array<double, 4>> path{{begin, at.x(), at.y(), at.z()}};
    if (held_tool_ == i) {
      const Vector3d way = target_ - at;
      const double length = way.norm(), most = largest_step * size_;
      at += length > most ? Vector3d(most / length * way) : way;
      path.push_back({end, at.x(), at.y(), at.z()});
    }
    body_->contact()->lead(i, std::move(path));
  }
}

void PulledBody::step() {
  if (held_) body_->draw_to(target_);
  force_.setZero();
  const double end = static_cast<double>(n_steps_ + 1) * scene_.definition.dynamics->step;
  lead_tools(motion_->now().time, end);
  try {
    const int n_before = motion_->n_unfinished();
    motion_->advance(end);
    if (!(body_->motion().largest(motion_->now().displacement) <= most_sizes * size_))
      throw cases::SolveError(
          fmt::format("a node has moved by more than {} times the body's size", most_sizes));
    troubles_.n_unfinished += motion_->n_unfinished() > n_before;
    troubles_.largest_residual = std::max(troubles_.largest_residual, motion_->largest_residual());
    ++n_steps_;
    is_displacement_of_now_ = false;
    const auto contacts = body_->motion().tools_at(end, motion_->now().displacement);
    for (std::size_t i = 0; i < tools_.size(); ++i) tools_[i].contact = contacts[i];
    if (held_) {
      force_ = body_->force(motion_->now().displacement);
      body_->remember_pull(motion_->now().displacement);
    }
  } catch (const std::exception& error) { // memory too: nobody else takes it in this thread
    troubles_.failure = error.what();
    ++troubles_.n_failures;
    restart();
  }
}

const MovedBody::Points& PulledBody::displacement() {
  if (!std::exchange(is_displacement_of_now_, true))
    displacement_ = body_->to_points(motion_->now().displacement);
  return displacement_;
}

int PulledBody::n_inverted() {
  return body_->motion().n_inverted(motion_->now().displacement);
}

} // namespace springproof::compare
