#include "fem_reference/grid/body.hpp"

#include "cases/mesh/mesh.hpp"
#include "cases/scene/loads.hpp"
#include "fem_reference/cuboid.hpp"
#include "mechanics/hexahedron.hpp"

#include <algorithm>

namespace springproof::fem_reference::grid {

using cases::index;
using mechanics::grid::for_each_place;

namespace {

bool is_small(const std::array<int, 3>& cells) {
  return (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1) < 500; // nodes
}

} // namespace

Layout make_layout(const std::array<int, 3>& cells) {
  Layout layout;
  for (int a = 0; a < 3; ++a) layout.nodes[a] = cells[index(a)] + 1;
  layout.row = (layout.nodes[0] + 15) / 16 * 16;
  layout.plane = layout.row * layout.nodes[1] + 16;
  layout.lead = layout.plane + layout.row + 16;
  layout.size = layout.lead + layout.plane * (layout.nodes[2] + 1) + layout.row + 48;
  return layout;
}

Body::Body(const std::array<int, 3>& cells_of_grid, const Slab& slab_, const Eigen::Vector3d& spacing_,
           Law law_, Internal internal_)
    : cells{cells_of_grid[0], cells_of_grid[1], slab_.n_layers()}, spacing(spacing_),
      layout(make_layout(cells)), slab(slab_), law(law_), internal(internal_),
      weight(index(layout.n_cell_entries() + 16)), free(Field<float>::Zero(3 * layout.size)) {}

Cells Body::view() const {
  Cells view{};
  view.layout = layout;
  view.law = law;
  view.internal = internal;
  for (int q = 0; q < 8; ++q) {
    const Eigen::Vector3d at = mechanics::gauss_point(q);
    const Eigen::Matrix<double, 3, 8> gradients = mechanics::shape_gradients(at);
    for (int d = 0; d < 3; ++d) view.bubbles[q][d] = (4 - 8 * at[d]) / spacing[d];
    for (int a = 0; a < 8; ++a)
      for (int d = 0; d < 3; ++d) view.gradients[q][a][d] = gradients(d, a) / spacing[d];
  }
  view.point_volume = spacing.prod() / 8;
  view.weight = weight.data();
  view.n_parameters = n_parameters;
  view.parameters = has_one_material() ? parameters.data() : nullptr;
  view.cell_parameters = has_one_material() ? nullptr : parameters.data();
  return view;
}

bool has_cell(const Body& body, int i, int j, int k) {
  for (int v = 0; v < 8; ++v) {
    const int a = i - (v & 1), b = j - (v >> 1 & 1), c = k - (v >> 2);
    if (a < 0 || b < 0 || c < 0 || a >= body.cells[0] || b >= body.cells[1] || c >= body.cells[2]) continue;
    if (body.weight[index(body.layout.cell(a, b, c))] > 0) return true;
  }
  return false;
}

Slab deal(const std::array<int, 3>& cells, MPI_Comm communicator, int multiple) {
  return is_small(cells) ? Slab(cells[2] + 1) : Slab(cells[2] + 1, communicator, multiple);
}

Slab coarsen(const Slab& fine, const std::array<int, 3>& cells, bool along_z) {
  return fine.coarser(along_z, is_small(cells) || (along_z && !fine.can_be_halved()));
}

Body coarsen(const Body& fine, const std::array<int, 3>& factor) {
  const std::array<int, 3> fine_cells = fine.cells_of_grid();
  std::array<int, 3> cells;
  Eigen::Vector3d spacing;
  for (std::size_t a = 0; a < 3; ++a) {
    cells[a] = (fine_cells[a] + factor[a] - 1) / factor[a];
    spacing[static_cast<int>(a)] = factor[a] * fine.spacing[static_cast<int>(a)];
  }
  Body coarse(cells, coarsen(fine.slab, cells, factor[2] == 2), spacing, fine.law, fine.internal);
  const int first = fine.slab.first_of_grid(), first_coarse = coarse.slab.first_of_grid();
  const float share = 1.0f / static_cast<float>(factor[0] * factor[1] * factor[2]);
  const auto place = [&](int i, int j, int k) {
    return index(coarse.layout.cell(i / factor[0], j / factor[1], (first + k) / factor[2] - first_coarse));
  };
  const auto n_fine = index(fine.layout.n_cell_entries()), n_coarse = index(coarse.layout.n_cell_entries());
  coarse.n_parameters = fine.n_parameters;
  coarse.parameters = fine.parameters;
  if (!fine.has_one_material()) coarse.parameters.assign(index(fine.n_parameters) * n_coarse, 0.);
  for_each_place(fine.cells, [&](int i, int j, int k) {
    const auto from = index(fine.layout.cell(i, j, k)), to = place(i, j, k);
    const float before = coarse.weight[to], added = share * fine.weight[from];
    if (!(added > 0)) return;
    coarse.weight[to] += added;
    if (fine.has_one_material()) return;
    const double part = static_cast<double>(added / (before + added));
    for (std::size_t p = 0; p < index(fine.n_parameters); ++p) {
      double& mean = coarse.parameters[p * n_coarse + to];
      mean += part * (fine.parameters[p * n_fine + from] - mean);
    }
  });
  const std::ptrdiff_t n_of_layer = coarse.layout.cell(0, 0, 1);
  coarse.slab.complete_layers(coarse.weight.data(), n_of_layer);
  if (!fine.has_one_material())
    for (std::size_t p = 0; p < index(fine.n_parameters); ++p)
      coarse.slab.complete_layers(coarse.parameters.data() + p * n_coarse, n_of_layer);
  const auto [begin, end] = coarse.slab.own();
  for (int k = begin; k < end; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i) {
        if (!has_cell(coarse, i, j, k)) continue;
        const int a = std::min(factor[0] * i, fine_cells[0]), b = std::min(factor[1] * j, fine_cells[1]),
                  c = std::min(factor[2] * (first_coarse + k), fine_cells[2]) - first;
        const bool is_inside = has_cell(fine, a, b, c);
        for (int d = 0; d < 3; ++d)
          coarse.free[d * coarse.layout.size + coarse.layout.at(i, j, k)] =
              is_inside ? fine.free[d * fine.layout.size + fine.layout.at(a, b, c)] : 1;
      }
  coarse.slab.complete(coarse.layout, coarse.free.data());
  return coarse;
}

namespace {

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
  const cases::Mesh& mesh = scene.mesh;
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

} // namespace

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
  for (const auto& applied : scene.loads) {
    if (!is_quadratic) break; // nodes have the tractions' forces already
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
        const Eigen::Vector3d force = area * traction_at(point);
        const IntervalShapes along_s = interval_shapes(2, s), along_t = interval_shapes(2, t);
        for (int b = 0; b < 3; ++b)
          for (int a = 0; a < 3; ++a)
            add_force(corners[0] + (a * (corners[1] - corners[0]) + b * (corners[3] - corners[0])) / 2,
                      along_s.value[a] * along_t.value[b] * force);
      }
    }
  }
  load.array() *= places.body.free.cast<double>().array();
  return load;
}

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

} // namespace springproof::fem_reference::grid
