#include "compare/modes/modes.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "compare/solve/springs.hpp"
#include "msm/moving_springs.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace springproof::compare {

namespace {

constexpr double same_subspace = 1e-6; // tolerance on the cosine of the largest angle

/// @param product  one's transposed basis times the other's; its singular values are the cosines of their
/// angles
bool are_the_same(const Eigen::MatrixXd& product) {
  return product.rows() == product.cols() &&
         mechanics::singular_values(product).minCoeff() > 1 - same_subspace;
}

/// Deforming eigenspaces that end within the wanted modes.
std::vector<Eigenspace> whole_spaces(const Spectrum& spectrum, int last) {
  std::vector<Eigenspace> spaces;
  const double largest = spectrum.values.maxCoeff();
  for (const Eigenspace& space : cluster(spectrum.values))
    if (space.offset + space.dimension <= last && space.eigenvalue > 1e-6 * largest) spaces.push_back(space);
  return spaces;
}

ModePair match(const Eigenspace& fem, const FreeBodyModes& modes, const std::vector<Eigenspace>& candidates) {
  const Eigen::MatrixXd v = basis(modes.fem, fem);
  ModePair best{fem, {}, 0, 90};
  double overlap = -1;
  for (const Eigenspace& candidate : candidates) {
    const Eigen::MatrixXd product = v.transpose() * basis(modes.msm, candidate);
    if (!(product.squaredNorm() > overlap)) continue;
    overlap = product.squaredNorm();
    const double cosine = mechanics::singular_values(product).minCoeff();
    best = {fem, candidate, candidate.eigenvalue / fem.eigenvalue,
            std::acos(std::min(1.0, cosine)) * 180 / M_PI};
  }
  return best;
}

/// Largest omega², over the mean diagonal of K over that of M, that counts as zero: rounding leaves 1e-16,
/// and a beam of a thousand thick cells has 1e-9.
constexpr double no_stiffness = 1e-12;
constexpr double least_overlap = 0.5; ///< least overlap of modes that are called one; a body's are near 1

double hertz_of(double omega_squared) {
  return std::sqrt(omega_squared) / (2 * M_PI);
}

/// Orthonormal columns that span the same space.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> factors(columns);
  return factors.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

/// Vectors of a body's rows as vectors of the mesh's degrees of freedom.
Eigen::MatrixXd on_mesh(const mechanics::VibratingBody& body, const Eigen::MatrixXd& vectors,
                        Eigen::Index n_dofs) {
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(n_dofs, vectors.cols());
  for (std::size_t row = 0; row < body.mesh_dof.size(); ++row)
    if (body.mesh_dof[row] >= 0) shapes.row(body.mesh_dof[row]) = vectors.row(static_cast<Eigen::Index>(row));
  return shapes;
}

/// A space's modes, weighted with the roots of masses, orthonormal.
Eigen::MatrixXd weighted(const Vibrations& vibrations, const std::vector<int>& modes,
                         const Eigen::VectorXd& masses) {
  return orthonormal(masses.cwiseSqrt().asDiagonal() * vibrations.shapes(Eigen::all, modes));
}

std::vector<int> modes_of(const Eigenspace& space) {
  std::vector<int> modes(cases::index(space.dimension));
  std::iota(modes.begin(), modes.end(), space.offset);
  return modes;
}

/// The springs' spaces of the largest parts in the finite elements' one, until there are as many modes.
std::vector<int> best_modes(const Eigen::MatrixXd& fem, const Vibrations& msm,
                            const Eigen::VectorXd& masses) {
  std::vector<std::pair<double, Eigenspace>> candidates;
  for (const Eigenspace& space : cluster(msm.hertz, 0, same_frequency)) {
    const double part = (fem.transpose() * weighted(msm, modes_of(space), masses)).squaredNorm();
    candidates.emplace_back(part / space.dimension, space);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<int> modes;
  for (const auto& [part, space] : candidates) {
    if (static_cast<Eigen::Index>(modes.size()) >= fem.cols()) break;
    const std::vector<int> more = modes_of(space);
    modes.insert(modes.end(), more.begin(), more.end());
  }
  std::sort(modes.begin(), modes.end());
  return modes;
}

DesignVibrations of_design(const cases::Scene& scene, const Vibrations& fem, const Eigen::VectorXd& masses,
                           int n_modes) {
  DesignVibrations found{cases::name_of(scene.definition.msm.design), {}, {}, {}};
  try {
    const msm::Lattice lattice = msm::make_lattice(scene.mesh, design_for(scene).springs);
    const bool is_alone = !cases::has_cells(scene.definition.body);
    found.msm = vibrations_of(msm::vibrating_body(scene, lattice), masses,
                              is_alone ? n_modes : 2 * n_modes + n_beyond);
    if (!is_alone) found.modes = match_modes(fem, found.msm, masses, n_modes);
  } catch (const cases::InputError& error) {
    found.refusal = error.what();
  } catch (const cases::SolveError& error) {
    found.refusal = error.what();
  }
  return found;
}

} // namespace

std::vector<Eigenspace> cluster(const Eigen::VectorXd& ascending, double gap, double relative_gap) {
  std::vector<Eigenspace> spaces;
  int first = 0;
  for (int i = 1; i <= ascending.size(); ++i) {
    if (i < ascending.size() && ascending(i) - ascending(i - 1) <= gap + relative_gap * ascending(i))
      continue;
    spaces.push_back({ascending.segment(first, i - first).mean(), first, i - first});
    first = i;
  }
  return spaces;
}

std::vector<Eigenspace> cluster(const Eigen::VectorXd& ascending) {
  return cluster(ascending, 1e-6 * ascending.cwiseAbs().maxCoeff(), 0);
}

Eigen::MatrixXd basis(const Spectrum& spectrum, const Eigenspace& space) {
  return spectrum.vectors.middleCols(space.offset, space.dimension);
}

EigenspaceAnalysis analyse_eigenspaces(Spectrum fem, Spectrum msm) {
  EigenspaceAnalysis analysis{std::move(fem), std::move(msm), {}, {}, {}, {}, 0};
  analysis.fem_spaces = cluster(analysis.fem.values);
  analysis.msm_spaces = cluster(analysis.msm.values);
  const std::size_t n_fem = analysis.fem_spaces.size(), n_msm = analysis.msm_spaces.size();
  analysis.coupling.resize(n_fem, n_msm);
  for (std::size_t i = 0; i < n_fem; ++i)
    for (std::size_t j = 0; j < n_msm; ++j) {
      const Eigenspace &v = analysis.fem_spaces[i], &w = analysis.msm_spaces[j];
      const Eigen::MatrixXd product = basis(analysis.fem, v).transpose() * basis(analysis.msm, w);
      analysis.coupling(i, j) = product.squaredNorm() / v.dimension;
      if (!are_the_same(product)) continue;
      const int distance = std::abs(w.offset - v.offset);
      analysis.equivalent.push_back({i, j, distance});
      analysis.h += static_cast<double>(i + 1) / static_cast<double>(n_fem) / (distance + 1);
    }
  return analysis;
}

Eigen::MatrixXd canonical_basis(const Eigen::MatrixXd& basis) {
  const double tie = 1e-9; // between lengths of at most 1: a basis's round-off must not choose the column
  Eigen::MatrixXd remaining = basis * basis.transpose();
  Eigen::MatrixXd canonical(basis.rows(), basis.cols());
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    const Eigen::VectorXd lengths = remaining.colwise().norm();
    Eigen::Index chosen = 0;
    while (lengths(chosen) < lengths.maxCoeff() - tie) ++chosen;
    Eigen::VectorXd direction = remaining.col(chosen) / lengths(chosen);
    Eigen::Index largest = 0;
    while (std::abs(direction(largest)) < direction.cwiseAbs().maxCoeff() - tie) ++largest;
    if (direction(largest) < 0) direction = -direction;
    canonical.col(k) = direction;
    remaining -= direction * (direction.transpose() * remaining);
  }
  return canonical;
}

Eigen::SparseMatrix<double> assemble(const cases::Mesh& mesh, const msm::CellMatrix& cell) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(mesh.cells.size() * 576);
  for (const cases::CellNodes& nodes : mesh.cells) {
    const auto dof = [&](int local) { return 3 * nodes[local / 3] + local % 3; };
    for (int row = 0; row < 24; ++row)
      for (int column = 0; column < 24; ++column)
        entries.emplace_back(dof(row), dof(column), cell(row, column));
  }
  const auto size = static_cast<Eigen::Index>(3 * mesh.nodes.size());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

FreeBodyModes free_body_modes(const Eigen::SparseMatrix<double>& fem, const Eigen::SparseMatrix<double>& msm,
                              int n_modes) {
  const int size = static_cast<int>(fem.rows());
  const int last = std::min(size, n_rigid_modes + n_modes);
  const int n_pairs = std::min(size, last + n_beyond);
  FreeBodyModes modes{solvers().lowest_spectrum(fem, n_pairs), solvers().lowest_spectrum(msm, n_pairs), {}};
  const std::vector<Eigenspace> candidates = whole_spaces(modes.msm, n_pairs);
  for (const Eigenspace& space : whole_spaces(modes.fem, last))
    modes.pairs.push_back(match(space, modes, candidates));
  return modes;
}

Eigen::VectorXd mode_masses(const cases::Scene& scene) {
  const std::vector<double> of_points = cases::point_masses(scene, cases::PointMass::cells);
  Eigen::VectorXd masses(static_cast<Eigen::Index>(3 * of_points.size()));
  for (std::size_t p = 0; p < of_points.size(); ++p)
    masses.segment<3>(static_cast<Eigen::Index>(3 * p)).setConstant(of_points[p]);
  return masses;
}

Vibrations vibrations_of(const mechanics::VibratingBody& body, const Eigen::VectorXd& masses, int n_modes) {
  const auto size = static_cast<int>(body.stiffness.rows());
  if (size == 0)
    throw cases::InputError(
        "vibrations: every node is held in all components, and nothing vibrates; hold fewer");
  const Spectrum spectrum =
      solvers().lowest_vibrations(body.stiffness, body.mass, std::min(size, n_modes + n_rigid_modes));
  const double zero =
      no_stiffness * body.stiffness.diagonal().cwiseAbs().mean() / body.mass.diagonal().mean();
  if (spectrum.values.minCoeff() < -zero)
    throw cases::SolveError(
        fmt::format("vibrations: the body is unstable at rest: its lowest omega² is {:.3g} 1/s²",
                    spectrum.values.minCoeff()));
  Vibrations found;
  found.n_rigid = static_cast<int>((spectrum.values.array() <= zero).count());
  const Eigen::Index n = std::min<Eigen::Index>(spectrum.values.size() - found.n_rigid, n_modes);
  found.hertz = spectrum.values.segment(found.n_rigid, n).unaryExpr(&hertz_of);
  found.shapes = on_mesh(body, spectrum.vectors.middleCols(found.n_rigid, n), masses.size());
  return found;
}

std::vector<MatchedModes> match_modes(const Vibrations& fem, const Vibrations& msm,
                                      const Eigen::VectorXd& masses, int n_modes) {
  std::vector<MatchedModes> matched;
  for (const Eigenspace& space : cluster(fem.hertz, 0, same_frequency)) {
    if (space.offset + space.dimension > n_modes) break;
    const std::vector<int> of_fem = modes_of(space);
    const Eigen::MatrixXd basis = weighted(fem, of_fem, masses);
    const std::vector<int> of_msm = best_modes(basis, msm, masses);
    if (of_msm.size() < of_fem.size()) break; // the springs have no more modes
    const Eigen::MatrixXd product = basis.transpose() * weighted(msm, of_msm, masses);
    const double cosine = mechanics::singular_values(product).minCoeff();
    const double fem_hz = fem.hertz(of_fem).mean(), msm_hz = msm.hertz(of_msm).mean();
    matched.push_back(
        {fem_hz, space.dimension, {}, std::min(1., cosine), {}, of_fem.front(), of_msm.front()});
    if (cosine < least_overlap) continue;
    matched.back().msm_hz = msm_hz;
    matched.back().error_percent = 100 * (msm_hz / fem_hz - 1);
  }
  return matched;
}

VibrationStudy study_vibrations(const cases::Scene& scene, const std::vector<cases::Design>& designs,
                                int n_modes) {
  cases::refuse_tools(scene.definition, "eigen", "vibrations are those of a body that nothing touches");
  const bool is_network = !cases::has_cells(scene.definition.body);
  if (is_network && scene.node_masses.empty())
    std::get<cases::Network>(scene.definition.body)
        .nodes.refuse(
            "has no masses, and what has none does not vibrate: give every node a fourth column, kg");
  if (!is_network && !scene.definition.material_dynamics.density)
    throw cases::InputError(
        scene.definition.file +
        ": material.density is missing, must be given: what has no mass does not vibrate");
  const Eigen::VectorXd masses = mode_masses(scene);
  VibrationStudy study{scene.definition.name, {}, {}};
  // One space of the finite elements more than is matched shows whether the last one is whole.
  if (!is_network) study.fem = vibrations_of(solvers().vibrating_elements(scene), masses, n_modes + n_beyond);
  if (designs.empty()) study.designs.push_back(of_design(scene, study.fem, masses, n_modes));
  for (const cases::Design design : designs)
    study.designs.push_back(of_design(with_design(scene, design), study.fem, masses, n_modes));
  return study;
}

} // namespace springproof::compare
