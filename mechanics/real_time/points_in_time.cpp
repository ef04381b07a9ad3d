#include "mechanics/real_time/points_in_time.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "mechanics/dynamics/loads_in_time.hpp"
#include "mechanics/equilibrium/newton.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace springproof::mechanics {

Points to_points(const Vector& vector) {
  Points points(cases::index(vector.size() / 3));
  for (std::size_t p = 0; p < points.size(); ++p)
    points[p] = vector.segment<3>(3 * static_cast<Eigen::Index>(p));
  return points;
}

Vector to_vector(const Points& points) {
  Vector vector(3 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t p = 0; p < points.size(); ++p)
    vector.segment<3>(3 * static_cast<Eigen::Index>(p)) = points[p];
  return vector;
}

PointsInTime::PointsInTime(const cases::Scene& scene, PointBody body, MakeStep make_step)
    : scene_(scene), body_(std::move(body)), make_step_(std::move(make_step)), fresh_make_step_(make_step_) {
  const auto n = static_cast<Eigen::Index>(body_.tangent.number.size());
  free_.resize(n);
  mass_.resize(n);
  damping_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    free_[i] = body_.tangent.number[cases::index(i)] >= 0 ? 1 : 0;
    mass_[i] = free_[i] * body_.mass[cases::index(i / 3)];
    damping_[i] = free_[i] * body_.mass_damping[cases::index(i / 3)];
  }
  for (const LoadOnNodes& load : loads_in_time(scene, body_.mass))
    loads_.emplace_back(load.history, free_.cwiseProduct(to_vector(
                                          cases::on_all_nodes(load.force, scene.mesh.nodes.size()))));
}

void PointsInTime::external_force(double time, Vector& force) {
  force.setZero(free_.size());
  for (const LoadInTime& load : loads_) load.add(time, force);
}

void PointsInTime::supports_at(double time, Vector& displacement) const {
  for (const auto& [selection, motion] : scene_.moved)
    for (const int node : selection.nodes) {
      const Eigen::Vector3d by =
          cases::moved_by(motion, scene_.mesh.nodes[cases::index(node)], motion.history.at(time));
      for (int c = 0; c < 3; ++c)
        if (motion.components[cases::index(c)]) displacement[3 * node + c] = by[c];
    }
}

void PointsInTime::set_step(const StepTerms& terms) {
  diagonal_ = terms.mass * mass_ + terms.damping * damping_;
  step_ = {to_points(diagonal_), to_points(terms.origin), to_points(terms.force), pull_};
  scale_ = terms.scale;
  is_substep_ = terms.is_substep;
}

void PointsInTime::residual(const Vector& at, double /*load_factor*/, Expect /*expect*/, Vector& residual) {
  ++work_.force_evaluations;
  residual = to_vector(body_.forces(to_points(at))) + to_vector(step_.force) -
             diagonal_.cwiseProduct(at - to_vector(step_.origin));
  if (pull_) {
    const Eigen::Vector3d force = pull_->force(to_points(at));
    for (const auto& [point, weight] : pull_->weights)
      residual.segment<3>(3 * static_cast<Eigen::Index>(point)) += weight * force;
  }
  residual = residual.cwiseProduct(free_);
}

double PointsInTime::size_of_pull(const Vector& at) const {
  double squares = 0; // sum over the weights
  for (const auto& [point, weight] : pull_->weights) squares += weight * weight;
  return std::sqrt(squares) * pull_->force(to_points(at)).norm();
}

NonlinearProblem::Size PointsInTime::size(const Vector& residual, const Vector& at) {
  double scale = std::max(scale_, largest_pull_);
  if (pull_) scale = std::max(scale, size_of_pull(at));
  if (!scene_.moved.empty() || scale == 0) {
    const Vector forces = to_vector(body_.forces(to_points(at)));
    scale = std::max(scale, (forces - forces.cwiseProduct(free_)).norm());
  }
  return {relative(residual.norm(), scale)};
}

bool PointsInTime::direction(const Vector& at, const Vector& residual, double /*load_factor*/,
                             double /*forcing*/, Convexity /*convexity*/, Vector& step) {
  const std::vector<int>& number = body_.tangent.number;
  Eigen::SparseMatrix<double> matrix = body_.tangent.at(to_points(at));
  Vector right_side(matrix.rows());
  for (std::size_t dof = 0; dof < number.size(); ++dof)
    if (const int n = number[dof]; n >= 0) {
      right_side[n] = residual[static_cast<Eigen::Index>(dof)];
      matrix.coeffRef(n, n) += diagonal_[static_cast<Eigen::Index>(dof)];
    }
  ++work_.factorisations;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  if (factor.info() != Eigen::Success) return false;
  const Vector solved = factor.solve(right_side);
  step.setZero(residual.size());
  for (std::size_t dof = 0; dof < number.size(); ++dof)
    if (const int n = number[dof]; n >= 0) step[static_cast<Eigen::Index>(dof)] = solved[n];
  return step.allFinite() && step.dot(residual) > 0;
}

std::optional<NonlinearProblem::Solved> PointsInTime::solve_at(Vector& at, double load_factor) {
  if (!has_method_) return std::nullopt;
  Points points = to_points(at);
  work_.linear_iterations += make_step_(step_, points);
  at = to_vector(points);
  const double left = is_substep_ ? 0 : size(NonlinearProblem::residual(at, load_factor), at).relative;
  if (!std::isfinite(left) || !at.allFinite()) throw cases::SolveError(no_finite_place);
  return Solved{true, 0, left};
}

int PointsInTime::n_inverted(const Vector& at) {
  return cases::n_inverted(scene_.mesh, to_points(at));
}

/// Sets the equations of a state without motion.  @param force  gets the loads, and must outlive them
void PointsInTime::rest_at(double time, const Vector& at, Vector& force) {
  external_force(time, force);
  set_step({0, 0, at, force, at, force.norm()});
}

double PointsInTime::out_of_balance(const Vector& at, double time) {
  Vector force;
  rest_at(time, at, force);
  return size(NonlinearProblem::residual(at, 0), at).relative;
}

Vector PointsInTime::balanced(Vector at, double time) {
  Vector force;
  rest_at(time, at, force);
  Equilibrium work;
  const EquilibriumSettings settings;
  Newton newton(*this, settings, work);
  solve_by_newton(true);
  const bool is_solved = newton.solve(at, 0, Convexity::exact);
  solve_by_newton(false);
  if (!is_solved) throw cases::SolveError(newton.failure());
  return at;
}

} // namespace springproof::mechanics
