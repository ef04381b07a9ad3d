#pragma once

#include "cases/scene/scene.hpp"
#include "compare/modes/eigenspaces.hpp"
#include "mechanics/vibrating_body.hpp"

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

/// Small vibrations of both models about rest, with the supports of a case and without its loads.
namespace springproof::compare {

/// Frequencies in ascending order, and their shapes on the nodes of the body's mesh.
struct Vibrations {
  Eigen::VectorXd hertz;
  /// One column per frequency: 3*node + component, 0 on supports, orthonormal in the masses of mode_masses().
  Eigen::MatrixXd shapes;
  int n_rigid = 0; ///< motions without stiffness, which are left out
};

/// Modes of neighbouring frequencies less than this part of the frequency apart count as one space
/// (cluster()): rounding or the mesh decides which of its vectors are modes.
constexpr double same_frequency = 1e-3;

/// The modes of a space of the finite elements, and the springs' that overlap it most.
struct MatchedModes {
  double fem_hz; ///< mean of the space
  int dimension; ///< dimension of the space
  /// Mean of the springs' modes, as many at least; none when none of theirs is alike (an overlap below 0.5).
  std::optional<double> msm_hz;
  /// Cosine of the largest angle between the two spaces, in the masses of mode_masses(): 1 for the same
  /// shapes.
  double overlap;
  std::optional<double> error_percent; ///< (msm_hz - fem_hz)/fem_hz
  int fem_mode, msm_mode;              ///< the first ones' places among the frequencies
};

/// Vibrations of a design's springs. Every design is held against the same finite elements.
struct DesignVibrations {
  std::string design;
  Vibrations msm;
  std::vector<MatchedModes> modes; ///< ascending; a space that would be cut in two is left out
  std::string refusal;             ///< why there are none; empty when there are
};
struct VibrationStudy {
  std::string name; ///< name of the case
  Vibrations fem;
  std::vector<DesignVibrations> designs;
};

/// Masses, t, that weight shapes, one per degree of freedom of the body's mesh: the springs' point masses of
/// equal shares of cells.
Eigen::VectorXd mode_masses(const cases::Scene& scene);

/// The lowest vibrations of a body.
/// @param n_modes  number of modes with stiffness; fewer where the body has no more
/// @throws SolveError if SLEPc does not converge, or if the body is unstable at rest
Vibrations vibrations_of(const mechanics::VibratingBody& body, const Eigen::VectorXd& masses, int n_modes);

/// @param n_modes  number of the finite elements' modes that are matched
std::vector<MatchedModes> match_modes(const Vibrations& fem, const Vibrations& msm,
                                      const Eigen::VectorXd& masses, int n_modes);

/// Both models of a scene whose materials have densities.
/// @param designs  spring designs; empty: the case's own. One that cannot serve the case is refused by itself
/// @throws InputError; SolveError where the finite elements fail
VibrationStudy study_vibrations(const cases::Scene& scene, const std::vector<cases::Design>& designs,
                                int n_modes);

} // namespace springproof::compare
