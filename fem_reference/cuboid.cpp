#include "fem_reference/cuboid.hpp"

#include <array>
#include <cassert>
#include <cmath>

namespace springproof::fem_reference {

IntervalShapes interval_shapes(int degree, double x) {
  if (degree == 1) return {{1 - x, x, 0}, {-1, 1, 0}};
  return {{(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)}, {4 * x - 3, 4 - 8 * x, 4 * x - 1}};
}

namespace {

struct GaussPoint {
  double at, weight;
};
std::vector<GaussPoint> gauss_points(int degree) {
  if (degree == 1) {
    const double offset = 0.5 / std::sqrt(3.);
    return {{0.5 - offset, 0.5}, {0.5 + offset, 0.5}};
  }
  const double offset = std::sqrt(0.15);
  return {{0.5 - offset, 5. / 18}, {0.5, 4. / 9}, {0.5 + offset, 5. / 18}};
}

} // namespace

Cuboid::Cuboid(int degree, int n_pressure_modes, const Eigen::Vector3d& edges, int n_bubbles)
    : n_bubbles_(n_bubbles) {
  assert(n_pressure_modes <= 1);
  const int n = degree + 1, n_nodes = n * n * n;
  const std::vector<GaussPoint> points = gauss_points(degree);
  const auto places = [n](int a) { return std::array<int, 3>{a % n, a / n % n, a / (n * n)}; };
  for (int a = 0; a < n_nodes; ++a) {
    const auto [i, j, k] = places(a);
    nodes_.push_back(Eigen::Vector3d(i, j, k) / degree);
  }
  for (int q = 0; q < n_nodes; ++q) { // as many points as nodes
    IntervalShapes along[3];
    double weight = 1;
    for (std::size_t d = 0; d < 3; ++d) {
      const GaussPoint& point = points[static_cast<std::size_t>(places(q)[d])];
      along[d] = interval_shapes(degree, point.at);
      weight *= point.weight;
    }
    weights_.push_back(weight * edges.prod());
    const auto product = [&](int a, double factor, std::size_t slope_along) {
      const std::array<int, 3> node = places(a);
      for (std::size_t d = 0; d < 3; ++d)
        factor *= d == slope_along ? along[d].slope[node[d]] : along[d].value[node[d]];
      return factor;
    };
    for (int a = 0; a < n_nodes; ++a) values_.push_back(product(a, 1, 3));
    for (std::size_t j = 0; j < 3; ++j) {
      const double edge = edges[static_cast<Eigen::Index>(j)];
      for (int a = 0; a < n_nodes; ++a) gradients_.push_back(product(a, 1 / edge, j));
      for (std::size_t b = 0; b < static_cast<std::size_t>(n_bubbles); ++b) // slope of 4 x (1 - x)
        gradients_.push_back(b == j ? (4 - 8 * points[static_cast<std::size_t>(places(q)[j])].at) / edge : 0);
    }
    if (n_pressure_modes == 1) modes_.push_back(1);
  }
}

CellGeometry Cuboid::geometry() const {
  const int n = static_cast<int>(nodes_.size());
  return {n, n + n_bubbles_, n, gradients_.data(), weights_.data(), modes_.data()};
}

} // namespace springproof::fem_reference
