#include "cases/scene/network.hpp"

#include "cases/case/input_file.hpp"
#include "cases/scene/loads.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <utility>

namespace springproof::cases {

namespace {

using Eigen::Vector3d;

/// The finite elements' scene beside a network: the same case on a body of cells.
Scene scene_of_fem(Case definition) try {
  definition.body = *std::exchange(definition.fem_body, std::nullopt);
  const Where where = definition.msm.where;
  definition.msm = {};
  definition.msm.where = where;
  definition.measures.clear(); // add_measures() has them
  definition.has_fields = false;
  return make_scene(definition);
} catch (const InputError& error) {
  throw InputError(fmt::format("{} (on the mesh of [fem.body])", error.what()));
}

/// Measures of nodes become those of the same places in the cells, where there are some.
void add_measures(const Scene& network, Scene& of_fem) {
  for (Measure measure : network.definition.measures) {
    bool is_inside = true;
    for_each_region(measure, [&](Region& region, bool is_node) {
      if (!is_node) return;
      const Vector3d at = network.mesh.nodes[index(select_node(network.mesh, region))];
      is_inside = is_inside && !cells_at(of_fem.mesh, at).empty();
      region = Region{"", at, region.where};
      region.is_in_cell = true;
    });
    const auto from = measures::from_of(measure.kind);
    if (is_inside && (from == measures::From::nodes || from == measures::From::displacement_field))
      of_fem.definition.measures.push_back(std::move(measure));
  }
}

double sum(const std::vector<double>& masses) {
  return std::accumulate(masses.begin(), masses.end(), 0.0);
}

/// The mass of a body, t, without [[mass]], which a network has by itself.
double own_mass(const Scene& scene) {
  double mass = sum(point_masses(scene, PointMass::cells));
  for (const auto& [node, added] : added_masses(scene)) mass -= added;
  return mass;
}

/// Says that two models carry different weights.
void check_weights(Scene& scene, double of_fem) {
  constexpr double told = 0.01; // as much of the displacements
  const double of_network = sum(scene.node_masses);
  if (gravity(scene).isZero(0) || std::abs(of_network - of_fem) <= told * of_fem) return;
  scene.remarks.push_back(fmt::format(
      "{}: nodes of {:.4g} kg, where [fem.body] has {:.4g} kg: gravity pulls at the two models differently",
      std::get<Network>(scene.definition.body).nodes.path, of_network / tonnes_per_kg,
      of_fem / tonnes_per_kg));
}

/// Gives a network without masses equal shares of the mass of the finite elements' body.
/// @throws InputError if something needs masses and there are none
void settle_masses(Scene& scene) {
  const Case& definition = scene.definition;
  const Network* network = std::get_if<Network>(&definition.body);
  if (!network) return;
  if (definition.fem_body && definition.material_dynamics.density) {
    const double total = own_mass(scene.of_fem.front());
    if (scene.node_masses.empty())
      scene.node_masses.assign(scene.mesh.nodes.size(), total / static_cast<double>(scene.mesh.nodes.size()));
    else
      check_weights(scene, total);
  } else if (!scene.node_masses.empty()) {
    return;
  } else if (definition.dynamics || definition.msm.real_time || !gravity(scene).isZero(0) ||
             !definition.masses.empty()) {
    network->nodes.refuse(fmt::format("has no masses, which {} needs: give every node a fourth column, kg",
                                      definition.dynamics         ? "[dynamics]"
                                      : definition.msm.real_time  ? "msm.real_time"
                                      : definition.masses.empty() ? "gravity"
                                                                  : "[[mass]]"));
  }
}

} // namespace

void resolve_network(Scene& scene, const Case& as_read) {
  if (scene.definition.fem_body) {
    Scene& of_fem = scene.of_fem.emplace_back(scene_of_fem(as_read));
    add_measures(scene, of_fem);
    scene.definition.fem = of_fem.definition.fem;
    scene.remarks.insert(scene.remarks.end(), of_fem.remarks.begin(), of_fem.remarks.end());
  }
  settle_masses(scene);
  const auto& file = scene.definition.msm.network;
  if (!file) return;
  scene.network = read_network(read_text_file(file->path), file->path, scene.mesh.nodes.size());
  for (const NetworkSpring& spring : scene.network)
    if (!spring.rest_length && scene.mesh.nodes[index(spring.a)] == scene.mesh.nodes[index(spring.b)])
      refuse(file->where, "the spring between nodes {} and {}, which lie in one place, needs a rest length",
             spring.a, spring.b);
  if (!has_cells(scene.definition.body))
    for (const NetworkSpring& spring : scene.network) scene.mesh.lines.push_back({spring.a, spring.b});
}

} // namespace springproof::cases
