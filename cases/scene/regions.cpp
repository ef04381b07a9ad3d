#include "cases/scene/regions.hpp"

#include "cases/mesh/read_mesh.hpp"
#include "cases/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

constexpr double near_tolerance = 1e-6; ///< mm: `near` names a node and does not search for one

std::size_t nearest_node(const Mesh& mesh, const Vector3d& point) {
  if (const auto& grid = mesh.nodes.rule) { // without a look at the others
    std::size_t node = 0;
    for (int a = 2; a >= 0; --a) {
      const int n_cells = grid->cells[index(a)];
      const double place = std::round((point[a] - grid->origin[a]) / grid->step[a]);
      node = node * (index(n_cells) + 1) +
             static_cast<std::size_t>(place > 0 ? std::min<double>(place, n_cells) : 0);
    }
    return node;
  }
  return std::min_element(mesh.nodes.begin(), mesh.nodes.end(),
                          [&](const auto& a, const auto& b) {
                            return (a - point).squaredNorm() < (b - point).squaredNorm();
                          })
      .number();
}

/// Adds a cell's edges and faces between selected vertices.
void add_sides(const CellNodes& cell, const Few<bool, 8>& is_selected, Selection& selection) {
  const ReferenceCell& shape = reference_cell(shape_of(cell.size()));
  const auto are_selected = [&](const auto& vertices) {
    return std::all_of(vertices.begin(), vertices.end(), [&](int v) { return is_selected[index(v)]; });
  };
  for (const auto& edge : shape.edges)
    if (are_selected(edge)) selection.edges.push_back(sorted(pick(cell, edge)));
  for (const auto& face : shape.faces)
    if (are_selected(face)) selection.faces.push_back(pick(cell, face));
}

/// A face between two cells has come from both: the first stays.
void keep_each_once(std::vector<FaceNodes>& faces) {
  std::set<FaceNodes> seen;
  const auto is_known = [&](const FaceNodes& face) { return !seen.insert(sorted(face)).second; };
  faces.erase(std::remove_if(faces.begin(), faces.end(), is_known), faces.end());
}

/// Does the same as select_on_planes() on a grid whose cells are all present, without a look at inner ones.
Selection select_on_planes_of(const GridNodes& grid, const Mesh& mesh,
                              const std::vector<std::string>& faces) {
  std::array<int, 3> first{0, 0, 0}, last = grid.cells; // places of selected nodes along each axis
  for (const std::string& face : faces) {
    const auto axis = index(face[0] - 'x');
    if (face[1] == '+')
      first[axis] = grid.cells[axis];
    else
      last[axis] = std::min(last[axis], 0);
  }
  const auto in_planes = [](std::array<int, 3> from, std::array<int, 3> to, const auto& action) {
    for (int k = from[2]; k <= to[2]; ++k)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i) action(i, j, k);
  };
  const auto number = [](int i, int j, int k, int n_x, int n_y) {
    return index(i) + index(n_x) * (index(j) + index(n_y) * index(k));
  };
  Selection selection;
  in_planes(first, last, [&](int i, int j, int k) {
    selection.nodes.push_back(static_cast<int>(number(i, j, k, grid.cells[0] + 1, grid.cells[1] + 1)));
  });
  std::array<int, 3> first_cell, last_cell; // they have selected vertices
  for (std::size_t a = 0; a < 3; ++a) {
    first_cell[a] = std::max(first[a] - 1, 0);
    last_cell[a] = std::min(last[a], grid.cells[a] - 1);
  }
  in_planes(first_cell, last_cell, [&](int i, int j, int k) {
    Few<bool, 8> is_selected;
    for (int v = 0; v < 8; ++v) {
      const std::array<int, 3> at{i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2)};
      bool is_inside = true;
      for (std::size_t a = 0; a < 3; ++a) is_inside = is_inside && at[a] >= first[a] && at[a] <= last[a];
      is_selected.push_back(is_inside);
    }
    add_sides(mesh.cells[number(i, j, k, grid.cells[0], grid.cells[1])], is_selected, selection);
  });
  make_set(selection.edges);
  return selection;
}

/// The node at the region's point.  @throws InputError if there is none within its tolerance, or 1e-6 mm
Selection select_near(const Mesh& mesh, const Region& region) {
  const Vector3d& point = *region.near;
  const std::size_t nearest = nearest_node(mesh, point);
  const Vector3d found = mesh.nodes[nearest];
  const double distance = (found - point).norm(), tolerance = region.tolerance.value_or(near_tolerance);
  if (!(distance <= tolerance))
    refuse(region.where, "no node within {} mm of ({}): the nearest is {:.6g} mm away at ({})", tolerance,
           fmt::join(point, ", "), distance, fmt::join(found, ", "));
  return {{static_cast<int>(nearest)}, {}, {}};
}

/// The nodes of the region's part, and the edges and faces between them of that part's cells.
Selection select_part(const Mesh& mesh, const Region& region) {
  const Part& part = *region.part;
  const auto is_of_class = [&](std::size_t cell) {
    return part.cell_class.empty() ||
           (!mesh.group_of_cell.empty() && mesh.group_of_cell[cell] == part.cell_class);
  };
  const Eigen::AlignedBox3d body = bounding_box(mesh.nodes);
  const double rounding = 1e-9 * body.sizes().norm(); // as select_on_planes()
  std::vector<bool> is_in_class(mesh.nodes.size(), part.cell_class.empty());
  for (std::size_t c = 0; c < mesh.cells.size() && !part.cell_class.empty(); ++c)
    if (is_of_class(c))
      for (const int node : mesh.cells[c]) is_in_class[index(node)] = true;
  std::vector<bool> is_selected(mesh.nodes.size(), false);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Vector3d node = mesh.nodes[n];
    is_selected[n] = is_in_class[n] && (node.array() >= part.lower.array() - rounding).all() &&
                     (node.array() <= part.upper.array() + rounding).all() &&
                     (node - part.point).dot(part.normal) >= -rounding;
  }
  return select_between(mesh, is_selected, is_of_class);
}

/// @throws InputError if physical groups of several dimensions have the region's name
void check_is_one_group(const Mesh& mesh, const Region& region) {
  std::vector<std::string> meant;
  for (int dimension = 0; dimension < 3; ++dimension)
    if (const std::string name = name_in_dimension(region.name, dimension); mesh.groups.count(name) > 0)
      meant.push_back("'" + name + "'");
  if (meant.empty()) return;
  const auto& of_cells = mesh.group_of_cell;
  if (contains(of_cells, region.name))
    meant.push_back(fmt::format("{{ class = \"{}\" }} for the nodes of the volume", region.name));
  refuse(region.where,
         "'{}' is the name of physical groups of several dimensions; must be {}, or "
         "groups of names of their own",
         region.name, fmt::join(meant, " or "));
}

bool is_on_plane(const Mesh& mesh, const FaceNodes& face, const Plane& plane) {
  return std::all_of(face.begin(), face.end(), [&](int node) {
    return std::abs((mesh.nodes[index(node)] - plane.point).dot(plane.normal)) <= plane.tolerance;
  });
}

/// Where the body ends on both sides of a plane, or how far its nearest node is from a point.
std::string reason_without_face(const Mesh& mesh, const Region& region) {
  if (region.plane) {
    double lowest = INFINITY, highest = -INFINITY;
    for (const Vector3d& node : mesh.nodes) {
      const double height = (node - region.plane->point).dot(region.plane->normal);
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
    return fmt::format(": the body reaches from {:.6g} to {:.6g} mm beyond the plane along its normal",
                       lowest, highest);
  }
  const Vector3d nearest = mesh.nodes[nearest_node(mesh, *region.near)];
  return fmt::format(" with its centre there: the node nearest to the point is {:.6g} mm away at ({})",
                     (nearest - *region.near).norm(), fmt::join(nearest, ", "));
}

} // namespace

void find_nearest_nodes(const Mesh& mesh, Case& definition, std::vector<std::string>& remarks) {
  for_each_region_of(definition, [&](Region& region) {
    if (!region.tolerance) return;
    const Vector3d point = *region.near, found = mesh.nodes[index(select_near(mesh, region).nodes[0])];
    remarks.push_back(fmt::format("{}: the node nearest to ({}) is {:.6g} mm away at ({:.6g})",
                                  region.where.key, fmt::join(point, ", "), (found - point).norm(),
                                  fmt::join(found, ", ")));
    region.near = found;
    region.tolerance.reset();
  });
}

std::vector<NodeWeight> weights_at(const Mesh& mesh, const Region& region) {
  if (!region.is_in_cell) return {{select_node(mesh, region), 1}};
  const Vector3d& point = *region.near;
  const auto cells = cells_at(mesh, point);
  if (cells.empty()) {
    const Vector3d nearest = mesh.nodes[nearest_node(mesh, point)];
    refuse(region.where,
           "is [{}], must be a point of the body at rest (mm): the nearest node is {:.6g} mm away at "
           "({:.6g}), and "
           "nearest with a tolerance measures there",
           fmt::join(point, ", "), (nearest - point).norm(), fmt::join(nearest, ", "));
  }
  const auto at = place_in_cell(cell_corners(mesh, cells.front()), point);
  return on_nodes({{CellPoint{cells.front(), *at, Vector3d::Zero()}, 1}}, mesh);
}

Selection select_on_planes(const Mesh& mesh, const std::vector<std::string>& faces) {
  if (mesh.nodes.rule && mesh.cells.rule) return select_on_planes_of(*mesh.nodes.rule, mesh, faces);
  const Eigen::AlignedBox3d body = bounding_box(mesh.nodes);
  const double rounding = 1e-9 * body.sizes().norm(); // far above that of i * spacing, far below a cell
  std::vector<bool> is_selected;
  for (const Vector3d& node : mesh.nodes)
    is_selected.push_back(std::all_of(faces.begin(), faces.end(), [&](const std::string& face) {
      const int axis = face[0] - 'x';
      return std::abs(node[axis] - (face[1] == '+' ? body.max() : body.min())[axis]) <= rounding;
    }));
  return select_between(mesh, is_selected);
}

std::vector<int> planes_of_nodes(const Mesh& mesh, const std::vector<Fixed>& symmetry) {
  std::vector<int> planes(symmetry.empty() ? 0 : mesh.nodes.size(), 0);
  for (std::size_t plane = 0; plane < symmetry.size(); ++plane)
    for (const int node : select_on_planes(mesh, {symmetry[plane].region.name}).nodes)
      planes[index(node)] |= 1 << plane;
  return planes;
}

std::vector<FaceNodes> surface_faces(const Mesh& mesh, const std::vector<Fixed>& symmetry) {
  std::vector<FaceNodes> faces = boundary_faces(mesh);
  const std::vector<int> planes = planes_of_nodes(mesh, symmetry);
  const auto is_mirrored = [&](const FaceNodes& face) {
    int common = ~0;
    for (const int node : face) common &= planes[index(node)];
    return common != 0;
  };
  if (!planes.empty()) faces.erase(std::remove_if(faces.begin(), faces.end(), is_mirrored), faces.end());
  return faces;
}

Selection select_patch(const Mesh& mesh, const std::vector<FaceNodes>& surface, const Region& region) {
  Selection patch;
  for (const auto& face : surface) {
    if (!(region.plane ? is_on_plane(mesh, face, *region.plane)
                       : (centre_of(mesh, face) - *region.near).norm() <= *region.radius))
      continue;
    patch.faces.push_back(face);
    patch.nodes.insert(patch.nodes.end(), face.begin(), face.end());
    for (const auto& side : sides_of(face)) patch.edges.push_back(sorted(side));
  }
  if (patch.faces.empty())
    refuse(region.where, "'{}' has no face of the body's surface{}", region.name,
           reason_without_face(mesh, region));
  make_set(patch.nodes);
  make_set(patch.edges);
  return patch;
}

Selection select_between(const Mesh& mesh, const std::vector<bool>& is_selected,
                         const std::function<bool(std::size_t)>& is_of_cells) {
  Selection selection;
  for (std::size_t n = 0; n < is_selected.size(); ++n)
    if (is_selected[n]) selection.nodes.push_back(static_cast<int>(n));
  for (std::size_t c = 0; c < mesh.cells.size() && !selection.nodes.empty(); ++c) {
    if (is_of_cells && !is_of_cells(c)) continue;
    Few<bool, 8> vertices;
    for (const int node : mesh.cells[c]) vertices.push_back(is_selected[index(node)]);
    add_sides(mesh.cells[c], vertices, selection);
  }
  make_set(selection.edges);
  keep_each_once(selection.faces);
  return selection;
}

Selection select(const Mesh& mesh, const Region& region) {
  if (region.is_node()) return select_near(mesh, region);
  Selection selection;
  if (region.part) {
    selection = select_part(mesh, region);
  } else if (const auto group = mesh.groups.find(region.name); group != mesh.groups.end()) {
    selection = group->second;
  } else if (const auto words = words_of(region.name); are_faces(words)) {
    selection = select_on_planes(mesh, words);
  } else {
    check_is_one_group(mesh, region);
    std::string known = mesh.groups.empty() ? "" : ", and the mesh's groups";
    for (const auto& entry : mesh.groups) known += " '" + entry.first + "'";
    refuse(region.where, "'{}' names no region; allowed are {} joined by blanks{}", region.name,
           fmt::join(face_names, " "), known);
  }
  if (selection.nodes.empty()) refuse(region.where, "'{}' selects no node", region.name);
  return selection;
}

int select_node(const Mesh& mesh, const Region& region) {
  const Selection selection = select(mesh, region);
  if (selection.nodes.size() != 1)
    refuse(region.where, "'{}' selects {} nodes, and exactly one is wanted", region.name,
           selection.nodes.size());
  return selection.nodes.front();
}

} // namespace springproof::cases
