#pragma once

#include "mechanics/grid/field.hpp"

#include <Eigen/Cholesky>
#include <memory>
#include <vector>

namespace springproof::mechanics::grid {

/// What Chebyshev's iteration works on: eigenvalues of the preconditioned matrix up to a bound, and down to a
/// part of it.
struct Chebyshev {
  int degree;   ///< degree of the polynomial
  double share; ///< upper bound over the lower one
};

/// Chebyshev's iteration (Adams, Brezina, Hu, Tuminaro 2003) on a solution and its residual.
/// @param upper           bound of the eigenvalues
/// @param precondition    (keep, factor): correction = keep * correction + factor * (preconditioned residual)
/// @param correct         (keeps_residual): adds the correction to the solution and, where that is wanted,
///                        takes its product from the residual
/// @param keeps_residual  after the last step too
template<class Precondition, class Correct>
void smooth(const Chebyshev& chebyshev, double upper, const Precondition& precondition,
            const Correct& correct, bool keeps_residual) {
  const double lower = upper / chebyshev.share;
  const double centre = (upper + lower) / 2, half_width = (upper - lower) / 2;
  const double sigma = centre / half_width;
  double rho = 1 / sigma;
  precondition(0.0f, static_cast<float>(1 / centre));
  for (int step = 1;; ++step) {
    correct(keeps_residual || step < chebyshev.degree);
    if (step == chebyshev.degree) return;
    const double next = 1 / (2 * sigma - rho);
    precondition(static_cast<float>(next * rho), static_cast<float>(2 * next / half_width));
    rho = next;
  }
}

/// Inverts a node's 3x3 block on its free components; 0 on the others. Inverts only the diagonal if the free
/// block is not positive definite, or almost singular, as at a node that hangs on too few springs.
/// @param singular_below  least determinant over the product of the diagonal
Eigen::Matrix3d inverse_on_free(Eigen::Matrix3d block, const bool (&is_free)[3], double singular_below);

/// The symmetric matrix of a level that is small enough for a dense factorisation. Allocates nothing when it
/// is filled again with as many unknowns.
template<class Scalar>
class DenseFactor {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  enum class Indefinite {
    shift,   ///< the diagonal is raised until the matrix is positive definite
    reflect, ///< eigenvalues have their sizes in place of themselves
  };

  std::vector<std::ptrdiff_t> unknowns; ///< entries of a field of the level
  std::vector<int> number;              ///< each entry's index among the unknowns; -1: it is none

  /// Returns a zero matrix to fill in, with a row for each of n entries that is an unknown.
  template<class IsUnknown>
  Matrix& begin(std::ptrdiff_t n, const IsUnknown& is_unknown) {
    unknowns.clear();
    number.assign(static_cast<std::size_t>(n), -1);
    for (std::ptrdiff_t entry = 0; entry < n; ++entry) {
      if (!is_unknown(entry)) continue;
      number[static_cast<std::size_t>(entry)] = static_cast<int>(unknowns.size());
      unknowns.push_back(entry);
    }
    matrix_.setZero(static_cast<Eigen::Index>(unknowns.size()), static_cast<Eigen::Index>(unknowns.size()));
    return matrix_;
  }
  /// Factorises the symmetric part of what was filled in, or a positive definite matrix like it.
  void factorise(Indefinite indefinite);
  /// Sets the unknowns of the solution.
  void solve(const Field<float>& right_side, Field<float>& solution);

 private:
  Matrix matrix_;
  Eigen::LLT<Matrix> factor_;
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> answer_;
};

/// One of the grids of a multigrid cycle, from the given one to ever coarser ones: a model brings the
/// operator, the cycle has its fields. All in single precision.
class Level {
 public:
  /// @param size  entries of the level's fields
  Level(std::ptrdiff_t size, int n_threads);
  virtual ~Level() = default;
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;

  /// Prepares the operator at the model's present state; finer levels come first.
  virtual void linearise() = 0;
  /// product = operator * direction, whose ghosts may be brought up to date; 0 on entries that are not free.
  virtual void multiply(Field<float>& direction, Field<float>& product) const = 0;
  /// out = keep * out + factor * (block Jacobi's preconditioner) in
  virtual void precondition(const Field<float>& in, Field<float>& out, float keep, float factor) const;
  virtual double norm(const Field<float>& field) const = 0;
  /// A guess of the mode of the largest eigenvalue, the same on any number of ranks.
  virtual void set_rough(Field<float>& rough) const = 0;
  /// Whether the smoother alone solves here, though there are coarser levels.
  virtual bool needs_no_coarser(const Chebyshev&) const { return false; }

  /// Factorises the coarsest level.  @return false: it is too large, the smoother must do
  virtual bool factorise() = 0;
  virtual void solve_exactly() = 0;

  /// Makes the finest level's answer the same on every rank that has it.
  virtual void complete(Field<float>&) const {}
  /// residual = restriction of the finer level's
  virtual void restrict_from(Field<float>& finer_residual) = 0;
  /// finer_correction = interpolation of the solution, 0 on entries that are not free
  virtual void prolong_to(Field<float>& finer_correction) = 0;

  /// Drops the largest eigenvalue, and fields that may hold NaN.
  void forget();

 protected:
  friend class Cycle;
  Field<float> solution_, residual_, correction_, product_, rough_;
  Field<float> inverse_diagonal_; ///< symmetric 3x3 blocks: six arrays xx, yy, zz, yz, xz, xy
  double largest_eigenvalue_ = 0; ///< estimate for the inverse diagonal times the operator
  int n_threads_;
};

/// An approximate inverse: one V-cycle in single precision. The smoother is Chebyshev's iteration on the
/// block Jacobi method, the same before and after, so that the cycle is symmetric, if the operators are.
class Cycle {
 public:
  struct Settings {
    Chebyshev smoother;
    double margin;         ///< factor on the power method's estimate, which comes from below
    int first_power_steps; ///< the first estimate's; later ones take 2, from the last vector
  };
  Cycle(const Settings& settings, int n_threads) : settings_(settings), n_threads_(n_threads) {}

  /// Levels from the finest to the coarsest; filled in by the model.
  std::vector<std::unique_ptr<Level>> levels;

  void linearise();
  /// Prepares what is solved exactly, after a change of its operator.
  void factorise_again();
  /// Drops what a state far off may have left: misleading largest eigenvalues, and NaN.
  void forget();
  /// solution = cycle(right_side), on the finest level.
  /// @param norm  norm of the right side; dividing by it keeps single precision in range
  void apply(const Field<double>& right_side, double norm, Field<double>& solution);
  /// The same for a right side with a norm near 1, which keeps single precision in range.
  void apply(const Field<float>& right_side, Field<float>& solution);

 private:
  Settings settings_;
  int n_threads_;
  std::size_t last_ = 0; ///< coarsest level that the cycle uses
  bool ends_exactly_ = false;

  void estimate_largest_eigenvalue(Level& level) const;
  void correct(Level& level, bool keeps_residual) const;
  void smooth(Level& level, bool keeps_residual) const;
  void run(std::size_t l) const;
};

} // namespace springproof::mechanics::grid
