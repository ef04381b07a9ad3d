#include "scenes.hpp"

#include "tests/support/scene_in_tetrahedra.hpp"

#include <cmath>

using namespace springproof;

namespace scenes {

using Eigen::Vector3d;

namespace {

void push(cases::Case& definition, const std::string& where, const Vector3d& force) {
  definition.loads.push_back({cases::Region{where}, cases::loads::NodalForce{force}});
}

int nearest(const cases::Mesh& mesh, const Vector3d& point) {
  cases::Region r;
  r.near = point;
  return cases::select_node(mesh, r);
}

double degrees(double radians) {
  return radians * 180 / std::acos(-1.);
}

} // namespace

std::vector<cases::Fixed> on_rollers(const std::vector<std::string>& faces) {
  std::vector<cases::Fixed> fixed;
  for (const std::string& face : faces)
    fixed.push_back({{face}, {face[0] == 'x', face[0] == 'y', face[0] == 'z'}});
  return fixed;
}

cases::LinearElastic thesis_elastic(double poissons_ratio) {
  return {0.3, poissons_ratio};
}

cases::Ogden thesis_ogden() {
  return {{0.01444, 0.01444, 0.01444}, {5.7255, 5.7255, 5.7255}, std::nullopt};
}

cases::TransverselyIsotropic fibrous(const Vector3d& fibre) {
  return {0.3, 0.1, 0.4, 0.5, 0.05, fibre.normalized()};
}

cases::Case cube(Test test, LoadSet set, const cases::Material& material, cases::Formulation formulation,
                 cases::Element element, int cells) {
  cases::Case c;
  c.name = "cube";
  c.body = cases::Box{Vector3d(10, 10, 10), {cells, cells, cells}};
  c.material = material;
  cases::Fixed clamp;
  clamp.region = cases::Region{"z-"};
  c.fixed.push_back(clamp);
  const double scale = set == LoadSet::large ? 5 : 1;
  if (test == Test::tensile) push(c, "z+", {0, 0, 0.010 * scale});
  if (test == Test::shear) push(c, "z+", {0.002 * scale, 0, 0});
  if (test == Test::torsion) {
    push(c, "z+ y-", {0.005 * scale, 0, 0});
    push(c, "z+ x+", {0, 0.005 * scale, 0});
    push(c, "z+ y+", {-0.005 * scale, 0, 0});
    push(c, "z+ x-", {0, -0.005 * scale, 0});
  }
  c.fem.formulation = formulation;
  c.fem.element = element;
  return c;
}

std::array<double, 2> cube_measures(Test test, const cases::Mesh& mesh,
                                    const std::vector<Vector3d>& displacement) {
  const auto deformed = [&](double x, double y, double z) -> Vector3d {
    const auto n = static_cast<std::size_t>(nearest(mesh, {x, y, z}));
    return mesh.nodes[n] + displacement[n];
  };
  if (test == Test::tensile) return {deformed(5, 5, 10).z(), deformed(0, 0, 10).z()};
  if (test == Test::shear) {
    const Vector3d left = deformed(0, 0, 10) - deformed(0, 0, 0),
                   right = deformed(10, 0, 10) - deformed(10, 0, 0);
    return {degrees(std::atan2(left.x(), left.z())), degrees(std::atan2(right.x(), right.z()))};
  }
  const Vector3d centre = deformed(5, 5, 10);
  const auto turned = [&](double x, double y) {
    const Vector3d now = deformed(x, y, 10) - centre;
    return degrees(
        std::remainder(std::atan2(now.y(), now.x()) - std::atan2(y - 5, x - 5), 2 * std::acos(-1.)));
  };
  return {turned(5, 0), turned(0, 0)};
}

cases::Scene distorted_box(int cells, Surface surface, const cases::Material& material,
                           cases::Formulation formulation, cases::Element element) {
  cases::Scene scene;
  scene.definition.name = "distorted box";
  scene.definition.material = material;
  scene.definition.fem.formulation = formulation;
  scene.definition.fem.element = element;
  scene.mesh = cases::make_box_mesh(Vector3d::Ones(), {cells, cells, cells});
  scene.mesh.grid.reset();
  if (cases::facts_of(element).is_tetrahedron) scene.mesh = bodies::cut_in_tetrahedra(scene.mesh);
  std::vector<bool> on_surface(scene.mesh.nodes.size());
  for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
    Vector3d& x = scene.mesh.nodes.stored()[n];
    on_surface[n] = x.minCoeff() < 1e-12 || x.maxCoeff() > 1 - 1e-12;
    if (on_surface[n]) continue;
    const auto k = static_cast<double>(n); // pseudo-random, the same on every machine
    x += 0.2 / cells * Vector3d(std::sin(12.9 * k), std::sin(78.2 * k), std::sin(37.7 * k));
  }
  if (surface == Surface::free) return scene;
  cases::Selection selection;
  for (std::size_t n = 0; n < on_surface.size(); ++n)
    if (on_surface[n]) selection.nodes.push_back(static_cast<int>(n));
  selection.faces = cases::boundary_faces(scene.mesh);
  scene.constrained.push_back({selection, {true, true, true}});
  return scene;
}

} // namespace scenes
