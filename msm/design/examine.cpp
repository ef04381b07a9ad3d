#include "msm/design/examine.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::msm {

Signs signs_at_rest(const CellMatrix& matrix) {
  const auto eigenvalues =
      Eigen::SelfAdjointEigenSolver<CellMatrix>(matrix, Eigen::EigenvaluesOnly).eigenvalues().eval();
  // Far above round-off, far below any spring's share.
  const double zero = 1e-9 * eigenvalues.cwiseAbs().maxCoeff();
  return {(eigenvalues.array() < -zero).count(), (eigenvalues.array().abs() <= zero).count()};
}

namespace {

void examine_signs(const CellMatrix& matrix, std::vector<std::string>& warnings) {
  const auto [n_negative, n_zero] = signs_at_rest(matrix);
  if (n_negative > 0)
    warnings.push_back(
        fmt::format("the cell's tangent at rest is indefinite: {} negative eigenvalues", n_negative));
  if (n_zero > 6)
    warnings.push_back(
        fmt::format("the cell is a mechanism: {} zero-energy modes besides the rigid motions", n_zero - 6));
}

} // namespace

std::vector<std::string> examine(const CellStiffness& stiffness, const CellVertices& vertices) {
  std::vector<std::string> warnings;
  for (const auto& [name, value] : {std::pair("edge springs k_e", stiffness.edge),
                                    {"face diagonals k_f", stiffness.face_diagonal},
                                    {"internal diagonals k_d", stiffness.internal_diagonal},
                                    {"volume term k_v", stiffness.volume}}) {
    if (!std::isfinite(value)) return {fmt::format("{}: the stiffness is not a finite number", name)};
    if (value < 0) warnings.push_back(fmt::format("{}: the stiffness is negative", name));
  }
  examine_signs(cell_stiffness_matrix(vertices, stiffness), warnings);
  return warnings;
}

std::vector<std::string> examine(const CellTerms& terms, const CellVertices& vertices) {
  std::vector<std::string> warnings;
  for (const CellSpring& spring : terms.springs)
    if (!std::isfinite(spring.stiffness)) return {"springs: a stiffness is not a finite number"};
  if (std::any_of(terms.springs.begin(), terms.springs.end(),
                  [](const CellSpring& spring) { return spring.stiffness < 0; }))
    warnings.emplace_back("springs: a stiffness is negative");
  if (terms.volume < 0) warnings.emplace_back("volume term k_v: the stiffness is negative");
  examine_signs(cell_stiffness_matrix(vertices, terms), warnings);
  return warnings;
}

} // namespace springproof::msm
