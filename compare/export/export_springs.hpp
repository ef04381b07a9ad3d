#pragma once

#include "cases/case/names.hpp"
#include "mechanics/surface/embedded_surface.hpp"
#include "msm/moving_springs.hpp"

/// A case's designed springs for other programs, as an explicit list. No force is left out in silence: what a
/// target has no words for is refused by check_expressible(), or named in what export_springs() returns.
namespace springproof::compare {

SPRINGPROOF_ENUMERATION(ExportTarget, sofa, csv, vtu)

/// What an exported lattice moves by: [dynamics] of its case.
struct ExportedMotion {
  cases::Dynamics dynamics;
  msm::Inertia inertia;
  double stiffness_damping;                    ///< s, of the body's material
  bool has_one_stiffness_damping;              ///< whether all materials have this one
  std::vector<cases::Scene::MovedNodes> moved; ///< by their histories
  msm::Points start;                           ///< mm, one per point; empty: it starts undeformed
  bool has_memory = false;                     ///< some material has a Prony series
};

/// The lattice, supports and loads of a scene.
/// @throws InputError when no springs can be designed
msm::Problem exported_problem(const cases::Scene& scene);

/// What moves the springs of a scene with [dynamics]; nothing of another one.
/// @throws SolveError where a motion begins in an equilibrium that is not found
std::optional<ExportedMotion> exported_motion(const cases::Scene& scene);

/// What files have of a body beside its springs, supports and loads.
struct ExportedBody {
  std::vector<double> mass{};        ///< t, one per point; 0 where the case gives no density
  mechanics::EmbeddedSurface skin{}; ///< the case's surface, or else the outside of the cells, if any
};
ExportedBody exported_body(const cases::Scene& scene);

/// What springs of another design err by, in words for a refusal that suggests it: ", which err by 3 %".
using ErrorOfDesign = std::function<std::string(const std::string& design)>;

/// @param name      the case's name
/// @param error_of  asked of the design that a refusal suggests, which may take a solve
/// @throws InputError if the target cannot express the springs or their motion, listing all that it cannot;
/// targets for files take any motion, and say what they leave out
void check_expressible(ExportTarget target, const std::string& name, const msm::Problem& problem,
                       const std::optional<ExportedMotion>& motion = {}, const ErrorOfDesign& error_of = {});

/// Writes the files of a target, each whole or not at all:
///   csv   springs.csv as design = "network" reads it; nodes.csv, volume_terms.csv, tetrahedra.csv; the skin
///   sofa  scene.py and scene.json: write_sofa_files()
///   vtu   springs.vtu: lines with stiffness, rest length and kind; supports and loads at points
/// @param problem  which the target can express (check_expressible)
/// @return what was written, and what the files do not hold, a line each
std::vector<std::string> export_springs(const std::string& folder, ExportTarget target,
                                        const std::string& name, const msm::Problem& problem,
                                        const ExportedBody& body = {},
                                        const std::optional<ExportedMotion>& motion = {});

/// 1 in the components in which a node is constrained, else 0.
std::vector<int> constrained(const msm::Problem& problem, std::size_t node);

/// Prescribed displacements at full load, mm.
msm::Points prescribed(const msm::Problem& problem);

/// What a motion has that SOFA's components do not do as our steps do.
std::vector<std::string> inexpressible_in_sofa(const ExportedMotion& motion);

/// Writes springs as a SOFA scene in mm, mN, kg and s: FOLDER/scene.py, a program that is the same for every
/// case, and its data FOLDER/scene.json, each whole or not at all.
/// @param name    the case's name   @param motion  null: the equilibrium under the full load
/// @return what was written, and what differs in SOFA, a line each
std::vector<std::string> write_sofa_files(const std::string& folder, const std::string& name,
                                          const msm::Problem& problem, const ExportedBody& body,
                                          const ExportedMotion* motion);

} // namespace springproof::compare
