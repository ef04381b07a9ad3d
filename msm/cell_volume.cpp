#include "msm/cell_volume.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace springproof::msm {

using Eigen::Vector3d;

namespace {

struct Term {
  int c;
  double value;
};

/// T_abc by 2x2x2 Gauss (the integrand is at most quadratic in each direction), as lists of c for each pair
/// (a, b).
class VolumeForm {
 public:
  VolumeForm() {
    const double gauss[2] = {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
    for (int q = 0; q < 8; ++q) {
      std::array<Vector3d, 8> gradient;
      for (int v = 0; v < 8; ++v)
        gradient[at(v)] = shape_gradient(v, {gauss[q & 1], gauss[(q >> 1) & 1], gauss[q >> 2]});
      for (int a = 0; a < 8; ++a)
        for (int b = 0; b < 8; ++b)
          for (int c = 0; c < 8; ++c)
            tensor_[at(a)][at(b)][at(c)] += gradient[at(a)].dot(gradient[at(b)].cross(gradient[at(c)])) / 8;
    }
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b)
        for (int c = 0; c < 8; ++c)
          if (std::abs(tensor_[at(a)][at(b)][at(c)]) >
              1e-12) // the others are 0 but for rounding; the least is 1/72
            terms_[at(a)][at(b)].push_back({c, tensor_[at(a)][at(b)][at(c)]});
  }
  /// sum_c T_abc x_c
  Vector3d contract(int a, int b, const CellPositions& x) const {
    Vector3d sum = Vector3d::Zero();
    for (const Term& term : terms_[at(a)][at(b)]) sum += term.value * x[at(term.c)];
    return sum;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  static Vector3d shape_gradient(int v, const Vector3d& point) {
    Vector3d gradient = Vector3d::Ones();
    for (int d = 0; d < 3; ++d)
      for (int a = 0; a < 3; ++a) {
        const bool upper = (v >> a) & 1;
        gradient[d] *= a == d ? (upper ? 1 : -1) : (upper ? point[a] : 1 - point[a]);
      }
    return gradient;
  }
  double tensor_[8][8][8] = {};
  std::array<std::array<std::vector<Term>, 8>, 8> terms_;
};

const VolumeForm& volume_form() {
  static const VolumeForm form;
  return form;
}

} // namespace

CellGradient trilinear_volume_gradient(const CellPositions& x) {
  CellGradient gradient;
  for (int a = 0; a < 8; ++a) {
    Vector3d twice = Vector3d::Zero();
    for (int b = 0; b < 8; ++b)
      twice += x[static_cast<std::size_t>(b)].cross(volume_form().contract(a, b, x));
    gradient[static_cast<std::size_t>(a)] = twice / 2;
  }
  return gradient;
}

double trilinear_volume(const CellPositions& x) {
  const CellGradient gradient = trilinear_volume_gradient(x);
  double triple = 0; // Euler: a cubic form is a third of its gradient times its argument
  for (std::size_t a = 0; a < 8; ++a) triple += x[a].dot(gradient[a]);
  return triple / 3;
}

Eigen::Matrix3d trilinear_volume_second_derivative(const CellPositions& x, int a, int b) {
  const Vector3d w = volume_form().contract(a, b, x);
  Eigen::Matrix3d block;
  block << 0, w.z(), -w.y(), -w.z(), 0, w.x(), w.y(), -w.x(), 0;
  return block;
}

} // namespace springproof::msm
