#include "fem_reference/cuboid.hpp"

#include <cassert>
#include <cmath>

namespace springproof::fem_reference {

namespace {

/// Shape functions on the unit interval and their slopes, at one point.
struct Interval {
  double value[3], slope[3];
};

Interval linear_at(double x) {
  return {{1 - x, x, 0}, {-1, 1, 0}};
}

Interval quadratic_at(double x) {
  return {{(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)}, {4 * x - 3, 4 - 8 * x, 4 * x - 1}};
}

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

Cuboid::Cuboid(const ElementType& element, const Eigen::Vector3d& edges) {
  assert(element.n_pressure_modes <= 1);
  const int n = element.degree + 1, n_nodes = n * n * n;
  const std::vector<GaussPoint> points = gauss_points(element.degree);
  for (int a = 0; a < n_nodes; ++a)
    nodes_.push_back(Eigen::Vector3d(a % n, a / n % n, a / (n * n)) / element.degree);
  for (int q = 0; q < n_nodes; ++q) { // as many points as nodes
    Interval along[3];
    double weight = edges.prod();
    const int of_axis[3] = {q % n, q / n % n, q / (n * n)};
    for (int d = 0; d < 3; ++d) {
      const GaussPoint& point = points[static_cast<std::size_t>(of_axis[d])];
      along[d] = element.degree == 1 ? linear_at(point.at) : quadratic_at(point.at);
      weight *= point.weight;
    }
    weights_.push_back(weight);
    for (int j = 0; j < 3; ++j)
      for (int a = 0; a < n_nodes; ++a) {
        const int node[3] = {a % n, a / n % n, a / (n * n)};
        double gradient = 1 / edges[j];
        for (int d = 0; d < 3; ++d) gradient *= d == j ? along[d].slope[node[d]] : along[d].value[node[d]];
        gradients_.push_back(gradient);
      }
    if (element.n_pressure_modes == 1) modes_.push_back(1);
  }
}

CellGeometry Cuboid::geometry() const {
  const int n = static_cast<int>(nodes_.size());
  return {n, n, gradients_.data(), weights_.data(), modes_.data()};
}

} // namespace springproof::fem_reference
