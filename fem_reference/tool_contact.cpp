#include "cases/scene/tools.hpp"
#include "fem_reference/assembled_body.hpp"
#include "fem_reference/space.hpp"

#include <algorithm>
#include <deal.II/fe/fe_values.h>
#include <map>
#include <set>

/// Contact of assembled finite elements with rigid tools.
namespace springproof::fem_reference {

using cases::index;
using Eigen::Vector3d;

namespace {

/// Nodes of the elements on faces of the mesh, by their local numbers.
std::map<int, mechanics::SurfacePoint> nodes_of_surface(const std::vector<cases::FaceNodes>& touched,
                                                        double modulus, const Space& space,
                                                        const Nodes& nodes) {
  std::set<std::set<int>> faces; // by their vertices
  for (const auto& face : touched) faces.emplace(face.begin(), face.end());
  std::map<int, mechanics::SurfacePoint> points;
  dealii::FEFaceValues<3> values(*space.mapping, *space.node_element, space.quadrature_of_faces,
                                 dealii::update_values | dealii::update_JxW_values |
                                     dealii::update_normal_vectors);
  const int* node = nodes.of_cell.data();
  for (const auto& cell : space.own_cells()) {
    for (const unsigned face : cell->face_indices()) {
      if (!cell->at_boundary(face)) continue;
      std::set<int> vertices;
      for (const unsigned v : cell->face(face)->vertex_indices())
        vertices.insert(static_cast<int>(cell->face(face)->vertex_index(v)));
      if (faces.count(vertices) == 0) continue;
      values.reinit(static_cast<const dealii::Triangulation<3>::active_cell_iterator&>(cell), face);
      double area = 0;
      for (const unsigned q : values.quadrature_point_indices()) area += values.JxW(q);
      const double penalty = mechanics::Contact::penalty(modulus, std::sqrt(area));
      for (const unsigned q : values.quadrature_point_indices())
        for (const unsigned a : values.dof_indices()) {
          const double share = values.JxW(q) * values.shape_value(a, q);
          const auto& normal = values.normal_vector(q);
          const mechanics::SurfacePoint none{node[a], nodes.point[index(node[a])], 0, 0, Vector3d::Zero()};
          mechanics::SurfacePoint& point = points.try_emplace(node[a], none).first->second;
          point.area += share;
          point.stiffness += share * penalty;
          point.facing += share * Vector3d(normal[0], normal[1], normal[2]);
        }
    }
    node += nodes.per_cell;
  }
  return points;
}

} // namespace

/// Leaves out nodes without a share of the area: those inside, and the vertices of quadratic triangles.
void Discretisation::find_tool_sides(const cases::Scene& scene) {
  if (get<PetscMPIInt>(MPI_Comm_size, communicator) > 1)
    cases::refuse_tools(scene.definition, "finite elements on several ranks", "solve the case on one rank");
  const double modulus = mechanics::contact_modulus(scene);
  for (const cases::Tool& tool : scene.definition.tools) {
    const auto points = nodes_of_surface(cases::touched_faces(scene, tool), modulus, *space_, nodes);
    double largest = 0;
    for (const auto& [node, point] : points) largest = std::max(largest, point.area);
    mechanics::ToolSide& side = tool_sides.emplace_back(mechanics::ToolSide{tool, {}});
    for (const auto& [node, point] : points)
      if (point.area > 1e-9 * largest) side.points.push_back(point);
  }
}

/// Adds the tools' forces, as internal ones, to the sums of the last evaluation, and their stiffness to the
/// tangent; to the right side also what the gap will add, as that of the elements does.
void EquilibriumEquations::add_contact(const State& state, double load_factor, Wanted wanted) {
  const auto& d = discretisation_;
  const auto displacement = displacements(state);
  const bool wants_tangent = wanted != Wanted::stress;
  double squared = 0;
  {
    const WriteEntries force(force_.get()), right_side(right_hand_side_.get());
    contact_->for_each_pressed(displacement, load_factor, [&](const mechanics::Contact::Pressed& pressed) {
      squared += pressed.force.squaredNorm();
      const Eigen::Matrix3d block = pressed.tangent();
      const Eigen::Map<const Vector3d> gap(prescribed_gap_.data() + 3 * pressed.node);
      const Vector3d of_gap = block * gap;
      for (int c = 0; c < 3; ++c) {
        const std::size_t at = d.unknown(index(3 * pressed.node + c));
        force[at] -= pressed.force[c];
        if (wants_tangent) right_side[at] += of_gap[c] - pressed.force[c];
      }
    });
  }
  contact_force_ = std::sqrt(squared);
  if (!wants_tangent) return;
  contact_->for_each_pressed(displacement, load_factor, [&](const mechanics::Contact::Pressed& pressed) {
    const Eigen::Matrix3d block = pressed.tangent(); // symmetric: rows and columns may be exchanged
    std::array<PetscInt, 3> rows{};
    for (int c = 0; c < 3; ++c) {
      const std::size_t at = d.unknown(index(3 * pressed.node + c));
      rows[index(c)] = d.is_held(at) ? -1 : static_cast<PetscInt>(at); // PETSc ignores it
    }
    check(MatSetValuesLocal(assembly_.tangent(), 3, rows.data(), 3, rows.data(), block.data(), ADD_VALUES));
  });
  check(MatAssemblyBegin(assembly_.tangent(), MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(assembly_.tangent(), MAT_FINAL_ASSEMBLY));
}

void EquilibriumEquations::follow_tools(double from_time, const State& from, State& guess) const {
  if (!contact_) return;
  contact_->for_each_way_along(displacements(from), from_time, displacements(guess), step_->time,
                               [&](int node, const Vector3d& way) {
                                 for (int c = 0; c < 3; ++c)
                                   if (!discretisation_.is_held(discretisation_.unknown(index(3 * node + c))))
                                     guess[3 * node + c] += way[c];
                               });
}

std::vector<cases::ToolContact> EquilibriumEquations::tools_at(double time, const State& at) const {
  if (!contact_) return {};
  return contact_->found(displacements(at), time);
}

/// A force on a node between the vertices of the body's own mesh goes to these by the cell's shape functions,
/// as the elements' forces do.
std::vector<cases::ToolContact> AssembledBody::tools(const State& state, double load_factor) {
  if (!contact()) return {};
  const Nodes& nodes = discretisation.nodes;
  std::vector<std::size_t> place(nodes.point.size()); // where each node is among those of the cells
  for (std::size_t i = 0; i < nodes.of_cell.size(); ++i) place[index(nodes.of_cell[i])] = i;
  auto all = equations.tools_at(load_factor, state);
  for (cases::ToolContact& tool : all) {
    std::map<int, Vector3d> on_vertices;
    for (std::size_t n = 0; n < tool.nodes.size(); ++n) {
      const std::size_t at = place[index(tool.nodes[n])], per_cell = index(nodes.per_cell);
      const ElementPlace element =
          place_of(scene.mesh.shape, index(nodes.mesh_cell[at / per_cell]), scene.definition.fem.refine);
      const cases::ShapeValues shape = cases::shape_values(
          scene.mesh.shape, element.origin + element.axes * nodes.in_reference_cell[at % per_cell]);
      const cases::CellNodes vertices = scene.mesh.cells[element.cell];
      for (std::size_t v = 0; v < vertices.size(); ++v)
        on_vertices.try_emplace(vertices[v], Vector3d::Zero()).first->second += shape[v] * tool.on_nodes[n];
    }
    tool.nodes.clear();
    tool.on_nodes.clear();
    for (const auto& [node, force] : on_vertices) {
      tool.nodes.push_back(node);
      tool.on_nodes.push_back(force);
    }
  }
  return all;
}

} // namespace springproof::fem_reference
