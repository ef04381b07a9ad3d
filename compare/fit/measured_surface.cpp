#include "cases/case/error.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "compare/fit/fit.hpp"
#include "compare/measure/surfaces.hpp"

namespace springproof::compare {

MeasuredSurface read_measured_surface(const std::string& path, const cases::Scene& scene,
                                      const std::string& place) {
  cases::refuse_network(scene.definition, "surface", "give markers");
  try {
    MeasuredSurface surface{path, cases::read_surface(path).vertices, {}, {}};
    surface.moved = distances_from(scene, {}, surface.points);
    return surface;
  } catch (const cases::InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw cases::InputError(place + path + ": " + error.what());
  }
}

Eigen::VectorXd distances_from(const cases::Scene& scene, const std::vector<Eigen::Vector3d>& displacement,
                               const std::vector<Eigen::Vector3d>& points) {
  const mechanics::EmbeddedSurface body = embedded_surface(scene);
  cases::TriangleMesh deformed = body.rest;
  if (!displacement.empty()) mechanics::move(body, displacement, deformed.vertices);
  const std::vector<double> distances = cases::vtk().distances(deformed, points);
  return Eigen::Map<const Eigen::VectorXd>(distances.data(), static_cast<Eigen::Index>(distances.size()));
}

} // namespace springproof::compare
