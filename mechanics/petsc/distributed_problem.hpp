#pragma once

#include "mechanics/equilibrium/nonlinear_problem.hpp"

#include <mpi.h>
#include <utility>

namespace springproof::mechanics::petsc {

inline double total(double value, MPI_Op operation, MPI_Comm communicator) {
  double result = 0;
  MPI_Allreduce(&value, &result, 1, MPI_DOUBLE, operation, communicator);
  return result;
}

/// A problem whose vectors are dealt out to the ranks of a communicator. A residual's entries that belong to
/// another rank are 0.
/// @tparam Problem  NonlinearProblem, or one derived from it
template<class Problem = NonlinearProblem>
class DistributedProblem : public Problem {
 public:
  template<class... Arguments>
  explicit DistributedProblem(MPI_Comm communicator, Arguments&&... of_problem)
      : Problem(std::forward<Arguments>(of_problem)...), communicator_(communicator) {}

  double dot(const mechanics::Vector& left, const mechanics::Vector& right) const override {
    return total(left.dot(right), MPI_SUM, communicator_);
  }
  double largest(const mechanics::Vector& of) const override {
    return total(of.size() > 0 ? of.cwiseAbs().maxCoeff() : 0, MPI_MAX, communicator_);
  }
  bool any_rank(bool here) const override { return total(here ? 1 : 0, MPI_MAX, communicator_) > 0; }

 protected:
  MPI_Comm communicator_;
};

} // namespace springproof::mechanics::petsc
