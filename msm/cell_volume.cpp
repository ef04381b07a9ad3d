#include "msm/cell_volume.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <Eigen/Geometry>
#include <vector>

namespace springproof::msm {

using Eigen::Vector3d;

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Calls action(a, b, c, d) for every vertex a of every face; b, c, d follow it around the face.
template<class Action>
void for_each_corner(const Action& action) {
  for (const auto& face : cases::cell_faces)
    for (std::size_t i = 0; i < 4; ++i)
      action(face[i], face[(i + 1) % 4], face[(i + 2) % 4], face[(i + 3) % 4]);
}

struct Term {
  int c;
  double value; ///< of T_abc
};
using Terms = std::array<std::array<std::vector<Term>, 8>, 8>; ///< for each pair (a, b)

const Terms& terms() {
  static const Terms all = [] {
    Terms t;
    for_each_corner([&](int a, int b, int c, int d) {
      t[at(a)][at(b)].insert(t[at(a)][at(b)].end(), {{c, 1. / 12}, {d, 1. / 12}});
      t[at(a)][at(c)].insert(t[at(a)][at(c)].end(), {{d, 1. / 12}, {b, -1. / 12}});
      t[at(a)][at(d)].insert(t[at(a)][at(d)].end(), {{b, -1. / 12}, {c, -1. / 12}});
    });
    return t;
  }();
  return all;
}

} // namespace

CellGradient trilinear_volume_gradient(const CellPositions& x) {
  CellGradient gradient;
  gradient.fill(Vector3d::Zero());
  for_each_corner([&](int a, int b, int c, int d) {
    gradient[at(a)] += (x[at(b)].cross(x[at(c)] + x[at(d)]) + x[at(c)].cross(x[at(d)])) / 12;
  });
  return gradient;
}

double trilinear_volume(const CellPositions& x) {
  const CellGradient gradient = trilinear_volume_gradient(x);
  double triple = 0; // Euler: a cubic form is a third of its gradient times its argument
  for (std::size_t a = 0; a < 8; ++a) triple += x[a].dot(gradient[a]);
  return triple / 3;
}

Eigen::Matrix3d trilinear_volume_second_derivative(const CellPositions& x, int a, int b) {
  Vector3d w = Vector3d::Zero(); // sum_c T_abc x_c
  for (const Term& term : terms()[at(a)][at(b)]) w += term.value * x[at(term.c)];
  Eigen::Matrix3d block;
  block << 0, w.z(), -w.y(), -w.z(), 0, w.x(), w.y(), -w.x(), 0;
  return block;
}

} // namespace springproof::msm
