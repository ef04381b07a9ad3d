#include "compare/report/skin.hpp"

#include "compare/measure/surfaces.hpp"
#include "compare/report/lengths.hpp"
#include "compare/table/json.hpp"

namespace springproof::compare {

using Json = nlohmann::ordered_json;

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
    const Lengths displacement = lengths(moves);
    skin[side] = {{"unit_mm", displacement.unit_mm}, {"displacement", displacement.values}};
    return true;
  };
  if (!add("fem", comparison.answers.fem) || !add("springs", comparison.answers.msm)) return nullptr;
  Json marks = Json::array();
  for (const cases::Landmark& landmark : scene.definition.landmarks) {
    const Eigen::Vector3d& point = landmark.point;
    marks.push_back(
        Json{{"name", landmark.name}, {"point", std::vector<double>{point[0], point[1], point[2]}}});
  }
  skin["marks"] = marks;
  return skin;
}

} // namespace springproof::compare
