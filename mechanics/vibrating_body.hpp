#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace springproof::mechanics {

/// What a model's small vibrations about rest depend on: matrices of its free degrees of freedom, both
/// triangles.
struct VibratingBody {
  Eigen::SparseMatrix<double> stiffness; ///< N/mm; with pressures among its rows it is indefinite
  Eigen::SparseMatrix<double> mass;      ///< t, positive definite but for rows of pressures, which are zero
  /// Degree of freedom 3*node + component of the body's mesh that each row is; -1 where it is none of its
  /// nodes.
  std::vector<Eigen::Index> mesh_dof;
};

} // namespace springproof::mechanics
