#include "compare/peers/calculix_tool.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/tools.hpp"
#include "mechanics/contact/signed_distance.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <map>

namespace springproof::compare {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double facet_depth = 1e-3; ///< how far a facet is below the surface, relative to the indentation
constexpr int most_facets = 1000;    ///< around an arc
constexpr int rim_segments = 32;     ///< in a quarter of a punch's rim, which they cut by 3e-4 of its radius

/// Puts facets together whose vertices are at the same places.
class Facets {
 public:
  /// @param size  mm, of the tool    @param near  what a facet must reach into, seen from the tool's place
  Facets(double size, const AlignedBox3d& near) : same_(1e-7 * size), near_(near) {}

  /// Adds a facet.  @param outer  around it, either way   @param inner  below these
  void add(std::array<Vector3d, 4> outer, std::array<Vector3d, 4> inner) {
    AlignedBox3d box;
    for (const Vector3d& vertex : outer) box.extend(vertex);
    if (!box.intersects(near_)) return;
    const Vector3d up = (outer[1] - outer[0]).cross(outer[3] - outer[0]);
    if (up.dot(inner[0] - outer[0]) <
        0) { // seen from the inner face, a hexahedron's first goes anticlockwise
      std::swap(outer[1], outer[3]);
      std::swap(inner[1], inner[3]);
    }
    std::array<int, 8>& cell = mesh_.cells.emplace_back();
    for (std::size_t v = 0; v < 4; ++v) {
      cell[v] = node_at(outer[v]);
      cell[4 + v] = node_at(inner[v]);
    }
  }

  /// Adds a patch of n_u x n_v facets.  @param at  place on it, for u and v from 0 to 1, and below it
  using Patch = std::function<Vector3d(double u, double v, bool is_below)>;
  void add_patch(int n_u, int n_v, const Patch& at) {
    for (int j = 0; j < n_v; ++j)
      for (int i = 0; i < n_u; ++i) {
        const auto corners = [&](bool is_below) {
          const double u = double(i) / n_u, v = double(j) / n_v, next_u = double(i + 1) / n_u,
                       next_v = double(j + 1) / n_v;
          return std::array<Vector3d, 4>{at(u, v, is_below), at(next_u, v, is_below),
                                         at(next_u, next_v, is_below), at(u, next_v, is_below)};
        };
        add(corners(false), corners(true));
      }
  }

  ToolMesh mesh() && { return std::move(mesh_); }

 private:
  double same_; ///< mm
  AlignedBox3d near_;
  ToolMesh mesh_;
  std::map<std::array<long long, 3>, int> nodes_; ///< by their places in units of same_

  int node_at(const Vector3d& place) {
    std::array<long long, 3> key{};
    for (std::size_t a = 0; a < 3; ++a) key[a] = std::llround(place[static_cast<int>(a)] / same_);
    const auto [node, is_new] = nodes_.try_emplace(key, static_cast<int>(mesh_.nodes.size()));
    if (is_new) mesh_.nodes.push_back(place);
    return node->second;
  }
};

/// What facets are made for.
struct Wanted {
  AlignedBox3d near; ///< mm, where they are wanted, seen from the tool's place
  double depth;      ///< mm, that a facet may be below the surface
  std::string name;  ///< the tool's, for messages

  /// How many facets an arc (mm) of a surface of this radius has. In its middle a square facet is h²/(4 R)
  /// below it.  @throws SolveError for too many
  int facets_of(double arc, double radius) const {
    const double n = std::ceil(arc / std::sqrt(4 * radius * depth));
    if (!(n <= most_facets))
      throw cases::SolveError(fmt::format(
          "the tool '{}' is pressed in so little, {:g} mm, that an arc of it would need more than {} facets",
          name, depth / facet_depth, most_facets));
    return static_cast<int>(n);
  }
};

/// Six sides of a cube, by equal angles.
ToolMesh facets_of(const cases::tools::Sphere& sphere, const Wanted& wanted) {
  Facets facets(sphere.radius, wanted.near);
  const int n = wanted.facets_of(pi / 2 * sphere.radius, sphere.radius);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1., 1.})
      facets.add_patch(n, n, [&](double u, double v, bool is_below) {
        Vector3d out;
        out[axis] = side;
        out[(axis + 1) % 3] = std::tan(pi / 4 * (2 * u - 1));
        out[(axis + 2) % 3] = std::tan(pi / 4 * (2 * v - 1));
        return Vector3d((is_below ? 0.9 : 1) * sphere.radius * out.normalized());
      });
  return std::move(facets).mesh();
}

ToolMesh facets_of(const cases::tools::Cylinder& cylinder, const Wanted& wanted) {
  constexpr double longest = 8; // length of a facet in its widths
  Facets facets(cylinder.radius, wanted.near);
  const Vector3d across = cylinder.axis.unitOrthogonal(), third = cylinder.axis.cross(across);
  const int n_around = std::max(8, wanted.facets_of(2 * pi * cylinder.radius, cylinder.radius));
  const double half = wanted.near.diagonal().norm() / 2, middle = cylinder.axis.dot(wanted.near.center());
  const double width = 2 * pi * cylinder.radius / n_around;
  const int n_along = static_cast<int>(std::ceil(2 * half / (longest * width)));
  facets.add_patch(n_around, n_along, [&](double u, double v, bool is_below) {
    const int turn = static_cast<int>(std::lround(u * n_around)) % n_around; // the last is the first
    const double angle = 2 * pi * turn / n_around;
    return Vector3d((is_below ? 0.9 : 1) * cylinder.radius *
                        (std::cos(angle) * across + std::sin(angle) * third) +
                    (middle + half * (2 * v - 1)) * cylinder.axis);
  });
  return std::move(facets).mesh();
}

/// The flat end: a square, and around it four patches that reach the rim.
ToolMesh facets_of(const cases::tools::Punch& punch, const Wanted& wanted) {
  Facets facets(punch.radius, wanted.near);
  const double half = punch.radius / 2; // the square's half side
  const auto line = [](double u) { return std::tan(pi / 4 * (2 * u - 1)); };
  const Vector3d first = punch.axis.unitOrthogonal(), second = punch.axis.cross(first);
  const auto below = [&](bool is_below) -> Vector3d {
    return is_below ? Vector3d(-0.1 * punch.radius * punch.axis) : Vector3d::Zero();
  };
  facets.add_patch(rim_segments, rim_segments, [&](double u, double v, bool is_below) {
    return Vector3d(half * (line(u) * first + line(v) * second) + below(is_below));
  });
  for (const double side : {-1., 1.})
    for (const auto& [out, along] : {std::pair(first, second), std::pair(second, first)})
      facets.add_patch(
          rim_segments, rim_segments / 4, [&, out = out, along = along](double u, double v, bool is_below) {
            const Vector3d from = side * out + line(u) * along; // a point of the square of side 2
            return Vector3d(((1 - v) * half * from + v * punch.radius * from.normalized()) + below(is_below));
          });
  return std::move(facets).mesh();
}

/// One facet, wider than all that is wanted.
ToolMesh facets_of(const cases::tools::Plane& plane, const Wanted& wanted) {
  const double half = wanted.near.diagonal().norm();
  const Vector3d first = plane.normal.unitOrthogonal(), second = plane.normal.cross(first);
  const Vector3d middle = wanted.near.center() - plane.normal.dot(wanted.near.center()) * plane.normal;
  Facets facets(half, wanted.near);
  facets.add_patch(1, 1, [&](double u, double v, bool is_below) {
    return Vector3d(middle +
                    half * ((2 * u - 1) * first + (2 * v - 1) * second - (is_below ? 1 : 0) * plane.normal));
  });
  return std::move(facets).mesh();
}

/// How deep the body at rest is in the tool at full load, mm; where that is none, the way of the tool, and of
/// one that stands still a hundredth of the body.
double indentation(const cases::Scene& scene, const cases::Tool& tool, double size_of_body) {
  double deepest = 0;
  const mechanics::DistanceAt distance = mechanics::distance_from(tool.shape);
  for (const cases::FaceNodes& face : cases::touched_faces(scene, tool))
    for (const int node : face)
      deepest = std::max(deepest, -distance(scene.mesh.nodes[cases::index(node)] - tool.place(1)).value);
  if (deepest > 1e-9 * size_of_body) return deepest; // a tool that only touches is in it by rounding
  return tool.moves() ? tool.displacement.norm() : 0.01 * size_of_body;
}

/// reason_without_calculix() has said so.
ToolMesh facets_of(const cases::tools::Surface&, const Wanted&) {
  throw std::logic_error("CalculiX has no cells for a surface of a file");
}

} // namespace

ToolMesh mesh_of_tool(const cases::Scene& scene, const cases::Tool& tool) {
  const AlignedBox3d body = cases::bounding_box(scene.mesh.nodes);
  const double size = body.diagonal().norm(), deep = indentation(scene, tool, size);
  // Loads may bring the body to the tool.
  const Vector3d grown = Vector3d::Constant(scene.loads.empty() ? tool.displacement.norm() + deep
                                                                : tool.displacement.norm() + size);
  const Wanted wanted{{body.min() - grown - tool.place(1), body.max() + grown - tool.place(1)},
                      facet_depth * deep,
                      tool.name};
  ToolMesh mesh = std::visit([&](const auto& shape) { return facets_of(shape, wanted); }, tool.shape);
  for (Vector3d& node : mesh.nodes) node += tool.place(0);
  return mesh;
}

} // namespace springproof::compare
