#include "compare/measure/surface_motion.hpp"

#include "compare/measure/landmarks.hpp"
#include "compare/measure/measure.hpp"
#include "mechanics/larger.hpp"

#include <cmath>

namespace springproof::compare {

std::optional<SurfaceMotion> surface_motion(const cases::Scene& scene, const Answers& answers) {
  if (!scene.definition.surface || !answers.fem.converged() || !answers.msm.converged()) return std::nullopt;
  const auto& fem = answers.fem.solution.trajectory;
  const auto& msm = answers.msm.solution.trajectory;
  if (!fem || !msm || fem->bodies.size() != msm->bodies.size()) return std::nullopt;
  const mechanics::EmbeddedSurface surface = embedded_surface(scene);
  if (surface.vertices.empty()) return std::nullopt;
  const auto n = static_cast<double>(surface.vertices.size());
  SurfaceMotion motion;
  for (std::size_t body = 0; body < fem->bodies.size(); ++body) {
    double of_fem = 0, of_msm = 0, of_difference = 0, largest = 0;
    for (const mechanics::EmbeddedPoint& vertex : surface.vertices) {
      const Eigen::Vector3d reference = mechanics::displacement_at(vertex, fem->bodies[body].displacement);
      const Eigen::Vector3d other = mechanics::displacement_at(vertex, msm->bodies[body].displacement);
      const double apart = (other - reference).squaredNorm();
      of_fem += reference.squaredNorm();
      of_msm += other.squaredNorm();
      of_difference += apart;
      largest = mechanics::larger(largest, apart);
    }
    motion.time.push_back(fem->time[cases::index(fem->bodies[body].step)]);
    motion.fem.push_back(std::sqrt(of_fem / n));
    motion.msm.push_back(std::sqrt(of_msm / n));
    motion.difference.push_back(std::sqrt(of_difference / n));
    motion.largest.push_back(std::sqrt(largest));
  }
  const auto size = value_over_time(cases::OverTime::trajectory_l2, {motion.time, motion.fem});
  const auto apart = value_over_time(cases::OverTime::trajectory_l2, {motion.time, motion.difference});
  const double zero = zero_of_displacements(scene, answers.fem.solution);
  if (size && apart) motion.error_percent = error_percent(*size, *size + *apart, zero); // apart/size
  return motion;
}

} // namespace springproof::compare
