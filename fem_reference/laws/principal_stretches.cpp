#include "fem_reference/laws/principal_stretches.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

namespace springproof::fem_reference {

namespace {

/// F = sum lambda_i n_i x N_i: columns are the axes.
struct Spectrum {
  Eigen::Vector3d stretches, log_stretches;
  Matrix3 spatial, material;
};

Spectrum decompose(const Matrix3& f) {
  // eigenvectors of C are orthonormal to rounding error even when eigenvalues (nearly) coincide
  const Eigen::SelfAdjointEigenSolver<Matrix3> eigen(f.transpose() * f);
  Spectrum s;
  s.material = eigen.eigenvectors();
  s.stretches = eigen.eigenvalues().cwiseSqrt();
  s.log_stretches = s.stretches.array().log();
  s.spatial = f * s.material * s.stretches.cwiseInverse().asDiagonal();
  return s;
}

constexpr int pairs[3][2] = {{1, 2}, {2, 0}, {0, 1}};

/// A in the axes n, N; row and column 3*i + j belong to n_i x N_j.
Matrix9 principal_tangent(const PrincipalStress& s, const Eigen::Vector3d& stretches) {
  Matrix9 tangent = Matrix9::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      tangent(4 * i, 4 * j) = (s.slope(i, j) - (i == j ? s.kirchhoff(i) : 0)) / (stretches(i) * stretches(j));
  for (int p = 0; p < 3; ++p) {
    const int i = pairs[p][0], j = pairs[p][1];
    const double m = s.difference(p);
    const double crossed = (stretches(j) * stretches(j) * m - s.kirchhoff(j)) / (stretches(i) * stretches(j));
    tangent(3 * i + j, 3 * i + j) = tangent(3 * j + i, 3 * j + i) = m;
    tangent(3 * i + j, 3 * j + i) = tangent(3 * j + i, 3 * i + j) = crossed;
  }
  return tangent;
}

} // namespace

double sinh_ratio(double a, double d) {
  if (std::abs(d) > 1e-3) return std::sinh(a * d) / std::sinh(d);
  // a (1 + (a²-1) d²/6 + (a²-1)(3a²-7) d⁴/360): the next term is below 1e-17 a⁶ here
  const double square = d * d, excess = a * a - 1;
  return a * (1 + excess * square / 6 * (1 + (3 * a * a - 7) * square / 60));
}

StressLaw in_principal_stretches(PrincipalLaw law) {
  return [law = std::move(law)](const Matrix3& f, Wanted wanted, PointStress& result) {
    const Spectrum spectrum = decompose(f);
    const PrincipalStress principal = law(spectrum.log_stretches, wanted);
    const Eigen::Vector3d first = principal.kirchhoff.cwiseQuotient(spectrum.stretches);
    result.stress = flatten(spectrum.spatial * first.asDiagonal() * spectrum.material.transpose());
    if (wanted == Wanted::stress) return;
    Matrix9 axes; // column 3*i + j is n_i x N_j
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            axes(3 * a + b, 3 * i + j) = spectrum.spatial(a, i) * spectrum.material(b, j);
    const Matrix9 half = axes * principal_tangent(principal, spectrum.stretches);
    result.tangent.noalias() = half * axes.transpose();
  };
}

} // namespace springproof::fem_reference
