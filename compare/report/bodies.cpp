#include "compare/report/bodies.hpp"

#include "compare/report/lengths.hpp"
#include "compare/table/json.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

/// The part of a mesh that can be seen.
struct Surface {
  std::vector<std::size_t> nodes; ///< of the mesh, in the surface's order
  std::vector<long> faces;
  Lengths rest;
  bool operator==(const Surface& other) const { return rest == other.rest && faces == other.faces; }
};

Surface surface_of(const cases::HexMesh& mesh) {
  Surface surface;
  std::vector<Eigen::Vector3d> points;
  std::vector<long> number(mesh.nodes.size(), -1);
  for (const std::array<int, 4>& face : cases::boundary_faces(mesh))
    for (const int vertex : face) {
      const auto node = static_cast<std::size_t>(vertex);
      if (number[node] < 0) {
        number[node] = static_cast<long>(surface.nodes.size());
        surface.nodes.push_back(node);
        points.push_back(mesh.nodes[node]);
      }
      surface.faces.push_back(number[node]);
    }
  surface.rest = lengths(points);
  return surface;
}

Json body_side_to_json(const DeformedBody& body, std::vector<Surface>& bodies) {
  Surface surface = surface_of(*body.mesh);
  std::vector<Eigen::Vector3d> moves;
  for (const std::size_t node : surface.nodes) moves.push_back((*body.displacement)[node]);
  const Lengths displacement = lengths(moves);
  const auto known = std::find(bodies.begin(), bodies.end(), surface);
  const auto index = known - bodies.begin();
  if (known == bodies.end()) bodies.push_back(std::move(surface));
  return {{"body", index}, {"unit_mm", displacement.unit_mm}, {"displacement", displacement.values}};
}

/// How far the slider reaches: to where the largest displacement is half the body, but twofold at least and a
/// hundredfold at most.
double largest_scale(const Overlay& overlay) {
  double largest = 0;
  for (const DeformedBody* body : {&overlay.fem, &overlay.springs})
    for (const Eigen::Vector3d& u : *body->displacement) largest = std::max(largest, u.norm());
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : overlay.fem.mesh->nodes) box.extend(x);
  return largest > 0 ? std::clamp(std::round(0.5 * box.sizes().maxCoeff() / largest), 2.0, 100.0) : 2.0;
}

Json measures_to_json(const std::vector<MeasuredValue>& measures) {
  Json list = Json::array();
  for (const MeasuredValue& m : measures)
    list.push_back({{"name", m.name},
                    {"unit", m.unit},
                    {"fem", m.fem},
                    {"msm", m.msm},
                    {"error_percent", m.error_percent}});
  return list;
}

} // namespace

BodyView view_of(const Comparison& comparison, const std::string& id, Overlay overlay) {
  BodyView view{id, std::move(overlay), "", comparison.scene.definition.description, "", comparison.measures};
  for (const Answer* side : {&comparison.answers.fem, &comparison.answers.msm})
    if (side->solution.status == cases::Status::failed) view.failures.push_back(side->solution.message);
  return view;
}

Json views_to_json(const std::vector<BodyView>& views) {
  std::vector<Surface> surfaces;
  Json list = Json::array(), bodies = Json::array();
  for (const BodyView& view : views) {
    Json entry{{"id", view.id},
               {"largest_scale", largest_scale(view.overlay)},
               {"title", view.overlay.title},
               {"group", view.group},
               {"description", view.description},
               {"command", view.command},
               {"measures", measures_to_json(view.measures)},
               {"failures", view.failures}};
    if (view.overlay.fem.is_there()) entry["fem"] = body_side_to_json(view.overlay.fem, surfaces);
    if (view.overlay.springs.is_there()) entry["springs"] = body_side_to_json(view.overlay.springs, surfaces);
    list.push_back(std::move(entry));
  }
  for (const Surface& surface : surfaces)
    bodies.push_back(
        {{"unit_mm", surface.rest.unit_mm}, {"rest", surface.rest.values}, {"faces", surface.faces}});
  return {{"bodies", bodies}, {"views", list}};
}

} // namespace springproof::compare
