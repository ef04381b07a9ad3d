#include "compare/measure/tensor.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace springproof::compare {

namespace {

Eigen::Matrix3d matrix_of(const cases::SymmetricTensor& t) {
  const auto& [xx, yy, zz, xy, yz, xz] = t;
  Eigen::Matrix3d matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return matrix;
}

} // namespace

double tensor_norm(const cases::SymmetricTensor& tensor) {
  return matrix_of(tensor).norm();
}

double von_mises(const cases::SymmetricTensor& tensor) {
  const Eigen::Matrix3d matrix = matrix_of(tensor);
  return std::sqrt(1.5) * (matrix - matrix.trace() / 3 * Eigen::Matrix3d::Identity()).norm();
}

double component_of(const cases::SymmetricTensor& tensor, cases::TensorComponent component) {
  using cases::TensorComponent;
  if (component == TensorComponent::von_mises) return von_mises(tensor);
  if (component < TensorComponent::von_mises) return tensor[static_cast<std::size_t>(component)];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(matrix_of(tensor), Eigen::EigenvaluesOnly);
  const int from_largest = static_cast<int>(component) - static_cast<int>(TensorComponent::principal_1);
  return axes.eigenvalues()[2 - from_largest]; // Eigen's ascend
}

} // namespace springproof::compare
