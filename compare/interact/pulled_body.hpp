#pragma once

#include "compare/interact/moved_body.hpp"
#include "mechanics/surface/embedded_surface.hpp"
#include "mechanics/surface/rays.hpp"

#include <memory>

namespace springproof::compare {

struct PullSettings {
  std::size_t n_spheres = 271;          ///< that cover the surface, as in the thesis (section 6.2.2.3)
  double stiffness = 0.1;               ///< N/mm, of the spring between the pointer and the body, > 0
  int n_threads = 1;                    ///< threads of the multigrid path, and of methods
  cases::Side model = cases::Side::msm; ///< fem: the elements, by [fem] real_time
};

/// What went wrong in the steps of a body since it was made.
struct StepTroubles {
  int n_failures = 0;    ///< steps that could not be solved, each a restart
  std::string failure;   ///< message of the last one
  long n_unfinished = 0; ///< steps left with more than their tolerance, because their iterations are bounded
  double largest_residual = 0; ///< the most that one was left with, relative to the forces of the motion
};

/// A dynamic case's springs, or its elements by a method of simulators, moved step by step while a spring
/// pulls on a spherical part of their surface. The pulling spring is solved implicitly with the body, so any
/// stiffness is stable. Its force in a step is known after the step; applied as a load of that step it gives
/// the same solution, where a step is solved. A recording of forces can therefore be replayed in any model,
/// and by any method.
/// The case's tools stay where they begin until they are taken by hand; a case with tools has no method of
/// simulators.
class PulledBody {
 public:
  /// @throws InputError when the case has no [dynamics], or its springs cannot be designed or start, its
  /// elements not be stepped
  PulledBody(const cases::Scene& scene, const PullSettings& settings);

  /// Takes hold of the sphere that a ray meets first, if it meets one.
  /// @return the vertex of the surface that is held from now on
  std::optional<int> grab(const mechanics::Ray& ray);
  /// Takes a tool by its number in the case.
  void grab_tool(std::size_t tool);
  /// Moves the pointer's end of the spring, or the tool, which goes no further in a step than a fiftieth of
  /// the body's size.
  /// @param by  mm, from where the place was when it was grabbed; at most the body's size counts
  void drag(const Eigen::Vector3d& by);
  void release();
  /// Back to the start of the motion, with nothing held.
  void restart();

  /// Takes one step of the case. If it cannot be solved, troubles() say why and the body is at its start.
  void step();

  const mechanics::EmbeddedSurface& surface() const { return surface_; }
  const mechanics::Spheres& spheres() const { return spheres_; }
  std::optional<int> held() const { return held_; } ///< a vertex of the surface
  /// A tool now, and what it does to the body.
  struct ToolNow {
    Eigen::Vector3d at; ///< mm
    cases::ToolContact contact{};
  };
  const std::vector<ToolNow>& tools() const { return tools_; } ///< as in the case
  std::optional<std::size_t> held_tool() const { return held_tool_; }
  const Eigen::Vector3d& force() const { return force_; } ///< N, of the spring at the end of the last step
  double time() const { return motion_->now().time; }     ///< s, since the last restart
  long n_steps() const { return n_steps_; }               ///< since the last restart
  const StepTroubles& troubles() const { return troubles_; }
  /// What the last step was left with, relative to the forces of the motion.
  double residual() const { return motion_->work().residual; }
  const MovedBody::Points& displacement(); ///< mm, of all nodes, now
  int n_inverted();                        ///< cells, now
  std::string method_text() const { return body_->method_text(); }
  std::size_t n_unknowns() { return body_->motion().n_unknowns(); }

 private:
  const cases::Scene& scene_;
  PullSettings settings_;
  std::unique_ptr<MovedBody> body_;
  mechanics::EmbeddedSurface surface_;
  mechanics::Spheres spheres_;
  double size_ = 0; ///< mm: diagonal of the body's box
  std::unique_ptr<mechanics::TimeIntegrator> motion_;
  long n_steps_ = 0;
  StepTroubles troubles_;
  std::optional<int> held_;
  /// mm: displacement of the place when it was grabbed, and what it is drawn to; N.
  Eigen::Vector3d grabbed_at_ = Eigen::Vector3d::Zero(), target_ = grabbed_at_, force_ = grabbed_at_;
  std::vector<ToolNow> tools_;
  std::optional<std::size_t> held_tool_;
  MovedBody::Points displacement_;
  bool is_displacement_of_now_ = false;

  void lead_tools(double begin, double end);
};

} // namespace springproof::compare
