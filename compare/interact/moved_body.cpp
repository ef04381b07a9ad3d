#include "compare/interact/moved_body.hpp"

#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"
#include "msm/real_time/real_time.hpp"

#include <fmt/format.h>
#include <utility>

namespace springproof::compare {

namespace {

/// Settings for pictures: fewer digits than a measure needs, and few halvings, so that a step ends in time.
mechanics::IntegrationSettings steps_of(const cases::Scene& scene, const msm::SpringBody& springs) {
  if (scene.definition.msm.real_time)
    return msm::in_substeps(scene, springs, scene.definition.dynamics->step);
  mechanics::IntegrationSettings settings;
  settings.newton.tolerance = 1e-6;
  if (!scene.definition.tools.empty())
    settings = mechanics::to_few_digits(1e-3); // forces are those that the body bears: they have three digits
  if (const auto enough = scene.definition.msm.iterations_per_step)
    settings = mechanics::in_real_time(*enough);
  settings.max_halvings = 4;
  return settings;
}

class Springs : public MovedBody {
 public:
  Springs(const cases::Scene& scene, const msm::SpringBody& springs, int n_threads)
      : given_(scene.definition.msm), body_(scene, springs, options(n_threads)),
        steps_(steps_of(scene, springs)) {
    Points points(scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
    if (scene.definition.dynamics->start == cases::MotionStart::equilibrium)
      points = msm::Model(cases::scene_before_start(scene), springs, options(n_threads)).solve().displacement;
    start_ = body_.to_vector(points);
  }

  mechanics::DynamicProblem& motion() override { return body_.motion(); }
  mechanics::IntegrationSettings steps() const override { return steps_; }
  Vector start() const override { return start_; }
  void begin_anew() override { body_.motion().begin_anew(); }
  Points to_points(const Vector& state) const override { return body_.to_points(state); }

  void hold(const std::vector<cases::NodeWeight>& place, double stiffness) override {
    pull_ = &body_.hold(place, stiffness);
  }
  void let_go() override {
    pull_ = nullptr;
    body_.motion().let_go();
  }
  void draw_to(const Eigen::Vector3d& target) override { pull_->draw_to(target); }
  Eigen::Vector3d place(const Vector& state) const override { return pull_->place(state); }
  Eigen::Vector3d force(const Vector& state) const override { return pull_->force(state); }
  void remember_pull(const Vector& state) override { body_.motion().remember_pull(state); }
  mechanics::Contact* contact() override { return body_.motion().contact(); }

  std::string method_text() const override {
    if (given_.real_time) return cases::text_of(*given_.real_time, steps_.substeps);
    return given_.iterations_per_step
               ? fmt::format("Newton's method, {} iteration{} at most", *given_.iterations_per_step,
                             *given_.iterations_per_step == 1 ? "" : "s")
               : fmt::format("Newton's method, to {:g}", steps_.newton.tolerance);
  }

 private:
  cases::Msm given_;
  msm::MovingBody body_;
  mechanics::IntegrationSettings steps_;
  Vector start_;
  msm::Pull* pull_ = nullptr; ///< the body's; none: nothing is held

  static msm::ModelOptions options(int n_threads) { return {msm::Path::automatic, n_threads, {}, {}}; }
};

class Elements : public MovedBody {
 public:
  Elements(const cases::Scene& scene, int n_threads)
      : given_(*scene.definition.fem.real_time), body_(scene, given_, n_threads), steps_(body_.settings()),
        start_(Vector::Zero(static_cast<Eigen::Index>(3 * scene.mesh.nodes.size()))) {
    if (scene.definition.dynamics->start != cases::MotionStart::equilibrium) return;
    const Answer before = before_stepped_motion(scene);
    if (!before.converged()) throw cases::SolveError(before.solution.message);
    start_ = mechanics::to_vector(before.solution.displacement);
  }

  mechanics::DynamicProblem& motion() override { return body_.points(); }
  mechanics::IntegrationSettings steps() const override { return steps_; }
  Vector start() const override { return start_; }
  void begin_anew() override { body_.points().begin_anew(); }
  Points to_points(const Vector& state) const override { return mechanics::to_points(state); }

  void hold(const std::vector<cases::NodeWeight>& place, double stiffness) override {
    mechanics::PullOfPoints pull{{}, stiffness, Eigen::Vector3d::Zero()};
    for (const cases::NodeWeight& one : place) pull.weights.emplace_back(cases::index(one.node), one.weight);
    pull_ = &body_.points().hold(std::move(pull));
  }
  void let_go() override {
    pull_ = nullptr;
    body_.points().let_go();
  }
  void draw_to(const Eigen::Vector3d& target) override { pull_->target = target; }
  Eigen::Vector3d place(const Vector& state) const override { return pull_->mean(to_points(state)); }
  Eigen::Vector3d force(const Vector& state) const override { return pull_->force(to_points(state)); }
  void remember_pull(const Vector& state) override { body_.points().remember_pull(state); }

  std::string method_text() const override { return "elements, " + cases::text_of(given_, steps_.substeps); }

 private:
  cases::ElementRealTime given_;
  fem_reference::SteppedElements body_;
  mechanics::IntegrationSettings steps_;
  Vector start_;
  mechanics::PullOfPoints* pull_ = nullptr; ///< the body's; none: nothing is held
};

} // namespace

std::unique_ptr<MovedBody> moved_springs(const cases::Scene& scene, int n_threads) {
  return moved_springs(scene, design_for(scene).springs, n_threads);
}

std::unique_ptr<MovedBody> moved_springs(const cases::Scene& scene, const msm::SpringBody& springs,
                                         int n_threads) {
  return std::make_unique<Springs>(scene, springs, n_threads);
}

std::unique_ptr<MovedBody> moved_elements(const cases::Scene& scene, int n_threads) {
  return std::make_unique<Elements>(scene, n_threads);
}

} // namespace springproof::compare
