#include "mechanics/contact/surface_distance.hpp"

#include "cases/mesh/mesh.hpp"

#include <cmath>

namespace springproof::mechanics {

using cases::index;
using Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The part of a triangle that a place on it is in: its inside, an edge (from vertex `number` to the next) or
/// a vertex.
struct PlaceOnTriangle {
  enum class Part { face, edge, vertex } part = Part::face;
  std::size_t number = 0;
  Vector3d at = Vector3d::Zero();
};

namespace {

/// Source: C. Ericson, Real-Time Collision Detection (2005), section 5.1.5.
PlaceOnTriangle nearest_on(const std::array<Vector3d, 3>& corners, const Vector3d& point) {
  using Part = PlaceOnTriangle::Part;
  const auto& [a, b, c] = corners;
  const Vector3d ab = b - a, ac = c - a, from_a = point - a, from_b = point - b, from_c = point - c;
  const double a_b = ab.dot(from_a), a_c = ac.dot(from_a), b_b = ab.dot(from_b), b_c = ac.dot(from_b),
               c_b = ab.dot(from_c), c_c = ac.dot(from_c);
  if (a_b <= 0 && a_c <= 0) return {Part::vertex, 0, a};
  if (b_b >= 0 && b_c <= b_b) return {Part::vertex, 1, b};
  if (c_c >= 0 && c_b <= c_c) return {Part::vertex, 2, c};
  const double of_c = a_b * b_c - b_b * a_c, of_b = c_b * a_c - a_b * c_c, of_a = b_b * c_c - c_b * b_c;
  if (of_c <= 0 && a_b >= 0 && b_b <= 0) return {Part::edge, 0, a + a_b / (a_b - b_b) * ab};
  if (of_b <= 0 && a_c >= 0 && c_c <= 0) return {Part::edge, 2, a + a_c / (a_c - c_c) * ac};
  const double along_b = b_c - b_b, along_c = c_b - c_c; // shares of the way from b to c
  if (of_a <= 0 && along_b >= 0 && along_c >= 0)
    return {Part::edge, 1, b + along_b / (along_b + along_c) * (c - b)};
  return {Part::face, 0, a + (of_b * ab + of_c * ac) / (of_a + of_b + of_c)};
}

} // namespace

/// Finds the nearest triangle of the tree.
struct SurfaceDistance::Nearest {
  using Scalar = double;
  const SurfaceDistance& surface;
  const Vector3d& point;
  double squared = INFINITY;
  int triangle = 0;
  PlaceOnTriangle place{};

  double minimumOnVolume(const AlignedBox3d& box) const { return box.squaredExteriorDistance(point); }
  double minimumOnObject(int candidate) {
    const auto& [a, b, c] = surface.triangles_[index(candidate)];
    const auto& v = surface.vertices_;
    const PlaceOnTriangle here = nearest_on({v[index(a)], v[index(b)], v[index(c)]}, point);
    const double away = (point - here.at).squaredNorm();
    if (away < squared) std::tie(squared, triangle, place) = std::tie(away, candidate, here);
    return away;
  }
};

SurfaceDistance::SurfaceDistance(const cases::tools::Surface& surface)
    : vertices_(surface.vertices), triangles_(surface.triangles), edge_normals_(triangles_.size()),
      vertex_normals_(vertices_.size(), Vector3d::Zero()), neighbours_(vertices_.size()),
      size_(cases::bounding_box(vertices_).diagonal().norm()) {
  std::map<std::array<int, 2>, Vector3d> beside; // normals, by edges in their triangles' direction
  std::vector<AlignedBox3d> boxes;
  std::vector<int> numbers;
  for (const auto& triangle : triangles_) {
    const auto at = [&](std::size_t v) -> const Vector3d& { return vertices_[index(triangle[v % 3])]; };
    const Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
    face_normals_.push_back(normal);
    numbers.push_back(static_cast<int>(numbers.size()));
    AlignedBox3d& box = boxes.emplace_back(at(0));
    for (std::size_t v = 0; v < 3; ++v) {
      box.extend(at(v));
      beside[{triangle[v], triangle[(v + 1) % 3]}] = normal;
      neighbours_[index(triangle[v])].push_back(triangle[(v + 1) % 3]);
      const Vector3d next = at(v + 1) - at(v), last = at(v + 2) - at(v);
      vertex_normals_[index(triangle[v])] += std::atan2(next.cross(last).norm(), next.dot(last)) * normal;
    }
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t v = 0; v < 3; ++v)
      edge_normals_[t][v] = face_normals_[t] + beside.at({triangles_[t][(v + 1) % 3], triangles_[t][v]});
  tree_.init(numbers.begin(), numbers.end(), boxes.begin(), boxes.end());
}

SignedDistance SurfaceDistance::at(const Vector3d& point) const {
  using Part = PlaceOnTriangle::Part;
  Nearest nearest{*this, point};
  Eigen::BVMinimize(tree_, nearest);
  const auto& [part, number, place] = nearest.place;
  const std::size_t t = index(nearest.triangle);
  const Vector3d& face = face_normals_[t];
  if (part == Part::face) return {face.dot(point - place), face};
  const int vertex = triangles_[t][number], next = triangles_[t][(number + 1) % 3];
  const Vector3d& pseudonormal =
      part == Part::edge ? edge_normals_[t][number] : vertex_normals_[index(vertex)];
  const Vector3d out = point - place;
  const double side = out.dot(pseudonormal) < 0 ? -1 : 1, distance = out.norm();
  constexpr double none = 1e-9; // relative to the surface: a direction that is rounding
  if (!(distance > none * size_)) return {side * distance, pseudonormal.normalized()};
  const Vector3d normal = side / distance * out;
  Matrix3d curved = Matrix3d::Identity() - normal * normal.transpose();
  // Along an edge, and in a face, the distance does not bend. A point over an edge between faces in one plane
  // is over them.
  const auto leave_out = [&](const Vector3d& along) {
    constexpr double level = 1e-6; // what rounding may leave of a right angle
    const Vector3d left = curved * along;
    if (std::abs(along.dot(normal)) < level * along.norm() && left.norm() > level * along.norm())
      curved -= left * left.transpose() / left.squaredNorm();
  };
  if (part == Part::edge) {
    const Vector3d along = (vertices_[index(next)] - vertices_[index(vertex)]).normalized();
    leave_out(along);
    leave_out(along.cross(face));
    leave_out(along.cross(pseudonormal - face)); // the other triangle's
  } else {
    for (const int other : neighbours_[index(vertex)])
      leave_out(vertices_[index(other)] - vertices_[index(vertex)]);
  }
  return {side * distance, normal, side / distance * curved};
}

} // namespace springproof::mechanics
