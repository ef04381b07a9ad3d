#pragma once

#include "msm/grid/body.hpp"
#include "msm/grid/kernels.hpp"
#include "msm/grid/node_vectors.hpp"
#include "msm/tangent.hpp"

#include <functional>
#include <vector>

namespace springproof::msm::grid {

/// A symmetric operator of a small body (a tangent, with mass and damping), factorised in double precision
/// and kept in 16 bits: a preconditioner for the body as it moves on. It acts on the
/// vectors of the nodes.
class HeldFactor {
 public:
  using Operator = std::function<void(const Field<double>& direction, Field<double>& product)>;

  /// @param body     the whole of it; must outlive this
  /// @param vectors  must be the body's
  HeldFactor(const Body& body, const NodeVectors& vectors);

  /// Takes 81 products, a factorisation, and memory.
  /// @param apply  couples nodes of the same cells, and nothing with constrained entries
  /// @return whether it is positive definite
  bool factorise(const Operator& apply);

  /// solution = inverse of the operator * right_side; allocates nothing.
  void apply(const Field<double>& right_side, Field<double>& solution);

 private:
  const Body& body_;
  Eigen::Index size_;                         ///< entries of a vector
  std::vector<int> number_;                   ///< each field entry's unknown; -1: it is constrained
  std::vector<Eigen::Index> entries_;         ///< each unknown's entry in a vector
  std::vector<Eigen::Index> ordered_entries_; ///< the same as the factor orders them
  std::vector<FactorBlock> blocks_;
  std::vector<int> rows_;
  std::vector<std::int16_t> values_;
  std::vector<float> steps_, solution_, scratch_;

  Tangent::Matrix matrix_of(const Operator& apply) const;
  void append(const Eigen::MatrixXd& kept);
};

} // namespace springproof::msm::grid
