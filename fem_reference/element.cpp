#include "fem_reference/element.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <petscsys.h>

#include <petscblaslapack.h>

namespace springproof::fem_reference {

namespace {

constexpr std::array<ElementType, 5> table{{{cases::Element::q1, 1, Pressure::pointwise, 0},
                                            {cases::Element::q1_bbar, 1, Pressure::modes, 1},
                                            {cases::Element::q1_p0, 1, Pressure::modes, 1},
                                            {cases::Element::q2, 2, Pressure::pointwise, 0},
                                            {cases::Element::q2_p1, 2, Pressure::modes, 4}}};

} // namespace

ElementType element_type(const cases::Fem& fem, const Formulation& formulation) {
  const auto row =
      std::find_if(table.begin(), table.end(), [&](const auto& t) { return t.name == fem.element; });
  assert(row != table.end());
  if (!formulation.volumetric && row->pressure != Pressure::pointwise)
    throw cases::InputError(
        fem.where, "this formulation's stress has no separate pressure, which q1_bbar, q1_p0 and q2_p1 "
                   "need; allowed here: q1, q2");
  return *row;
}

CellKernel::CellKernel(const ElementType& element, const Formulation& formulation)
    : element_(element), formulation_(formulation) {
  const int n_nodes = (element.degree + 1) * (element.degree + 1) * (element.degree + 1);
  const auto n_points = static_cast<std::size_t>(n_nodes), n_dofs = 3 * n_points;
  const auto n_modes = static_cast<std::size_t>(element.n_pressure_modes);
  deformation_gradient_.resize(n_points);
  cofactor_.resize(n_points);
  volume_ratio_.resize(n_points);
  pressure_.resize(n_points);
  target_.resize(n_points);
  result_.force.resize(n_dofs);
  result_.plain_force.resize(n_dofs);
  result_.tangent.resize(n_dofs * n_dofs);
  result_.volume_residual.resize(n_modes);
  result_.pressure_residual.resize(n_modes);
  result_.pressure_slope.resize(n_modes * n_dofs);
  volume_gradient_.resize(n_modes * n_dofs);
  right_factor_.resize(9 * n_points * n_dofs);
}

void CellKernel::kinematics(const CellGeometry& g, const double* displacement) {
  result_.valid = true;
  result_.volume = 0;
  for (int q = 0; q < g.n_points; ++q) {
    Matrix3& f = deformation_gradient_[static_cast<std::size_t>(q)];
    f.setIdentity();
    const double* gradient = g.gradients + 3 * q * g.n_nodes;
    for (int j = 0; j < 3; ++j)
      for (int a = 0; a < g.n_nodes; ++a)
        for (int i = 0; i < 3; ++i) f(i, j) += displacement[3 * a + i] * gradient[j * g.n_nodes + a];
    const double ratio = volume_ratio(formulation_.kinematics, f);
    volume_ratio_[static_cast<std::size_t>(q)] = ratio;
    cofactor_[static_cast<std::size_t>(q)] = cofactor(formulation_.kinematics, f);
    result_.volume += g.weights[q] * ratio;
    // linear kinematics have no inverted state; written so that NaN is refused
    const bool admissible = formulation_.kinematics == Kinematics::linear ? std::isfinite(ratio) : ratio > 0;
    if (!admissible) result_.valid = false;
  }
}

/// Pressure at every point: value, and slope dp/dJ where the law is followed rather than interpolated.
void CellKernel::pressures(const CellGeometry& g, const double* pressure) {
  const VolumetricLaw& law = *formulation_.volumetric;
  for (int q = 0; q < g.n_points; ++q) {
    const auto point = static_cast<std::size_t>(q);
    if (element_.pressure == Pressure::pointwise) {
      pressure_[point] = law.pressure(volume_ratio_[point]);
      continue;
    }
    double p = 0;
    for (int m = 0; m < element_.n_pressure_modes; ++m)
      p += g.modes[q * element_.n_pressure_modes + m] * pressure[m];
    pressure_[point] = {p, 0};
    target_[point] = law.volume_ratio(p);
  }
}

/// Force, and w A grad N for the tangent, with A = dP/dF including the pressure's geometric (and pointwise
/// material) part.
void CellKernel::stresses(const CellGeometry& g, Wanted wanted) {
  const int n = g.n_nodes, n_dofs = 3 * n;
  std::fill(result_.force.begin(), result_.force.end(), 0.);
  for (int q = 0; q < g.n_points; ++q) {
    const auto point = static_cast<std::size_t>(q);
    const Matrix3& f = deformation_gradient_[point];
    formulation_.stress(f, wanted, point_);
    if (formulation_.volumetric) {
      const Vector9 area = flatten(cofactor_[point]);
      point_.stress += pressure_[point].value * area;
      if (wanted == Wanted::stress_and_tangent) {
        add_cofactor_derivative(formulation_.kinematics, f, pressure_[point].value, point_.tangent);
        if (element_.pressure == Pressure::pointwise)
          point_.tangent.noalias() += pressure_[point].slope * area * area.transpose();
      }
    }
    const double* gradient = g.gradients + 3 * q * n;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double weighted = g.weights[q] * point_.stress(3 * i + j);
        for (int a = 0; a < n; ++a)
          result_.force[static_cast<std::size_t>(i * n + a)] += weighted * gradient[j * n + a];
      }
    if (wanted == Wanted::stress) continue;
    for (int row = 0; row < 9; ++row) {
      const int i = row / 3, j = row % 3;
      double* out = right_factor_.data() + ((i * g.n_points + q) * 3 + j) * n_dofs;
      for (int k = 0; k < 3; ++k) {
        const double x = g.weights[q] * point_.tangent(row, 3 * k),
                     y = g.weights[q] * point_.tangent(row, 3 * k + 1),
                     z = g.weights[q] * point_.tangent(row, 3 * k + 2);
        for (int b = 0; b < n; ++b)
          out[k * n + b] = x * gradient[b] + y * gradient[n + b] + z * gradient[2 * n + b];
      }
    }
  }
}

/// K_(i,a)(k,b) = sum over points and J of dN_a/dX_J (w A grad N)_iJ,(k,b): one matrix product per i.
void CellKernel::add_stiffness(const CellGeometry& g) {
  const PetscBLASInt columns = 3 * g.n_nodes, rows = g.n_nodes, inner = 3 * g.n_points;
  const PetscScalar one = 1, zero = 0;
  for (int i = 0; i < 3; ++i) // BLAS counts columns first: it sees the transposes
    BLASgemm_("N", "T", &columns, &rows, &inner, &one, right_factor_.data() + i * inner * columns, &columns,
              g.gradients, &rows, &zero, result_.tangent.data() + i * rows * columns, &columns);
}

/// B_m = sum w phi_m cof F . grad N: the gradient of the moments of the cell's volume.
void CellKernel::volume_gradients(const CellGeometry& g) {
  const int n = g.n_nodes, n_modes = element_.n_pressure_modes;
  std::fill(volume_gradient_.begin(), volume_gradient_.end(), 0.);
  for (int q = 0; q < g.n_points; ++q)
    for (int m = 0; m < n_modes; ++m) {
      const Matrix3 area = g.weights[q] * g.modes[q * n_modes + m] * cofactor_[static_cast<std::size_t>(q)];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          for (int a = 0; a < n; ++a)
            volume_gradient_[static_cast<std::size_t>((m * 3 + i) * n + a)] +=
                area(i, j) * g.gradients[(3 * q + j) * n + a];
    }
}

void CellKernel::condense(const CellGeometry& g, Wanted wanted) {
  const int n_modes = element_.n_pressure_modes;
  const auto n_dofs = static_cast<Eigen::Index>(result_.force.size());
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(n_modes);
  Eigen::MatrixXd compliance = Eigen::MatrixXd::Zero(n_modes, n_modes);
  double rest_volume = 0;
  for (int q = 0; q < g.n_points; ++q) {
    const Eigen::Map<const Eigen::VectorXd> mode(g.modes + q * n_modes, n_modes);
    const auto& target = target_[static_cast<std::size_t>(q)];
    residual += g.weights[q] * (volume_ratio_[static_cast<std::size_t>(q)] - target.value) * mode;
    compliance += g.weights[q] * target.slope * mode * mode.transpose();
    rest_volume += g.weights[q];
  }
  result_.volume_mismatch = residual.cwiseAbs().maxCoeff() / rest_volume;
  std::copy(residual.data(), residual.data() + n_modes, result_.volume_residual.begin());
  if (wanted == Wanted::stress) return;
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const RowMajor> gradient(volume_gradient_.data(), n_modes, n_dofs);
  Eigen::Map<RowMajor> slope(result_.pressure_slope.data(), n_modes, n_dofs);
  Eigen::Map<Eigen::VectorXd> change(result_.pressure_residual.data(), n_modes);
  const Eigen::LLT<Eigen::MatrixXd> factor(compliance);
  slope = factor.solve(gradient);
  change = factor.solve(residual);
  Eigen::Map<Eigen::VectorXd>(result_.force.data(), n_dofs).noalias() += gradient.transpose() * change;
  Eigen::Map<RowMajor>(result_.tangent.data(), n_dofs, n_dofs).noalias() += gradient.transpose() * slope;
}

const CellResult& CellKernel::evaluate(const CellGeometry& g, const double* displacement,
                                       const double* pressure, Wanted wanted) {
  kinematics(g, displacement);
  if (!result_.valid) return result_;
  result_.volume_mismatch = 0;
  if (formulation_.volumetric) pressures(g, pressure);
  stresses(g, wanted);
  result_.plain_force = result_.force;
  if (wanted == Wanted::stress_and_tangent) {
    add_stiffness(g);
    if (element_.pressure == Pressure::modes) volume_gradients(g);
  }
  if (element_.pressure == Pressure::modes) condense(g, wanted);
  return result_;
}

} // namespace springproof::fem_reference
