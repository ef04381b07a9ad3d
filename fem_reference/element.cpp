#include "fem_reference/element.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cassert>

/// BLAS's product C = A B, each factor as it is ("N") or transposed ("T"), stored by columns.
extern "C" void dgemm_(const char* transpose_a, const char* transpose_b, const int* rows, const int* columns,
                       const int* inner, const double* alpha, const double* a, const int* stride_a,
                       const double* b, const int* stride_b, const double* beta, double* c,
                       const int* stride_c);

namespace springproof::fem_reference {

namespace {

constexpr std::array<ElementType, 5> table{{{cases::Element::q1, 1, Pressure::pointwise, 0},
                                            {cases::Element::q1_bbar, 1, Pressure::modes, 1},
                                            {cases::Element::q1_p0, 1, Pressure::modes, 1},
                                            {cases::Element::q2, 2, Pressure::pointwise, 0},
                                            {cases::Element::q2_p1, 2, Pressure::modes, 4}}};

} // namespace

ElementType element_type(const cases::Fem& fem, const LawTraits& law) {
  const auto row =
      std::find_if(table.begin(), table.end(), [&](const auto& t) { return t.name == fem.element; });
  assert(row != table.end());
  if (law.split == Split::none && row->pressure != Pressure::pointwise)
    throw cases::InputError(
        fem.where, "this formulation's stress has no separate pressure, which q1_bbar, q1_p0 and q2_p1 "
                   "need; allowed here: q1, q2");
  return *row;
}

CellKernel::CellKernel(const ElementType& element) : element_(element) {
  const int n_nodes = (element.degree + 1) * (element.degree + 1) * (element.degree + 1);
  const int n_dofs = 3 * n_nodes, n_modes = element.n_pressure_modes;
  const auto n_points = static_cast<std::size_t>(n_nodes);
  dilatation_.resize(n_points);
  cofactor_.resize(n_points);
  target_.resize(n_points);
  result_.force.resize(n_dofs);
  result_.tangent.resize(n_dofs, n_dofs);
  result_.pressure_residual.resize(n_modes);
  result_.pressure_slope.resize(n_modes, n_dofs);
  volume_gradient_.resize(n_modes, n_dofs);
  right_factor_.resize(27 * n_points * n_points);
}

Matrix3 CellKernel::displacement_gradient(const CellGeometry& g, int q, const double* displacement) {
  Matrix3 h = Matrix3::Zero();
  const double* gradient = g.gradients + 3 * q * g.n_nodes;
  for (int j = 0; j < 3; ++j)
    for (int a = 0; a < g.n_nodes; ++a)
      for (int i = 0; i < 3; ++i) h(i, j) += displacement[3 * a + i] * gradient[j * g.n_nodes + a];
  return h;
}

double CellKernel::deformed_volume(const CellGeometry& g, const double* displacement) {
  double rest = 0, growth = 0;
  for (int q = 0; q < g.n_points; ++q) {
    rest += g.weights[q];
    growth += g.weights[q] * dilatation(Kinematics::finite, displacement_gradient(g, q, displacement));
  }
  return rest + growth;
}

void CellKernel::add_point(const CellGeometry& g, int q, Wanted wanted) {
  const int n = g.n_nodes, n_dofs = 3 * n;
  const double* gradient = g.gradients + 3 * q * n;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double weighted = g.weights[q] * stress_.stress(3 * i + j);
      for (int a = 0; a < n; ++a) result_.force[i * n + a] += weighted * gradient[j * n + a];
    }
  if (wanted == Wanted::stress) return;
  for (int row = 0; row < 9; ++row) {
    const int i = row / 3, j = row % 3;
    double* out = right_factor_.data() + ((i * g.n_points + q) * 3 + j) * n_dofs;
    for (int k = 0; k < 3; ++k) {
      const double x = g.weights[q] * stress_.tangent(row, 3 * k),
                   y = g.weights[q] * stress_.tangent(row, 3 * k + 1),
                   z = g.weights[q] * stress_.tangent(row, 3 * k + 2);
      for (int b = 0; b < n; ++b)
        out[k * n + b] = x * gradient[b] + y * gradient[n + b] + z * gradient[2 * n + b];
    }
  }
}

/// K_(i,a)(k,b) = sum over points and J of dN_a/dX_J (w A grad N)_iJ,(k,b): one matrix product per i.
void CellKernel::add_stiffness(const CellGeometry& g) {
  const int columns = 3 * g.n_nodes, rows = g.n_nodes, inner = 3 * g.n_points;
  const double one = 1, zero = 0;
  for (int i = 0; i < 3; ++i) // BLAS counts columns first: it sees the transposes
    dgemm_("N", "T", &columns, &rows, &inner, &one, right_factor_.data() + i * inner * columns, &columns,
           g.gradients, &rows, &zero, result_.tangent.data() + i * rows * columns, &columns);
}

/// B_m = sum w phi_m cof F . grad N: the gradient of the moments of the cell's volume.
void CellKernel::volume_gradients(const CellGeometry& g) {
  const int n = g.n_nodes, n_modes = element_.n_pressure_modes;
  volume_gradient_.setZero();
  for (int q = 0; q < g.n_points; ++q)
    for (int m = 0; m < n_modes; ++m) {
      const Matrix3 area = g.weights[q] * g.modes[q * n_modes + m] * cofactor_[static_cast<std::size_t>(q)];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          for (int a = 0; a < n; ++a)
            volume_gradient_(m, i * n + a) += area(i, j) * g.gradients[(3 * q + j) * n + a];
    }
}

void CellKernel::condense(const CellGeometry& g, Wanted wanted) {
  const int n_modes = element_.n_pressure_modes;
  Eigen::VectorXd residual = Eigen::VectorXd::Zero(n_modes);
  Eigen::MatrixXd compliance = Eigen::MatrixXd::Zero(n_modes, n_modes);
  double rest_volume = 0;
  for (int q = 0; q < g.n_points; ++q) {
    const Eigen::Map<const Eigen::VectorXd> mode(g.modes + q * n_modes, n_modes);
    const auto& target = target_[static_cast<std::size_t>(q)];
    residual += g.weights[q] * (dilatation_[static_cast<std::size_t>(q)] - target.value) * mode;
    compliance += g.weights[q] * target.slope * mode * mode.transpose();
    rest_volume += g.weights[q];
  }
  result_.volume_mismatch = residual.cwiseAbs().maxCoeff() / rest_volume;
  if (wanted == Wanted::stress) return;
  volume_gradients(g);
  const Eigen::LLT<Eigen::MatrixXd> factor(compliance);
  result_.pressure_slope = factor.solve(volume_gradient_);
  result_.pressure_residual = factor.solve(residual);
  result_.force.noalias() += volume_gradient_.transpose() * result_.pressure_residual;
  result_.tangent.noalias() += volume_gradient_.transpose() * result_.pressure_slope;
}

const CellResult& CellKernel::evaluate(const CellGeometry& g, const double* displacement,
                                       const double* pressure, Wanted wanted) {
  result_.force.setZero();
  result_.valid = add_points(g, displacement, pressure, wanted);
  if (!result_.valid) return result_;
  result_.volume_mismatch = 0;
  result_.plain_force = result_.force;
  if (wanted == Wanted::stress_and_tangent) add_stiffness(g);
  if (element_.pressure == Pressure::modes) condense(g, wanted);
  return result_;
}

} // namespace springproof::fem_reference
