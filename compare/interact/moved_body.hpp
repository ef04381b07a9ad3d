#pragma once

#include "cases/mesh/mesh.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/dynamics/time_integrator.hpp"
#include "msm/spring_body.hpp"

#include <memory>
#include <vector>

namespace springproof::compare {

/// What `interact` moves: the springs of a scene, or its finite elements by a method of simulators. A spring
/// holds a place of it, and is solved with it.
class MovedBody {
 public:
  using Points = std::vector<Eigen::Vector3d>;
  using Vector = mechanics::Vector;

  virtual ~MovedBody() = default;
  virtual mechanics::DynamicProblem& motion() = 0;
  virtual mechanics::IntegrationSettings steps() const = 0;
  /// Where the motion starts.
  virtual Vector start() const = 0;
  virtual void begin_anew() = 0;
  /// Displacements of the mesh's nodes, mm.
  virtual Points to_points(const Vector& state) const = 0;

  /// Takes hold of a weighted mean of nodes, until let_go().
  /// @param stiffness  N/mm
  virtual void hold(const std::vector<cases::NodeWeight>& place, double stiffness) = 0;
  virtual void let_go() = 0;
  // While something is held:
  virtual void draw_to(const Eigen::Vector3d& target) = 0;      ///< mm, a displacement
  virtual Eigen::Vector3d place(const Vector& state) const = 0; ///< mm, its displacement
  virtual Eigen::Vector3d force(const Vector& state) const = 0; ///< N
  virtual void remember_pull(const Vector& state) = 0;          ///< once a step has ended

  /// What tools press it with; null: the case has none.
  virtual mechanics::Contact* contact() { return nullptr; }

  /// How a step is made: "xpbd, 10 iterations, 1 substep".
  virtual std::string method_text() const = 0;
};

/// @throws InputError when springs cannot be designed or start
std::unique_ptr<MovedBody> moved_springs(const cases::Scene& scene, int n_threads);
/// The same of springs that are designed already.
std::unique_ptr<MovedBody> moved_springs(const cases::Scene& scene, const msm::SpringBody& springs,
                                         int n_threads);
/// By [fem] real_time of the scene, which must outlive it.
/// @throws InputError when elements cannot be stepped, SolveError when they cannot start
std::unique_ptr<MovedBody> moved_elements(const cases::Scene& scene, int n_threads);

} // namespace springproof::compare
