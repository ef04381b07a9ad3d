#include "fem_reference/grid/supported.hpp"

#include "cases/scene/loads.hpp"

#include <algorithm>

namespace springproof::fem_reference::grid {

namespace {

using cases::index;

/// Nodes on a selection's vertices and, for quadratic elements, on its edges and faces.
std::vector<Place> places_on(const cases::Scene& scene, const cases::Selection& selection, bool is_quadratic,
                             const Places& places) {
  const auto place_of = [&](int node) { return places.of(scene.mesh.nodes[index(node)]); };
  std::vector<Place> found;
  for (const int node : selection.nodes) found.push_back(place_of(node));
  if (!is_quadratic) return found;
  const auto add_middle = [&](int a, int b) { found.push_back((place_of(a) + place_of(b)) / 2); };
  for (const auto& edge : selection.edges) add_middle(edge[0], edge[1]);
  for (const auto& face : selection.faces) {
    for (std::size_t v = 0; v < 4; ++v) add_middle(face[v], face[(v + 1) % 4]);
    add_middle(face[0], face[2]);
  }
  const auto is_before = [](const Place& a, const Place& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(found.begin(), found.end(), is_before);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Adds the force of gravity on every element, by the integrals of its shape functions, and on what [[mass]]
/// adds.
template<class AddForce>
void add_weights(const cases::Scene& scene, bool is_quadratic, const Places& places,
                 const AddForce& add_force) {
  const Eigen::Vector3d gravity = cases::gravity(scene);
  if (gravity.isZero(0)) return;
  const cases::HexMesh& mesh = scene.mesh;
  const int n = is_quadratic ? 3 : 2; // nodes along an edge
  const double along[3] = {is_quadratic ? 1. / 6 : 1. / 2, is_quadratic ? 4. / 6 : 1. / 2, 1. / 6};
  const double volume = places.spacing.prod() * (is_quadratic ? 8 : 1);
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    const Place lower = places.of(mesh.nodes[index(mesh.cells[cell][0])]);
    const Eigen::Vector3d weight = cases::dynamics_of(scene, cell).density * volume * gravity;
    for (int c = 0; c < n; ++c)
      for (int b = 0; b < n; ++b)
        for (int a = 0; a < n; ++a)
          add_force(lower + Place(a, b, c), along[a] * along[b] * along[c] * weight);
  }
  for (const auto& [node, mass] : cases::added_masses(scene))
    add_force(places.of(mesh.nodes[index(node)]), mass * gravity);
}

/// Shape functions of the nodes at 0, 1/2 and 1 on the unit interval.
Eigen::Vector3d quadratic_shapes(double x) {
  return {(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)};
}

Field<double> make_load(const cases::Scene& scene, bool is_quadratic, const Places& places) {
  const Layout& layout = places.body.layout;
  Field<double> load = Field<double>::Zero(3 * layout.size);
  const auto add_force = [&](const Place& at, const Eigen::Vector3d& force) {
    if (!places.owns(at)) return;
    for (int c = 0; c < 3; ++c) load[c * layout.size + places.entry(at)] += force[c];
  };
  const std::vector<cases::NodeVector> forces =
      is_quadratic ? cases::nodes_with_point_forces(scene) : cases::loaded_nodes(scene);
  for (const auto& [node, force] : forces)
    if (!force.isZero(0)) add_force(places.of(scene.mesh.nodes[index(node)]), force);
  add_weights(scene, is_quadratic, places, add_force);
  if (!is_quadratic) return load;
  for (const auto& applied : scene.loads) {
    const auto traction_at = cases::surface_traction(scene.mesh, applied);
    if (!traction_at) continue;
    for (const auto& face : applied.selection.faces) {
      std::array<Eigen::Vector3d, 4> vertices;
      std::array<Place, 4> corners;
      for (std::size_t v = 0; v < 4; ++v) {
        vertices[v] = scene.mesh.nodes[index(face[v])];
        corners[v] = places.of(vertices[v]);
      }
      for (const auto& [s, t, point, area] : cases::gauss_points(vertices, 4)) {
        const Eigen::Vector3d force = area * traction_at(point), along_s = quadratic_shapes(s),
                              along_t = quadratic_shapes(t);
        for (int b = 0; b < 3; ++b)
          for (int a = 0; a < 3; ++a)
            add_force(corners[0] + (a * (corners[1] - corners[0]) + b * (corners[3] - corners[0])) / 2,
                      along_s[a] * along_t[b] * force);
      }
    }
  }
  return load;
}

} // namespace

Supported make_supported(const cases::Scene& scene, bool is_quadratic, const Places& places, Body& body) {
  const std::ptrdiff_t size = body.layout.size;
  places.for_each([&](const Place& at) {
    for (int c = 0; c < 3; ++c) body.free[c * size + places.entry(at)] = 1;
  });
  for (const auto& fixed : scene.constrained)
    for (const Place& at : places_on(scene, fixed.selection, is_quadratic, places))
      for (int c = 0; places.owns(at) && c < 3; ++c)
        if (fixed.components[index(c)]) body.free[c * size + places.entry(at)] = 0;
  body.slab.update_ghosts(body.layout, body.free.data());
  Supported made;
  made.load = make_load(scene, is_quadratic, places);
  made.load.array() *= body.free.cast<double>().array();
  struct MovedNode {
    Eigen::Vector3d rest;
    cases::Moved motion;
  };
  std::vector<MovedNode> nodes;
  for (const auto& [selection, motion] : scene.moved)
    for (const Place& at : places_on(scene, selection, is_quadratic, places)) {
      if (!places.holds(at)) continue;
      nodes.push_back({places.rest(at), motion});
      for (int c = 0; c < 3; ++c)
        if (motion.components[index(c)]) made.moved.push_back(c * size + places.entry(at));
    }
  if (scene.moved.empty()) return made;
  const auto values_at = [nodes](const auto& factor) {
    std::vector<double> values;
    for (const auto& [rest, motion] : nodes) {
      const Eigen::Vector3d by = cases::moved_by(motion, rest, factor(motion));
      for (std::size_t c = 0; c < 3; ++c)
        if (motion.components[c]) values.push_back(by[static_cast<int>(c)]);
    }
    return values;
  };
  made.prescribed = [values_at](double load_factor) {
    return values_at([=](const cases::Moved&) { return load_factor; });
  };
  made.prescribed_at = [values_at](double time) {
    return values_at([=](const cases::Moved& motion) { return motion.history.at(time); });
  };
  return made;
}

std::vector<mechanics::LoadInTime> loads_in_time(const cases::Scene& scene, bool is_quadratic,
                                                 const Places& places) {
  std::vector<mechanics::LoadInTime> loads;
  cases::Scene alone = scene;
  for (const auto& applied : scene.loads) {
    alone.loads = {applied};
    Field<double> force = make_load(alone, is_quadratic, places);
    force.array() *= places.body.free.cast<double>().array();
    loads.emplace_back(applied.load.history, force);
  }
  return loads;
}

} // namespace springproof::fem_reference::grid
