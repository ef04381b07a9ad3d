#pragma once

#include "cases/scene/scene.hpp"
#include "compare/solve/solvers.hpp"
#include "mechanics/dense.hpp"
#include "mechanics/vibrating_body.hpp"
#include "msm/design/small_strain.hpp"

#include <Eigen/SparseCore>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

/// The eigenspace analysis of thesis section 4.2.2: which invariant subspaces the stiffness matrices of both
/// models share, of a cell and of a whole free body. All results depend on the subspaces alone, not on the
/// basis that a solver returns inside a multiple eigenvalue. Small vibrations of both models about rest, with
/// the supports of a case and without its loads.
namespace springproof::compare {

using mechanics::Spectrum;

struct Eigenspace {
  double eigenvalue; ///< mean of the cluster, N/mm; of vibrations Hz
  int offset;        ///< first of its columns in the ascending spectrum
  int dimension;
};

/// Neighbouring values v less than gap + relative_gap v apart belong to one eigenspace.
std::vector<Eigenspace> cluster(const Eigen::VectorXd& ascending, double gap, double relative_gap);

/// The same of eigenvalues less than 1e-6 of the largest apart: multiplicities as printed, far above
/// round-off.
std::vector<Eigenspace> cluster(const Eigen::VectorXd& ascending);

constexpr int n_rigid_modes = 6;
/// How many modes are computed beyond the wanted ones, so that the last space is whole and can be matched.
constexpr int n_beyond = 8;

/// An FEM and an MSM eigenspace of the same dimension that span the same subspace.
struct Equivalence {
  std::size_t fem_space, msm_space; ///< indices from 0
  int distance;                     ///< d_i: difference of the two spaces' offsets
};

struct EigenspaceAnalysis {
  Spectrum fem, msm;
  std::vector<Eigenspace> fem_spaces, msm_spaces;
  std::vector<Equivalence> equivalent; ///< ascending FEM space
  /// coupling(i, j) = |V_i^T W_j|_F² / dim V_i: the share of FEM space i that lies in MSM space j. Rows and,
  /// weighted by the dimensions, columns sum to one.
  Eigen::MatrixXd coupling;
  double h; ///< thesis eq. 4.25
};

/// Spaces are equivalent when the smallest singular value of V^T W exceeds 1 - 1e-6;
///   h = sum over equivalent FEM spaces i (from 1) of (i/N) / (d_i + 1),  N the number of FEM eigenspaces.
EigenspaceAnalysis analyse_eigenspaces(Spectrum fem, Spectrum msm);

/// Columns of a spectrum that span one of its eigenspaces.
Eigen::MatrixXd basis(const Spectrum& spectrum, const Eigenspace& space);

/// An orthonormal basis that depends on the subspace alone: the projector's columns by greatest remaining
/// length (the first of equals), orthonormalised, each with its largest component positive. For pictures that
/// do not change with the solver.
Eigen::MatrixXd canonical_basis(const Eigen::MatrixXd& basis);

/// Sum of equal cells' matrices on a mesh's degrees of freedom, 3*node + component, N/mm.
Eigen::SparseMatrix<double> assemble(const cases::Mesh& mesh, const msm::CellMatrix& cell);

/// An FEM eigenspace and the MSM eigenspace that it overlaps most.
struct ModePair {
  Eigenspace fem, msm;
  double ratio;         ///< MSM's eigenvalue over FEM's
  double angle_degrees; ///< largest principal angle between the two, over the smaller dimension
};

/// The lowest modes of a free body, both models on one mesh.
struct FreeBodyModes {
  Spectrum fem, msm;
  std::vector<ModePair> pairs; ///< ascending; the six rigid modes are left out
};

/// @param n_modes  deforming modes wanted; eigenspaces that would be cut in two are left out
/// @throws SolveError if SLEPc does not converge
FreeBodyModes free_body_modes(const Eigen::SparseMatrix<double>& fem, const Eigen::SparseMatrix<double>& msm,
                              int n_modes);

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
  Vibrations fem;   ///< none beside a network, whose modes are of its springs alone
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

/// Both models of a scene whose materials have densities, or the springs of a network whose nodes have
/// masses.
/// @param designs  spring designs; empty: the case's own. One that cannot serve the case is refused by itself
/// @throws InputError; SolveError where the finite elements fail
VibrationStudy study_vibrations(const cases::Scene& scene, const std::vector<cases::Design>& designs,
                                int n_modes);

void write_eigenspaces_text(std::ostream& out, const EigenspaceAnalysis& analysis);
void write_free_modes_text(std::ostream& out, const FreeBodyModes& modes);

/// h, fem, msm, equivalent (spaces numbered from 1, as in the thesis) and coupling.
nlohmann::ordered_json eigenspaces_to_json(const EigenspaceAnalysis& analysis);
nlohmann::ordered_json free_modes_to_json(const FreeBodyModes& modes);

/// One panel of a dot diagram.
struct DotDiagram {
  std::string title;
  const EigenspaceAnalysis* analysis;
};

/// Dot diagrams side by side as NAME.csv, .svg and .png (thesis figure 4.11 and appendix A).
void plot_dot_diagrams(const std::string& folder, const std::string& name,
                       const std::vector<DotDiagram>& panels);

/// Writes into a folder the dot diagram of thesis appendix A (dot_diagram.csv, .svg, .png), coupling.csv, and
/// the shapes of all eigenspaces of both cells (fem_modes.vtu, msm_modes.vtu), also as picture sheets
/// (fem_modes.svg, ... ; thesis figures 4.9 and 4.10).
/// @param vertices  vertices of the cell, mm
void write_eigenspaces_files(const std::string& folder, const EigenspaceAnalysis& analysis,
                             const msm::CellVertices& vertices);

/// Writes into a folder the body's modes side by side: body_modes.csv and body_modes.vtu, and their plot.
void write_free_modes_files(const std::string& folder, const FreeBodyModes& modes, const cases::Mesh& mesh);

void write_vibrations_text(std::ostream& out, const VibrationStudy& study);

/// {"case", "fem_hz", "designs": [{"design", "refusal", "modes": [...]}], "modes": those of the first
/// design}; a mode is {"fem_hz", "multiplicity", "msm_hz", "overlap", "error_percent"}.
nlohmann::ordered_json vibrations_to_json(const VibrationStudy& study);

/// FOLDER/NAME_modes.csv, and FOLDER/NAME_modes.vtu with the shapes that were matched.
/// @throws InputError if a file cannot be written
void write_vibrations_files(const std::string& folder, const VibrationStudy& study, const cases::Mesh& mesh);

} // namespace springproof::compare
