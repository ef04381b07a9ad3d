#include "compare/modes/eigenspaces.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace springproof::compare {

namespace {

constexpr double same_subspace = 1e-6; // tolerance on the cosine of the largest angle

/// @param product  one's transposed basis times the other's; its singular values are the cosines of their
/// angles
bool are_the_same(const Eigen::MatrixXd& product) {
  return product.rows() == product.cols() &&
         Eigen::JacobiSVD<Eigen::MatrixXd>(product).singularValues().minCoeff() > 1 - same_subspace;
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
    const double cosine = Eigen::JacobiSVD<Eigen::MatrixXd>(product).singularValues().minCoeff();
    best = {fem, candidate, candidate.eigenvalue / fem.eigenvalue,
            std::acos(std::min(1.0, cosine)) * 180 / M_PI};
  }
  return best;
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

Eigen::SparseMatrix<double> assemble(const cases::HexMesh& mesh, const msm::CellMatrix& cell) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(mesh.cells.size() * 576);
  for (const std::array<int, 8>& nodes : mesh.cells) {
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

} // namespace springproof::compare
