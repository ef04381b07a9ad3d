#include "compare/modes/free_modes.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace springproof::compare {

namespace {

constexpr int n_rigid_modes = 6;
constexpr int n_beyond = 8; // computed beyond the wanted ones, so that the last eigenspace wanted is whole

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

Eigen::SparseMatrix<double> assemble(const cases::HexMesh& mesh, const std::vector<msm::CellMatrix>& cells) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(mesh.cells.size() * 576);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const msm::CellMatrix& cell = cells.size() == 1 ? cells.front() : cells.at(c);
    const auto dof = [&](int local) {
      return 3 * mesh.cells[c][static_cast<std::size_t>(local / 3)] + local % 3;
    };
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
  FreeBodyModes modes{lowest_spectrum(fem, n_pairs), lowest_spectrum(msm, n_pairs), {}};
  const std::vector<Eigenspace> candidates = whole_spaces(modes.msm, n_pairs);
  for (const Eigenspace& space : whole_spaces(modes.fem, last))
    modes.pairs.push_back(match(space, modes, candidates));
  return modes;
}

} // namespace springproof::compare
