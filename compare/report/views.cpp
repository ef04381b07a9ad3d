#include "compare/report/views.hpp"

#include "compare/thesis/draw_figures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

constexpr double unit_mm = 1e-4;

void append(std::vector<long>& flat, const Eigen::Vector3d& point) {
  for (const double coordinate : point) flat.push_back(std::lround(coordinate / unit_mm));
}

/// The part of a mesh that can be seen.
struct Surface {
  std::vector<std::size_t> nodes; ///< of the mesh, in the surface's order
  std::vector<long> rest, faces;
  bool operator==(const Surface& other) const { return rest == other.rest && faces == other.faces; }
};

Surface surface_of(const cases::HexMesh& mesh) {
  Surface surface;
  std::vector<long> number(mesh.nodes.size(), -1);
  for (const std::array<int, 4>& face : cases::boundary_faces(mesh))
    for (const int vertex : face) {
      const auto node = static_cast<std::size_t>(vertex);
      if (number[node] < 0) {
        number[node] = static_cast<long>(surface.nodes.size());
        surface.nodes.push_back(node);
        append(surface.rest, mesh.nodes[node]);
      }
      surface.faces.push_back(number[node]);
    }
  return surface;
}

Json side_to_json(const DeformedBody& body, std::vector<Surface>& bodies) {
  Surface surface = surface_of(*body.mesh);
  std::vector<long> displacement;
  for (const std::size_t node : surface.nodes) append(displacement, (*body.displacement)[node]);
  const auto known = std::find(bodies.begin(), bodies.end(), surface);
  const auto index = known - bodies.begin();
  if (known == bodies.end()) bodies.push_back(std::move(surface));
  return {{"body", index}, {"displacement", displacement}};
}

/// How far the slider reaches: small displacements may be drawn tenfold, large ones twofold.
double largest_scale(const Overlay& overlay) {
  double largest = 0;
  for (const DeformedBody* body : {&overlay.fem, &overlay.springs})
    for (const Eigen::Vector3d& u : *body->displacement) largest = std::max(largest, u.norm());
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : overlay.fem.mesh->nodes) box.extend(x);
  return largest > 0 ? std::clamp(std::round(0.5 * box.sizes().maxCoeff() / largest), 2.0, 10.0) : 2.0;
}

} // namespace

std::vector<BodyView> body_views(const ThesisResults& results) {
  std::vector<BodyView> views;
  for (const Comparison& comparison : results.cases)
    views.push_back({comparison.scene.definition.name, thesis_overlay(results, comparison, "")});
  return views;
}

Json views_to_json(const std::vector<BodyView>& views) {
  std::vector<Surface> surfaces;
  Json list = Json::array(), bodies = Json::array();
  for (const BodyView& view : views) {
    Json entry{{"id", view.id}, {"largest_scale", largest_scale(view.overlay)}};
    if (view.overlay.fem.is_there()) entry["fem"] = side_to_json(view.overlay.fem, surfaces);
    if (view.overlay.springs.is_there()) entry["springs"] = side_to_json(view.overlay.springs, surfaces);
    list.push_back(std::move(entry));
  }
  for (const Surface& surface : surfaces)
    bodies.push_back({{"rest", surface.rest}, {"faces", surface.faces}});
  return {{"unit_mm", unit_mm}, {"bodies", bodies}, {"views", list}};
}

} // namespace springproof::compare
