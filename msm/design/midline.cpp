#include "msm/design/midline.hpp"

#include "msm/design/minimise.hpp"
#include "msm/design/request.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace springproof::msm {

namespace {

using cases::index;
using Eigen::Vector3d;

/// Least part of an edge's stiffness that stays: a lattice whose edges carry nothing has waves without
/// energy.
constexpr double least_edge_part = 0.05;

constexpr double beta_of_many = 0.8; // docs/developing/design-theory.md

/// The axis of a spring that is an edge.
int axis_of(const CellSpring& edge) {
  const int crossed = edge.vertices[0] ^ edge.vertices[1];
  return crossed == 1 ? 0 : crossed == 2 ? 1 : 2;
}

/// Moves the part 1 - r of the edges' stiffness along each axis to its midline.
CellTerms divided(CellTerms terms, const double* r) {
  std::array<CellMidline, 3> midlines{{{0, 0}, {1, 0}, {2, 0}}};
  for (CellSpring& spring : terms.springs) {
    if (n_axes(spring) != 1) continue;
    CellMidline& midline = midlines[index(axis_of(spring))];
    const double stays = r[midline.axis] * spring.stiffness;
    midline.stiffness += spring.stiffness - stays;
    midline.law = spring.law;
    spring.stiffness = stays;
  }
  terms.midlines.assign(midlines.begin(), midlines.end());
  return terms;
}

/// A slender bar of one cell across, bent by end moments.
class Bar {
 public:
  /// @param fibre, gradient  axes: along the bar, and the one along which the strain grows
  Bar(const CellVertices& vertices, int fibre, int gradient) {
    const int across = 3 - fibre - gradient;
    Vector3d centre = Vector3d::Zero(), edges = Vector3d::Zero();
    for (std::size_t v = 0; v < 8; ++v) {
      centre += vertices[v] / 8;
      for (int a = 0; a < 3; ++a) edges[a] += ((v >> a & 1U) != 0 ? 0.25 : -0.25) * vertices[v][a];
    }
    for (int v = 0; v < 8; ++v) {
      const Vector3d at = vertices[index(v)] - centre;
      modes_(3 * v + fibre, 0) = at[gradient] * at[fibre];
      modes_(3 * v + across, 1) = at[gradient] * at[across];
    }
    inertia_ = edges[across] * std::pow(edges[gradient], 3) * edges[fibre] / 12;
  }
  /// Energies of curvature 1 and of the anticlastic shape, and what couples them: linear in the stiffnesses.
  Eigen::Matrix2d energies(const CellMatrix& stiffness) const {
    return modes_.transpose() * stiffness * modes_;
  }
  /// E I, whose anticlastic shape is free, over the exact one.
  double stiffness(const Eigen::Matrix2d& energies, double youngs_modulus) const {
    return energies.determinant() / energies(1, 1) / (youngs_modulus * inertia_);
  }

 private:
  Eigen::Matrix<double, 24, 2> modes_ = Eigen::Matrix<double, 24, 2>::Zero();
  double inertia_;
};

/// Logarithms of six bars' E I over the exact ones.
class BendingErrors {
 public:
  BendingErrors(const CellTerms& terms, const CellVertices& vertices)
      : youngs_moduli_(cell_elasticity({terms}, vertices).inverse().diagonal().cwiseInverse()) {
    for (int fibre = 0; fibre < 3; ++fibre)
      for (int other = 1; other < 3; ++other) bars_.emplace_back(vertices, fibre, (fibre + other) % 3);
    const double parts[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t p = 0; p < 4; ++p) {
      const CellMatrix stiffness = cell_stiffness_matrix(vertices, divided(terms, parts[p]));
      for (std::size_t b = 0; b < 6; ++b)
        energies_[b][p] = bars_[b].energies(stiffness) - (p > 0 ? energies_[b][0] : Eigen::Matrix2d::Zero());
    }
  }
  bool operator()(const double* r, double* errors) const {
    for (std::size_t b = 0; b < 6; ++b) {
      const auto& of = energies_[b];
      const double ratio = bars_[b].stiffness(of[0] + r[0] * of[1] + r[1] * of[2] + r[2] * of[3],
                                              youngs_moduli_[static_cast<Eigen::Index>(b / 2)]);
      if (!(ratio > 0)) return false;
      errors[b] = std::log(ratio);
    }
    return true;
  }

 private:
  Eigen::Matrix<double, 6, 1> youngs_moduli_;
  std::vector<Bar> bars_;
  std::array<std::array<Eigen::Matrix2d, 4>, 6> energies_; ///< each bar's: without edges, and by axis
};

} // namespace

double edge_part(double poissons_ratio, double split, double beta) {
  const double m = (1 + poissons_ratio) / 3, f = 1 - split;
  return std::min(1., beta * (m - f + std::hypot(m, f)) / (1 + split));
}

double default_beta(int cells_across) {
  if (cells_across >= DesignRequest::many_cells) return beta_of_many;
  const double n = cells_across;
  return beta_of_many + (1 - beta_of_many) / (n * n);
}

CellStiffness with_midlines(CellStiffness stiffness, double edge_part) {
  stiffness.midline = 4 * (1 - edge_part) * stiffness.edge;
  stiffness.edge *= edge_part;
  return stiffness;
}

double bending_stiffness(const CellTerms& terms, const CellVertices& vertices, int fibre, int gradient) {
  const Bar bar(vertices, fibre, gradient);
  const Elasticity compliance = cell_elasticity({terms}, vertices).inverse();
  return bar.stiffness(bar.energies(cell_stiffness_matrix(vertices, terms)), 1 / compliance(fibre, fibre));
}

void add_midlines(CellTerms& terms, const CellVertices& vertices, double beta) {
  std::array<double, 3> r{0.5, 0.5, 0.5};
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::NumericDiffCostFunction<BendingErrors, ceres::CENTRAL, 6, 3>(
                               new BendingErrors(terms, vertices)),
                           nullptr, r.data());
  for (int axis = 0; axis < 3; ++axis) {
    problem.SetParameterLowerBound(r.data(), axis, least_edge_part);
    problem.SetParameterUpperBound(r.data(), axis, 1);
  }
  ceres::Solver::Options options;
  options.max_num_iterations = 100;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-14;
  // A cell too distorted to be bent like a bar keeps its edges.
  if (!minimise(problem, options).IsSolutionUsable()) r = {1, 1, 1};
  for (double& part : r) part = std::min(1., part * beta);
  terms = divided(terms, r.data());
}

} // namespace springproof::msm
