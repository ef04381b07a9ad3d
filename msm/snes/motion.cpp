#include "msm/snes/motion.hpp"

#include "cases/mesh/sharing.hpp"
#include "cases/scene/in_time.hpp"
#include "mechanics/ranks/share_out.hpp"
#include "msm/snes/moving_part.hpp"
#include "msm/snes/snes.hpp"

#include <utility>

namespace springproof::msm {

namespace {

/// What is here of a displacement, on every rank.
Points gathered(Points here, const cases::Sharing* sharing) {
  return sharing ? sharing->gather(here) : here;
}

/// Displacement when the motion begins, mm, one per point.
Points start_of(const cases::Scene& scene, const Lattice& lattice, MPI_Comm communicator,
                const mechanics::EquilibriumSettings& settings) {
  if (scene.definition.dynamics->start == cases::MotionStart::rest)
    return Points(scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
  cases::Solution still =
      solve_lattice_by_snes(cases::scene_before_start(scene), lattice, communicator, settings);
  return gathered(std::move(still.displacement), still.sharing.get());
}

} // namespace

cases::Solution follow_lattice_by_snes(const cases::Scene& scene, Lattice lattice, Lattice damping,
                                       MPI_Comm communicator,
                                       const mechanics::IntegrationSettings& settings) {
  const auto sharing = mechanics::share_out(scene.mesh, communicator);
  const Points start = start_of(scene, lattice, communicator, settings.newton);
  Problem problem = make_moving_problem(scene);
  problem.lattice = std::move(lattice);
  const LatticePart part(problem, communicator);
  PartInTime springs(part, communicator);
  MovingPart motion(problem, part, springs, make_inertia(scene, std::move(damping)), settings.newton);
  // Each rank has its part of the springs by now.
  problem.lattice = Lattice{std::move(problem.lattice.rest), {}, {}, {}};
  const auto here = [&](const Vector& state) { return part.deal(state, sharing.get()); };
  mechanics::FollowedMotion followed = mechanics::follow_motion(
      scene,
      {motion, [&](const Vector& state) { return gathered(here(state), sharing.get()); },
       [&](const Vector& state) { return volume_of(problem.mesh, here(state), sharing.get()); }},
      part.own(start), settings);
  cases::Solution solution = solution_of(problem, followed.work, here(followed.end), sharing);
  solution.trajectory = std::move(followed.trajectory);
  return solution;
}

} // namespace springproof::msm
