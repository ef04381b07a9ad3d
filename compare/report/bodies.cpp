#include "compare/report/pages.hpp"

#include "compare/measure/surfaces.hpp"
#include "compare/table/json.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace springproof::compare {

namespace {

/// Coordinates one after the other, in whole numbers of a unit.
struct Lengths {
  double unit_mm = 1;
  std::vector<long> values;
  bool operator==(const Lengths& other) const { return unit_mm == other.unit_mm && values == other.values; }
};

/// Points in the power of ten that leaves the largest coordinate five digits; 1 mm where all are 0.
Lengths lengths(const std::vector<Eigen::Vector3d>& points) {
  double largest = 0;
  for (const Eigen::Vector3d& x : points) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  Lengths result;
  if (largest > 0) result.unit_mm = std::pow(10.0, std::floor(std::log10(largest)) - 4);
  for (const Eigen::Vector3d& x : points)
    for (const double coordinate : x) result.values.push_back(std::lround(coordinate / result.unit_mm));
  return result;
}

/// The part of a mesh that can be seen: faces, or the lines of a network.
struct Surface {
  std::vector<std::size_t> nodes; ///< numbers in the mesh, in the surface's order
  std::vector<long> faces;
  std::size_t corners = 0; ///< a face; 2: lines
  Lengths rest;
  bool operator==(const Surface& other) const { return rest == other.rest && faces == other.faces; }
};

Surface surface_of(const cases::Mesh& mesh) {
  Surface surface;
  std::vector<Eigen::Vector3d> points;
  std::vector<long> number(mesh.nodes.size(), -1);
  const auto add = [&](const auto& face) {
    surface.corners = face.size();
    for (const int vertex : face) {
      const auto node = static_cast<std::size_t>(vertex);
      if (number[node] < 0) {
        number[node] = static_cast<long>(surface.nodes.size());
        surface.nodes.push_back(node);
        points.push_back(mesh.nodes[node]);
      }
      surface.faces.push_back(number[node]);
    }
  };
  for (const cases::FaceNodes& face : cases::boundary_faces(mesh)) add(face);
  for (const auto& line : mesh.lines) add(line);
  surface.rest = lengths(points);
  return surface;
}

Json moved_to_json(const std::vector<Eigen::Vector3d>& moves) {
  const Lengths displacement = lengths(moves);
  return {{"unit_mm", displacement.unit_mm}, {"displacement", displacement.values}};
}

Json body_side_to_json(const DeformedBody& body, std::vector<Surface>& bodies) {
  Surface surface = surface_of(*body.mesh);
  std::vector<Eigen::Vector3d> moves;
  for (const std::size_t node : surface.nodes) moves.push_back((*body.displacement)[node]);
  const auto known = std::find(bodies.begin(), bodies.end(), surface);
  Json side{{"body", known - bodies.begin()}};
  if (known == bodies.end()) bodies.push_back(std::move(surface));
  side.update(moved_to_json(moves));
  return side;
}

/// End of the slider: at which the largest displacement is half the body, but from twofold to a hundredfold.
double largest_scale(const Overlay& overlay) {
  double largest = 0;
  for (const DeformedBody* body : {&overlay.fem, &overlay.springs})
    for (const Eigen::Vector3d& u : *body->displacement) largest = std::max(largest, u.norm());
  const double size = cases::bounding_box(overlay.fem.mesh->nodes).sizes().maxCoeff();
  return largest > 0 ? std::clamp(std::round(0.5 * size / largest), 2.0, 100.0) : 2.0;
}

Json measure_to_json(const MeasuredValue& measure) {
  return SPRINGPROOF_MEMBERS(measure, name, unit, fem, msm, error_percent);
}

} // namespace

Json skin_to_json(const Comparison& comparison) {
  const cases::Scene& scene = comparison.scene;
  if (scene.surface.triangles.empty()) return nullptr;
  const mechanics::EmbeddedSurface surface = embedded_surface(scene);
  const Lengths rest = lengths(surface.rest.vertices);
  Json skin{{"unit_mm", rest.unit_mm}, {"rest", rest.values}, {"triangles", Json::array()}};
  for (const auto& triangle : surface.rest.triangles)
    for (const int vertex : triangle) skin["triangles"].push_back(vertex);
  const auto add = [&](const char* side, const Answer& answer) {
    if (!answer.converged()) return true;
    if (answer.solution.sharing) return false;
    std::vector<Eigen::Vector3d> moves;
    for (const mechanics::EmbeddedPoint& vertex : surface.vertices)
      moves.push_back(mechanics::displacement_at(vertex, answer.solution.displacement));
    skin[side] = moved_to_json(moves);
    return true;
  };
  if (!add("fem", comparison.answers.fem) || !add("springs", comparison.answers.msm)) return nullptr;
  skin["marks"] = json_list(scene.definition.landmarks, [](const cases::Landmark& mark) -> Json {
    return {{"name", mark.name}, {"point", {mark.point[0], mark.point[1], mark.point[2]}}};
  });
  return skin;
}

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
               {"measures", json_list(view.measures, measure_to_json)},
               {"failures", view.failures}};
    if (view.overlay.fem.is_there()) entry["fem"] = body_side_to_json(view.overlay.fem, surfaces);
    if (view.overlay.springs.is_there()) entry["springs"] = body_side_to_json(view.overlay.springs, surfaces);
    list.push_back(std::move(entry));
  }
  for (const Surface& surface : surfaces)
    bodies.push_back({{"unit_mm", surface.rest.unit_mm},
                      {"rest", surface.rest.values},
                      {"corners", surface.corners},
                      {"faces", surface.faces}});
  return {{"bodies", bodies}, {"views", list}};
}

} // namespace springproof::compare
