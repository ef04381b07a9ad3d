#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

/// Another program's results: points, and vectors at them.
namespace springproof::cases {

/// Values at every node or of every cell.
template<class Value>
struct NamedValues {
  std::string name;
  std::vector<Value> values;
  std::string unit{}; ///< VTK's UNITS_LABEL; empty: none
};
using PointField = NamedValues<Eigen::Vector3d>;

/// The points of a VTK file and their vectors in the file's order; a point that several pieces share occurs
/// several times.
struct PointCloud {
  std::vector<Eigen::Vector3d> points;
  bool is_single_precision = false; ///< the points, in the file; those of images are multiples of a spacing
  std::vector<PointField> fields;   ///< point data of three components in single or double precision
  std::vector<std::string> others;  ///< data that are no such fields: the name, and what they are
};

/// Values at positions from values at points: at position p the sum of weights[i] times the value at
/// points[i], first[p] <= i < first[p + 1].
struct Interpolation {
  std::vector<std::size_t> first; ///< one more than there are positions
  std::vector<int> points;
  std::vector<double> weights;
  std::vector<double> outside; ///< for every position, how far outside of all cells it lies, mm; it takes the
                               ///< value of the closest place
  std::vector<Eigen::Vector3d> of(const std::vector<Eigen::Vector3d>& values) const {
    std::vector<Eigen::Vector3d> result(outside.size(), Eigen::Vector3d::Zero());
    for (std::size_t p = 0; p < result.size(); ++p)
      for (std::size_t i = first[p]; i < first[p + 1]; ++i)
        result[p] += weights[i] * values[static_cast<std::size_t>(points[i])];
    return result;
  }
};

/// A point cloud whose cells interpolate between its points.
struct CellCloud {
  PointCloud cloud;
  Interpolation to_nodes;   ///< from the cloud's points to the nodes of a mesh
  Interpolation from_nodes; ///< from the nodes of the mesh to the cloud's points
};

} // namespace springproof::cases
