#include "compare/modes/eigenspaces.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <cstdlib>

namespace springproof::compare {

namespace {

constexpr double same_eigenvalue =
    1e-6;                              // of the largest: thesis's printed multiplicities, far above round-off
constexpr double same_subspace = 1e-6; // on the cosine of the largest angle

bool spans_the_same(const Eigen::MatrixXd& v, const Eigen::MatrixXd& w) {
  if (v.cols() != w.cols()) return false;
  const Eigen::VectorXd cosines = Eigen::JacobiSVD<Eigen::MatrixXd>(v.transpose() * w).singularValues();
  return cosines.minCoeff() > 1 - same_subspace;
}

std::vector<Equivalence> find_equivalent(const EigenspaceAnalysis& analysis) {
  std::vector<Equivalence> found;
  for (std::size_t i = 0; i < analysis.fem_spaces.size(); ++i)
    for (std::size_t j = 0; j < analysis.msm_spaces.size(); ++j) {
      const Eigenspace &fem = analysis.fem_spaces[i], &msm = analysis.msm_spaces[j];
      if (spans_the_same(basis(analysis.fem, fem), basis(analysis.msm, msm)))
        found.push_back({static_cast<int>(i), static_cast<int>(j), std::abs(msm.offset - fem.offset)});
    }
  return found;
}

Eigen::MatrixXd couple(const EigenspaceAnalysis& analysis) {
  Eigen::MatrixXd coupling(analysis.fem_spaces.size(), analysis.msm_spaces.size());
  for (Eigen::Index i = 0; i < coupling.rows(); ++i)
    for (Eigen::Index j = 0; j < coupling.cols(); ++j) {
      const Eigen::MatrixXd v = basis(analysis.fem, analysis.fem_spaces[static_cast<std::size_t>(i)]);
      const Eigen::MatrixXd w = basis(analysis.msm, analysis.msm_spaces[static_cast<std::size_t>(j)]);
      coupling(i, j) = (v.transpose() * w).squaredNorm() / static_cast<double>(v.cols());
    }
  return coupling;
}

double quality(const std::vector<Equivalence>& equivalent, std::size_t n_fem_spaces) {
  double h = 0;
  for (const Equivalence& e : equivalent)
    h += (e.fem_space + 1) / static_cast<double>(n_fem_spaces) / (e.distance + 1);
  return h;
}

} // namespace

std::vector<Eigenspace> cluster(const Eigen::VectorXd& ascending) {
  const double gap = same_eigenvalue * ascending.cwiseAbs().maxCoeff();
  std::vector<Eigenspace> spaces;
  int first = 0;
  for (int i = 1; i <= ascending.size(); ++i) {
    if (i < ascending.size() && ascending(i) - ascending(i - 1) <= gap) continue;
    spaces.push_back({ascending.segment(first, i - first).mean(), first, i - first});
    first = i;
  }
  return spaces;
}

Eigen::MatrixXd basis(const Spectrum& spectrum, const Eigenspace& space) {
  return spectrum.vectors.middleCols(space.offset, space.dimension);
}

EigenspaceAnalysis analyse_eigenspaces(Spectrum fem, Spectrum msm) {
  EigenspaceAnalysis analysis;
  analysis.fem = std::move(fem);
  analysis.msm = std::move(msm);
  analysis.fem_spaces = cluster(analysis.fem.values);
  analysis.msm_spaces = cluster(analysis.msm.values);
  analysis.equivalent = find_equivalent(analysis);
  analysis.coupling = couple(analysis);
  analysis.h = quality(analysis.equivalent, analysis.fem_spaces.size());
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

} // namespace springproof::compare
