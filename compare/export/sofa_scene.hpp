#pragma once

#include "msm/moving_springs.hpp"

/// Springs as a SOFA scene, in mm, mN, kg and s.
namespace springproof::compare {

/// What an exported lattice moves by: [dynamics] of its case.
struct ExportedMotion {
  cases::Dynamics dynamics;
  msm::Inertia inertia;
  double stiffness_damping;                    ///< s, of the body's material
  bool has_one_stiffness_damping;              ///< whether all materials have this one
  std::vector<cases::Scene::MovedNodes> moved; ///< by their histories
  msm::Points start;                           ///< mm, one per point; empty: it starts undeformed
};

/// What there is of a motion that SOFA's components do not do as our steps do.
std::vector<std::string> inexpressible_in_sofa(const ExportedMotion& motion);

/// FOLDER/scene.py, a program that is the same for every case, and its data FOLDER/scene.json, each whole or
/// not at all.
/// @param name    of the case   @param motion  null: the equilibrium under the full load
/// @return what was written, and what differs in SOFA, a line each
std::vector<std::string> write_sofa_files(const std::string& folder, const std::string& name,
                                          const msm::Problem& problem, const ExportedMotion* motion);

} // namespace springproof::compare
