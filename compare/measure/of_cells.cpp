#include "cases/mesh/sharing.hpp"
#include "compare/measure/measure.hpp"
#include "mechanics/dense.hpp"
#include "mechanics/larger.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

Eigen::Matrix3d matrix_of(const cases::SymmetricTensor& t) {
  const auto& [xx, yy, zz, xy, yz, xz] = t;
  Eigen::Matrix3d matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return matrix;
}

/// Root of the mean of |u|² over the cells at rest, by quadrature.  @param field  as of field_norm()
double root_mean_square(const cases::Mesh& mesh, const std::vector<Vector3d>& field,
                        const cases::Sharing* sharing) {
  const cases::Share here = cases::share_here(mesh, sharing);
  const cases::ReferenceCell& reference = cases::reference_cell(mesh.shape);
  double integral = 0, volume = 0;
  for (std::size_t c = here.cells.begin; c < here.cells.end; ++c) {
    const cases::CellCorners corners = cases::cell_corners(mesh, c);
    const cases::CellNodes nodes = mesh.cells[c];
    for (const Vector3d& point : reference.points) {
      const double weight =
          cases::jacobian(corners, point).determinant() * reference.volume / double(reference.points.size());
      const cases::ShapeValues shape = cases::shape_values(mesh.shape, point);
      Vector3d value = Vector3d::Zero();
      for (std::size_t v = 0; v < nodes.size(); ++v)
        value += shape[v] * field[cases::index(nodes[v]) - here.nodes.begin];
      integral += weight * value.squaredNorm();
      volume += weight;
    }
  }
  if (sharing) {
    integral = sharing->sum(integral);
    volume = sharing->sum(volume);
  }
  return std::sqrt(integral / volume);
}

double curvature(const Vector3d& before, const Vector3d& here, const Vector3d& after) {
  const Vector3d a = here - before, b = after - here, c = after - before;
  return 2 * a.cross(b).norm() / (a.norm() * b.norm() * c.norm()); // A is half the cross product
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
  const int from_largest = static_cast<int>(component) - static_cast<int>(TensorComponent::principal_1);
  return mechanics::eigenvalues(matrix_of(tensor))[2 - from_largest]; // Eigen's ascend
}

double of_region(const cases::measures::OfCells& measure, const cases::Scene& scene,
                 const cases::Solution& solution, const std::vector<cases::SymmetricTensor>& of_cells) {
  std::set<cases::FaceNodes> faces; // the region's
  if (measure.has_region())
    for (const auto& face : cases::select(scene.mesh, measure.region).faces)
      faces.insert(cases::sorted(face));
  const cases::ReferenceCell& shape = cases::reference_cell(scene.mesh.shape);
  const auto is_counted = [&](std::size_t cell) {
    const cases::CellNodes vertices = scene.mesh.cells[cell];
    return !measure.has_region() ||
           std::any_of(shape.faces.begin(), shape.faces.end(), [&](const auto& face) {
             return faces.count(cases::sorted(cases::pick(vertices, face))) > 0;
           });
  };
  const cases::Sharing* const sharing = solution.sharing.get();
  const cases::Range here = cases::share_here(scene.mesh, sharing).cells;
  const auto all = [&](double of_this_rank) { return sharing ? sharing->sum(of_this_rank) : of_this_rank; };
  std::vector<double> values, weights;
  double largest = -std::numeric_limits<double>::infinity(), sum = 0, weight = 0;
  for (std::size_t c = here.begin; c < here.end; ++c) {
    if (!is_counted(c)) continue;
    values.push_back(component_of(of_cells[c - here.begin], measure.component));
    weights.push_back(cases::cell_volume(cases::cell_corners(scene.mesh, c)));
    largest = mechanics::larger(largest, values.back());
    sum += weights.back() * values.back();
    weight += weights.back();
  }
  if (measure.statistic == cases::Statistic::largest) return sharing ? sharing->largest(largest) : largest;
  weight = all(weight);
  const double mean = all(sum) / weight;
  if (measure.statistic == cases::Statistic::mean) return mean;
  double squared = 0;
  for (std::size_t i = 0; i < values.size(); ++i) squared += weights[i] * std::pow(values[i] - mean, 2);
  return std::sqrt(all(squared) / weight);
}

double largest_curvature(const cases::measures::Curvature& measure, const cases::Scene& scene,
                         const cases::Solution& solution) {
  const auto axis = static_cast<int>(measure.axis);
  const std::vector<int> nodes = cases::select(scene.mesh, measure.region).nodes;
  double size = 0;
  for (const int node : nodes)
    size = std::max(size, scene.mesh.nodes[cases::index(node)].cwiseAbs().maxCoeff());
  const double rounding = 1e-9 * size;                        // error of rest positions, far below a cell
  std::map<std::array<long long, 2>, std::vector<int>> lines; // keys: the other two coordinates at rest
  for (const int node : nodes) {
    const Vector3d rest = scene.mesh.nodes[cases::index(node)];
    const auto key = [&](int a) { return std::llround(rest[a] / (rounding > 0 ? 1e3 * rounding : 1)); };
    lines[{key((axis + 1) % 3), key((axis + 2) % 3)}].push_back(node);
  }
  double largest = 0;
  for (auto& [place, line] : lines) {
    const auto along = [&](int node) { return Vector3d(scene.mesh.nodes[cases::index(node)])[axis]; };
    std::sort(line.begin(), line.end(), [&](int a, int b) { return along(a) < along(b); });
    std::vector<Vector3d> deformed;
    for (const int node : line) {
      const std::size_t n = cases::index(node);
      deformed.push_back(scene.mesh.nodes[n] + (solution.sharing
                                                    ? solution.sharing->at(n, solution.displacement)
                                                    : solution.displacement[n]));
    }
    for (std::size_t i = 2; i < deformed.size(); ++i)
      largest = mechanics::larger(largest, curvature(deformed[i - 2], deformed[i - 1], deformed[i]));
  }
  return largest;
}

double field_norm(const cases::measures::Kind& kind, const cases::Mesh& mesh,
                  const std::vector<Vector3d>& field, const cases::Sharing* sharing) {
  if (std::holds_alternative<cases::measures::DisplacementFieldL2>(kind))
    return root_mean_square(mesh, field, sharing);
  double largest = 0; // stays 0 for an empty field
  if (!field.empty()) {
    const Eigen::Map<const Eigen::Matrix3Xd> vectors(field[0].data(), 3, Eigen::Index(field.size()));
    largest = vectors.colwise().norm().maxCoeff<Eigen::PropagateNaN>();
  }
  return sharing ? sharing->largest(largest) : largest;
}

} // namespace springproof::compare
