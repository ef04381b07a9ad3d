#include "cases/scene/loads.hpp"

#include <catch2/catch.hpp>
#include <numeric>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

/// A box of 2 x 1 x 1 cells of 10 x 20 x 30 mm, of 1000 kg/m³.
Case two_cells() {
  Case definition;
  definition.body = Box{{20, 20, 30}, {2, 1, 1}};
  definition.fixed.push_back({Region{"x-"}, {true, true, true}});
  definition.material_dynamics = {1000., 0.5, 0.001};
  return definition;
}

double total(const std::vector<double>& masses) {
  return std::accumulate(masses.begin(), masses.end(), 0.0);
}

double total(const NodeMasses& masses) {
  double sum = 0;
  for (const auto& [node, mass] : masses) sum += mass;
  return sum;
}

constexpr double one_cell = 6e-6; // t: 6000 mm³ of water

} // namespace

TEST_CASE("a point has an eighth of every cell that it belongs to, in tonnes") {
  const Scene scene = make_scene(two_cells());
  const std::vector<double> masses = point_masses(scene);
  CHECK(total(masses) == Approx(2 * one_cell).epsilon(1e-13));
  for (std::size_t n = 0; n < masses.size(); ++n) {
    const bool is_shared = scene.mesh.nodes[n].x() == 10;
    CHECK(masses[n] == Approx((is_shared ? 2 : 1) * one_cell / 8).epsilon(1e-13));
  }
}

TEST_CASE("uniform masses share the body's out equally, of several materials too") {
  Case definition = two_cells();
  definition.msm.mass = PointMass::uniform;
  RegionMaterial heavy;
  heavy.lower = {10, 0, 0};
  heavy.upper = {20, 20, 30};
  heavy.dynamics = {3000., 0., 0.};
  definition.region_materials.push_back(heavy);
  const Scene scene = make_scene(definition);
  for (const double mass : point_masses(scene)) CHECK(mass == Approx(4 * one_cell / 12).epsilon(1e-13));
  CHECK(dynamics_of(scene, 0).density == Approx(1e-9).epsilon(1e-13));
  CHECK(dynamics_of(scene, 1).density == Approx(3e-9).epsilon(1e-13));
  CHECK(total(point_mass_damping(scene)) == Approx(0.5 * one_cell).epsilon(1e-13)); // the first cell's
}

TEST_CASE("a weight is shared by its region's nodes, on the refined mesh too, and is not damped") {
  Case definition = two_cells();
  definition.masses.push_back({Region{"x+ z+"}, 0.052});
  const Scene scene = make_scene(definition);
  const NodeMasses added = added_masses(scene);
  CHECK(added.size() == 2);
  for (const auto& [node, mass] : added) {
    const Vector3d at = scene.mesh.nodes[index(node)];
    CHECK((at.x() == 20 && at.z() == 30));
    CHECK(mass == Approx(0.026e-3).epsilon(1e-13));
  }
  CHECK(total(point_masses(scene)) == Approx(2 * one_cell + 0.052e-3).epsilon(1e-13));
  CHECK(total(point_mass_damping(scene)) == Approx(0.5 * 2 * one_cell).epsilon(1e-13));
  const Scene fine = refine(scene, 1);
  CHECK(total(added_masses(fine)) == Approx(0.052e-3).epsilon(1e-13));
  CHECK(fine.masses.front().selection.nodes.size() == 3);
}

TEST_CASE("a weight on a symmetry plane is the modelled part's, less at nodes on the plane") {
  Case definition = two_cells();
  definition.symmetry.push_back({Region{"y-"}, {false, true, false}});
  definition.masses.push_back({Region{"x+ z+"}, 0.03});
  const Scene scene = make_scene(definition);
  const NodeMasses added = added_masses(scene);
  CHECK(added.size() == 2);
  for (const auto& [node, mass] : added)
    CHECK(mass == Approx(scene.mesh.nodes[index(node)].y() == 0 ? 0.01e-3 : 0.02e-3).epsilon(1e-13));
  CHECK(total(added) == Approx(0.03e-3).epsilon(1e-13));
}

TEST_CASE("gravity weighs every point with its mass, in N, and what is added too") {
  Case definition = two_cells();
  definition.masses.push_back({Region{"x+ z+"}, 0.052});
  Scene scene = make_scene(definition);
  scene.loads = {{{}, {{}, loads::Gravity{{0, 0, -9.81}}}}, {{}, {{}, loads::Gravity{{2, 0, 0}}}}};
  CHECK((gravity(scene) - Vector3d(2000, 0, -9810)).norm() < 1e-9);
  Vector3d sum = Vector3d::Zero();
  for (const auto& [node, force] : weights(point_masses(scene), gravity(scene))) sum += force;
  const double kilograms = 0.012 + 0.052; // two cells of 6 cm³ of water, and the weight
  CHECK((sum - kilograms * Vector3d(2, 0, -9.81)).norm() < 1e-12);
}

TEST_CASE("a case without a density has no mass") {
  Case definition = two_cells();
  definition.material_dynamics.density.reset();
  CHECK(total(point_masses(make_scene(definition))) == 0);
}
