#include "fem_reference/element.hpp"

#include "cases/case/elements.hpp"
#include "cases/case/names.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cassert>
#include <fmt/format.h>
#include <numeric>

/// BLAS's product C = A B, each factor as it is ("N") or transposed ("T"), stored by columns.
extern "C" void dgemm_(const char* transpose_a, const char* transpose_b, const int* rows, const int* columns,
                       const int* inner, const double* alpha, const double* a, const int* stride_a,
                       const double* b, const int* stride_b, const double* beta, double* c,
                       const int* stride_c);

namespace springproof::fem_reference {

namespace {

using cases::Element;

constexpr auto tetrahedron = cases::CellShape::tetrahedron;

/// What of an element only its cells' equations know; cases::facts_of() has the rest.
struct Row {
  Element element;
  int n_pressure_modes;
  int n_bubbles = 0;
};
constexpr std::array<Row, 6> table{{{Element::q1_wilson, 0, 3},
                                    {Element::q1_bbar, 1},
                                    {Element::q1_p0, 1},
                                    {Element::q2_p1, 4},
                                    {Element::p2_p0, 1},
                                    {Element::p2_p1, 4}}};

} // namespace

ElementType element_type(const cases::Fem& fem, const LawTraits& law) {
  const cases::ElementFacts& facts = cases::facts_of(fem.element);
  if (law.split == Split::none && facts.has_pressure)
    throw cases::InputError(
        fem.where,
        fmt::format("this formulation's stress has no separate pressure, which {} needs; allowed "
                    "here: {}",
                    cases::name_of(fem.element),
                    cases::alternatives(cases::elements_of(fem, facts.is_tetrahedron))));
  const auto row =
      std::find_if(table.begin(), table.end(), [&](const Row& one) { return one.element == fem.element; });
  const Row own = row != table.end() ? *row : Row{fem.element, 0};
  assert(facts.has_pressure == (own.n_pressure_modes > 0));
  const Pressure with_modes = facts.is_mixed ? Pressure::nodes : Pressure::modes;
  return {fem.element,          facts.is_tetrahedron ? tetrahedron : cases::CellShape::hexahedron,
          facts.degree,         facts.has_pressure ? with_modes : Pressure::pointwise,
          own.n_pressure_modes, own.n_bubbles};
}

int ElementType::n_nodes() const {
  if (shape == tetrahedron) return degree == 1 ? 4 : 10;
  return (degree + 1) * (degree + 1) * (degree + 1);
}

int ElementType::n_points() const {
  if (shape == tetrahedron) return degree == 1 ? 1 : 4;
  return n_nodes();
}

CellKernel::CellKernel(const ElementType& element) : element_(element) {
  const int n_nodes = element.n_nodes();
  const int n_dofs = 3 * n_nodes, n_functions = n_nodes + element.n_bubbles;
  const int n_modes = element.n_pressure_modes, n_internal = element.n_internal();
  const auto n_points = static_cast<std::size_t>(element.n_points());
  dilatation_.resize(n_points);
  cofactor_.resize(n_points);
  target_.resize(n_points);
  const int n_rows = n_dofs + (element.pressure == Pressure::nodes ? n_modes : 0);
  result_.force.resize(n_rows);
  result_.tangent.resize(n_rows, n_rows);
  result_.internal_residual.resize(n_internal);
  result_.internal_slope.resize(n_internal, n_dofs);
  force_.resize(3 * n_functions);
  stiffness_.resize(3 * n_functions, 3 * n_functions);
  displacement_.resize(3 * static_cast<std::size_t>(n_functions));
  volume_gradient_.resize(n_modes, n_dofs);
  right_factor_.resize(27 * n_points * static_cast<std::size_t>(n_functions));
}

Matrix3 CellKernel::displacement_gradient(const CellGeometry& g, int q, const double* displacement,
                                          int n_functions) {
  Matrix3 h = Matrix3::Zero();
  const double* gradient = g.gradients + 3 * q * g.n_functions;
  for (int j = 0; j < 3; ++j)
    for (int a = 0; a < n_functions; ++a)
      for (int i = 0; i < 3; ++i) h(i, j) += displacement[3 * a + i] * gradient[j * g.n_functions + a];
  return h;
}

const double* CellKernel::with_bubbles(const CellGeometry& g, const double* displacement,
                                       const double* internal) {
  if (element_.n_bubbles == 0) return displacement;
  std::copy_n(displacement, 3 * g.n_nodes, displacement_.begin());
  std::copy_n(internal, 3 * element_.n_bubbles, displacement_.begin() + 3 * g.n_nodes);
  return displacement_.data();
}

double CellKernel::deformed_volume(const CellGeometry& g, const double* displacement) {
  double rest = 0, growth = 0;
  for (int q = 0; q < g.n_points; ++q) {
    rest += g.weights[q];
    growth +=
        g.weights[q] * dilatation(Kinematics::finite, displacement_gradient(g, q, displacement, g.n_nodes));
  }
  return rest + growth;
}

void CellKernel::add_point(const CellGeometry& g, int q, Wanted wanted) {
  const int n = g.n_functions, n_dofs = 3 * n;
  const double* gradient = g.gradients + 3 * q * n;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double weighted = g.weights[q] * stress_.stress(3 * i + j);
      for (int a = 0; a < n; ++a) force_[i * n + a] += weighted * gradient[j * n + a];
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
  const int columns = 3 * g.n_functions, rows = g.n_functions, inner = 3 * g.n_points;
  const double one = 1, zero = 0;
  for (int i = 0; i < 3; ++i) // BLAS counts columns first: it sees the transposes
    dgemm_("N", "T", &columns, &rows, &inner, &one, right_factor_.data() + i * inner * columns, &columns,
           g.gradients, &rows, &zero, stiffness_.data() + i * rows * columns, &columns);
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

/// Sets R and C.
void CellKernel::balance_volumes(const CellGeometry& g) {
  const int n_modes = element_.n_pressure_modes;
  volume_residual_.setZero(n_modes);
  compliance_.setZero(n_modes, n_modes);
  for (int q = 0; q < g.n_points; ++q) {
    const Eigen::Map<const Eigen::VectorXd> mode(g.modes + q * n_modes, n_modes);
    const auto& target = target_[static_cast<std::size_t>(q)];
    volume_residual_ += g.weights[q] * (dilatation_[static_cast<std::size_t>(q)] - target.value) * mode;
    compliance_ += g.weights[q] * target.slope * mode * mode.transpose();
  }
}

void CellKernel::condense(const CellGeometry& g, Wanted wanted) {
  balance_volumes(g);
  const double rest_volume = std::accumulate(g.weights, g.weights + g.n_points, 0.);
  result_.volume_mismatch = volume_residual_.cwiseAbs().maxCoeff() / rest_volume;
  if (wanted == Wanted::stress) return;
  volume_gradients(g);
  const Eigen::LLT<Eigen::MatrixXd> factor(compliance_);
  result_.internal_slope = factor.solve(volume_gradient_);
  result_.internal_residual = factor.solve(volume_residual_);
  result_.force.noalias() += volume_gradient_.transpose() * result_.internal_residual;
  result_.tangent.noalias() += volume_gradient_.transpose() * result_.internal_slope;
}

void CellKernel::append_pressures(const CellGeometry& g, Wanted wanted) {
  balance_volumes(g);
  result_.force << force_, volume_residual_;
  result_.plain_force = result_.force;
  if (wanted == Wanted::stress) return;
  volume_gradients(g);
  result_.tangent << stiffness_, volume_gradient_.transpose(), volume_gradient_, -compliance_;
}

void CellKernel::condense_bubbles(const CellGeometry& g, Wanted wanted) {
  const int n = g.n_nodes, n_functions = g.n_functions, n_bubbles = element_.n_bubbles;
  std::vector<int> nodes, bubbles; // degrees of freedom among all functions'; bubbles as in the state
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < n; ++a) nodes.push_back(i * n_functions + a);
  for (int b = 0; b < n_bubbles; ++b)
    for (int i = 0; i < 3; ++i) bubbles.push_back(i * n_functions + n + b);
  const Eigen::VectorXd on_bubbles = force_(bubbles);
  result_.force = force_(nodes);
  result_.plain_force = result_.force;
  result_.bubble_imbalance = on_bubbles.squaredNorm();
  if (wanted == Wanted::stress) return;
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(stiffness_(bubbles, bubbles));
  const Eigen::MatrixXd coupling = stiffness_(nodes, bubbles);
  result_.internal_residual = -factor.solve(on_bubbles);
  result_.internal_slope = -factor.solve(Eigen::MatrixXd(stiffness_(bubbles, nodes)));
  result_.force += coupling * result_.internal_residual;
  result_.tangent = stiffness_(nodes, nodes) + coupling * result_.internal_slope;
}

/// P = F S, so dP_iJ/dF_kL has S_JL for i = k.
void CellKernel::remember(Kinematics kinematics, const Matrix3& f, int point, Wanted wanted) {
  const int first = CellMemory::n * point;
  const double factor = memory_.factor[first];
  const double* const r = memory_.remembered + first;
  Matrix3 s;
  s << r[0], r[5], r[4], r[5], r[1], r[3], r[4], r[3], r[2];
  const bool is_finite = kinematics == Kinematics::finite;
  stress_.stress = factor * stress_.stress + flatten(is_finite ? Matrix3(f * s) : s);
  if (wanted == Wanted::stress) return;
  stress_.tangent *= factor;
  for (int i = 0; i < 3 && is_finite; ++i) stress_.tangent.block<3, 3>(3 * i, 3 * i) += s;
}

const CellResult& CellKernel::evaluate(const CellGeometry& g, const double* displacement,
                                       const double* internal, Wanted wanted, const CellMemory& memory) {
  memory_ = memory;
  force_.setZero();
  result_.valid = add_points(g, with_bubbles(g, displacement, internal), internal, wanted);
  if (!result_.valid) return result_;
  result_.volume_mismatch = result_.bubble_imbalance = 0;
  if (wanted == Wanted::stress_and_tangent) add_stiffness(g);
  if (element_.n_bubbles > 0) {
    condense_bubbles(g, wanted);
    return result_;
  }
  if (element_.pressure == Pressure::nodes) {
    append_pressures(g, wanted);
    return result_;
  }
  result_.plain_force = force_;
  result_.force.swap(force_);
  if (wanted == Wanted::stress_and_tangent) result_.tangent.swap(stiffness_);
  if (element_.pressure == Pressure::modes) condense(g, wanted);
  return result_;
}

} // namespace springproof::fem_reference
