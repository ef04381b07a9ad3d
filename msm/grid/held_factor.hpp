#pragma once

#include "msm/grid/body.hpp"
#include "msm/grid/kernels.hpp"
#include "msm/tangent.hpp"

#include <functional>
#include <vector>

namespace springproof::msm::grid {

/// A symmetric operator of a small body (a tangent, with mass and damping), factorised in double precision
/// and kept in single precision: a preconditioner for what the body becomes when it moves.
class HeldFactor {
 public:
  using Operator = std::function<void(const Field<double>& direction, Field<double>& product)>;

  /// @param body  the whole of it; must outlive this
  explicit HeldFactor(const Body& body);

  /// Takes 81 products, a factorisation, and memory.
  /// @param apply  couples nodes of the same cells, and nothing with constrained entries
  /// @return whether it is positive definite
  bool factorise(const Operator& apply);

  /// solution = inverse of the operator * right_side; allocates nothing.
  void apply(const Field<double>& right_side, Field<double>& solution);

 private:
  const Body& body_;
  std::vector<int> number_;             ///< of an entry's unknown; -1: it is constrained
  std::vector<std::ptrdiff_t> entries_; ///< of unknowns, as the factor orders them
  std::vector<FactorBlock> blocks_;
  std::vector<int> rows_;
  std::vector<float> values_, solution_, scratch_;

  Tangent::Matrix matrix_of(const Operator& apply) const;
};

} // namespace springproof::msm::grid
