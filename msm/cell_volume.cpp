#include "msm/cell_volume.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <Eigen/Geometry>

namespace springproof::msm {

using Eigen::Vector3d;

namespace {

/// Calls action(a, b, c, d) for every vertex a of every face; b, c, d follow it around the face.
template<class Action>
void for_each_corner(const Action& action) {
  for (const auto& face : cases::cell_faces) {
    const auto vertex = [&](std::size_t i) { return static_cast<std::size_t>(face[i % 4]); };
    for (std::size_t i = 0; i < 4; ++i) action(vertex(i), vertex(i + 1), vertex(i + 2), vertex(i + 3));
  }
}

} // namespace

std::array<Vector3d, 8> trilinear_volume_gradient(const CellPositions& x) {
  std::array<Vector3d, 8> gradient;
  gradient.fill(Vector3d::Zero());
  for_each_corner([&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    gradient[a] += (x[b].cross(x[c] + x[d]) + x[c].cross(x[d])) / 12;
  });
  return gradient;
}

double trilinear_volume(const CellPositions& x) {
  const std::array<Vector3d, 8> gradient = trilinear_volume_gradient(x);
  double triple = 0; // Euler: a cubic form is a third of its gradient times its argument
  for (std::size_t a = 0; a < 8; ++a) triple += x[a].dot(gradient[a]);
  return triple / 3;
}

std::array<std::array<Eigen::Matrix3d, 8>, 8> trilinear_volume_second_derivative(const CellPositions& x) {
  std::array<std::array<Eigen::Matrix3d, 8>, 8> blocks;
  for (auto& row : blocks) row.fill(Eigen::Matrix3d::Zero());
  const auto add = [](Eigen::Matrix3d& block, const Vector3d& w) { // T_abc x_c
    Eigen::Matrix3d cross;
    cross << 0, w.z(), -w.y(), -w.z(), 0, w.x(), w.y(), -w.x(), 0;
    block += cross;
  };
  for_each_corner([&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    for (const auto& [second, third, sign] :
         {std::tuple(b, c, 1), {b, d, 1}, {c, d, 1}, {c, b, -1}, {d, b, -1}, {d, c, -1}})
      add(blocks[a][second], sign / 12. * x[third]);
  });
  return blocks;
}

} // namespace springproof::msm
