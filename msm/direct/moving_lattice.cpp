#include "msm/direct/moving_lattice.hpp"

#include "msm/direct/direct_system.hpp"
#include "msm/direct/factorisation.hpp"

#include <cmath>

namespace springproof::msm {

namespace {

using Matrix = Tangent::Matrix;

/// One value per point as a vector of the direct system, 0 on constrained degrees of freedom.
Vector on_free(const Problem& problem, const std::vector<double>& of_point) {
  Points points;
  for (const double value : of_point) points.push_back(Eigen::Vector3d::Constant(value));
  Vector all = to_vector(problem, points);
  all.tail(all.size() - static_cast<Eigen::Index>(n_unknowns(problem))).setZero();
  return all;
}

MovingSprings::Entries entries_of(const Problem& problem, const Inertia& inertia) {
  const auto n_free = static_cast<Eigen::Index>(n_unknowns(problem));
  MovingSprings::Entries entries{on_free(problem, inertia.mass),
                                 on_free(problem, inertia.mass_damping),
                                 {},
                                 on_free(problem, std::vector<double>(inertia.mass.size(), 1))};
  for (const auto& [history, force] : inertia.loads) {
    Vector all = to_vector(problem, problem.on_all_points(force));
    all.tail(all.size() - n_free).setZero();
    entries.loads.emplace_back(history, all);
  }
  return entries;
}

/// The tangent of a lattice at rest, in the order of the direct system: rows of free degrees of freedom,
/// columns of all that its vectors have.
Matrix tangent_at_rest(const Problem& problem, const Lattice& lattice) {
  // The place in a vector of every degree of freedom, from 1; 0: none.
  const auto n_free = static_cast<Eigen::Index>(n_unknowns(problem));
  const Eigen::Index n = to_vector(problem, Points(lattice.rest.size(), Eigen::Vector3d::Zero())).size();
  const Points place = to_points(problem, Vector::LinSpaced(n, 1, static_cast<double>(n)));
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int row_point, int column_point, const Eigen::Matrix3d& block) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        const auto row = static_cast<int>(std::lround(place[cases::index(row_point)][r])) - 1,
                   column = static_cast<int>(std::lround(place[cases::index(column_point)][c])) - 1;
        if (row >= 0 && row < n_free && column >= 0) entries.emplace_back(row, column, block(r, c));
      }
  };
  visit_tangent_blocks(lattice, lattice.rest, TransverseTerm::exact,
                       [&](int row, int column, const Eigen::Matrix3d& block) {
                         add(row, column, block);
                         if (row != column) add(column, row, block.transpose());
                       });
  Matrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Matrix diagonal_matrix(const Vector& diagonal) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index d = 0; d < diagonal.size(); ++d)
    entries.emplace_back(static_cast<int>(d), static_cast<int>(d), diagonal[d]);
  Matrix matrix(diagonal.size(), diagonal.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

class MovingLattice : public MovingSprings {
 public:
  MovingLattice(const Problem& problem, SpringSystem& springs, const Inertia& inertia)
      : MovingSprings(springs, entries_of(problem, inertia)), problem_(problem), springs_(springs),
        tangent_(problem.lattice, problem.is_constrained),
        damping_(tangent_at_rest(problem, inertia.damping)) {
    const auto n = tangent_.n_free();
    free_mass_ = diagonal_matrix(entries().mass.head(n));
    const Matrix block = damping_.topLeftCorner(n, n);
    free_damping_ = diagonal_matrix(entries().mass_damping.head(n));
    if (block.nonZeros() > 0) free_damping_ += Matrix(block.triangularView<Eigen::Lower>());
    const OneThread one;
    factorisation_.analyse(matrix_at(problem.lattice.rest, TransverseTerm::exact, 0, 0));
  }

  bool direction(const Vector& at, const Vector& residual, double /*load_factor*/, double /*forcing*/,
                 mechanics::Convexity convexity, Vector& step) override {
    if (tangent_.n_free() == 0) return false; // every point goes where its support goes
    const auto term =
        convexity == mechanics::Convexity::clamped ? TransverseTerm::clamped : TransverseTerm::exact;
    Points positions = to_points(problem_, at);
    for (std::size_t p = 0; p < positions.size(); ++p) positions[p] += problem_.lattice.rest[p];
    const OneThread one;
    ++work_.factorisations;
    if (!factorisation_.factorise(matrix_at(positions, term, terms().mass, terms().damping), 0)) return false;
    step.setZero(at.size());
    const auto invert = [&](const Vector& right_side, Vector& solution) {
      solution.head(tangent_.n_free()) = factorisation_.solve(right_side.head(tangent_.n_free()));
    };
    invert(residual, step);
    if (pull()) {
      with_pull_.prepare(*pull(), at.size(), invert);
      with_pull_.correct(*pull(), step);
    }
    return step.allFinite() && step.dot(residual) > 0;
  }

 private:
  const Problem& problem_;
  SpringSystem& springs_;
  Tangent tangent_;
  Matrix damping_;                  ///< by stiffness, of all entries of a vector
  Matrix free_mass_, free_damping_; ///< M and C on free degrees of freedom, lower triangles
  Factorisation factorisation_;
  WithPull<double> with_pull_;

  double reaction(const Vector& at) override { return springs_.reaction(at); }
  bool has_stiffness_damping() const override { return damping_.nonZeros() > 0; }
  void add_stiffness_damping(const Vector& motion, Vector& product) override {
    if (damping_.nonZeros() > 0) product += damping_ * motion;
  }

  /// Tangent + mass M + damping C, lower triangle, of one pattern whatever the factors are.
  Matrix matrix_at(const Points& positions, TransverseTerm term, double mass, double damping) {
    return Matrix(tangent_.assemble(positions, term) + mass * free_mass_ + damping * free_damping_);
  }
};

} // namespace

std::unique_ptr<MovingSprings> make_moving_lattice(const Problem& problem, SpringSystem& springs,
                                                   const Inertia& inertia) {
  return std::make_unique<MovingLattice>(problem, springs, inertia);
}

} // namespace springproof::msm
