// Writes CalculiX's input files.
#include "compare/peers/calculix.hpp"

#include "cases/case/elements.hpp"
#include "cases/scene/loads.hpp"
#include "cases/scene/tools.hpp"
#include "compare/peers/calculix_tool.hpp"
#include "mechanics/contact/contact.hpp"

#include <fmt/ostream.h>
#include <limits>
#include <map>
#include <set>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

/// Fields of CalculiX's input are 20 characters wide at most.
std::string number(double value) {
  return fmt::format("{:.12e}", value);
}

/// A node's number and place, as a line of the input.
void write_node(std::ostream& out, std::size_t number_of_node, const Vector3d& x) {
  fmt::print(out, "{}, {}, {}, {}\n", number_of_node, number(x[0]), number(x[1]), number(x[2]));
}

void write_nodes(std::ostream& out, const cases::Mesh& mesh) {
  fmt::print(out, "*NODE, NSET=NALL\n");
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) write_node(out, n + 1, mesh.nodes[n]);
}

void write_cells(std::ostream& out, const char* type, const std::vector<std::vector<int>>& nodes_of_cells) {
  fmt::print(out, "*ELEMENT, TYPE={}, ELSET=EALL\n", type);
  for (std::size_t c = 0; c < nodes_of_cells.size(); ++c) {
    fmt::print(out, "{}", c + 1);
    for (const int node : nodes_of_cells[c]) fmt::print(out, ", {}", node + 1);
    fmt::print(out, "\n");
  }
}

/// Nodes of cells of degree 1 in CalculiX's order: C3D8 and C3D4.
std::vector<std::vector<int>> linear_cells(const cases::Mesh& mesh) {
  std::vector<std::vector<int>> cells;
  for (const cases::CellNodes& vertices : mesh.cells) {
    std::vector<int>& nodes = cells.emplace_back();
    for (std::size_t v = 0; v < vertices.size(); ++v)
      nodes.push_back(vertices[mesh.shape == cases::CellShape::tetrahedron ? v : cases::around_cell[v]]);
  }
  return cells;
}

using Edge = std::set<int>; ///< by its two vertices

/// The nodes in the middle of a mesh's edges.  @param halved  the same mesh, refined once
std::map<Edge, int> middles_of_edges(const cases::Mesh& mesh, const cases::Mesh& halved) {
  std::map<Edge, int> middles;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t child = 0; child < 8; ++child)
      for (std::size_t v = 0; v < 4; ++v) {
        const auto& [a, b] = cases::tetrahedron_children[child][v];
        const cases::CellNodes vertices = mesh.cells[c];
        middles[{vertices[cases::index(a)], vertices[cases::index(b)]}] = halved.cells[8 * c + child][v];
      }
  return middles;
}

/// Nodes of C3D10: the vertices, and the middles of these edges.
std::vector<std::vector<int>> quadratic_cells(const cases::Mesh& mesh, const std::map<Edge, int>& middles) {
  std::vector<std::vector<int>> cells = linear_cells(mesh);
  for (std::vector<int>& nodes : cells)
    for (const auto& [a, b] : {std::pair(0, 1), {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}})
      nodes.push_back(middles.at({nodes[cases::index(a)], nodes[cases::index(b)]}));
  return cells;
}

bool is_quadratic(const cases::Scene& scene) {
  return cases::facts_of(scene.definition.fem.element).degree == 2;
}

/// Mesh, material and supports; a material of a density too, which static steps take no notice of.
void write_model(std::ostream& out, const cases::Scene& scene) {
  const auto& material = std::get<cases::LinearElastic>(scene.definition.material);
  // The case's name could be a card of CalculiX's.
  fmt::print(out, "*HEADING\nspringproof\n");
  const cases::Scene halved = cases::refine(scene, is_quadratic(scene) ? 1 : 0);
  write_nodes(out, halved.mesh);
  if (is_quadratic(scene))
    write_cells(out, "C3D10", quadratic_cells(scene.mesh, middles_of_edges(scene.mesh, halved.mesh)));
  else
    write_cells(out, scene.mesh.shape == cases::CellShape::tetrahedron ? "C3D4" : "C3D8",
                linear_cells(scene.mesh));
  fmt::print(out, "*MATERIAL, NAME=TISSUE\n*ELASTIC\n{}, {}\n",
             number(calculix_force_unit * material.youngs_modulus), number(material.poissons_ratio));
  if (const double density = cases::dynamics_of(scene, 0).density; density > 0)
    fmt::print(out, "*DENSITY\n{}\n", number(calculix_force_unit * density));
  fmt::print(out, "*SOLID SECTION, ELSET=EALL, MATERIAL=TISSUE\n");
  fmt::print(out, "*BOUNDARY\n");
  const std::vector<bool> constrained = cases::constrained_dofs(halved);
  for (std::size_t d = 0; d < constrained.size(); ++d)
    if (constrained[d]) fmt::print(out, "{0}, {1}, {1}\n", d / 3 + 1, d % 3 + 1);
}

/// Tractions and torques on the nodes of quadratic triangles, N.
/// @param halved  the scene's mesh, refined once
std::vector<Vector3d> forces_on_quadratic_faces(const cases::Scene& scene, const cases::Mesh& halved) {
  const std::map<Edge, int> middles = middles_of_edges(scene.mesh, halved);
  std::vector<Vector3d> forces =
      cases::on_all_nodes(cases::nodes_with_point_forces(scene), halved.nodes.size());
  for (const auto& applied : scene.loads) {
    const auto traction = cases::surface_traction(scene.mesh, applied);
    if (!traction) continue;
    for (const cases::FaceNodes& face : applied.selection.faces) {
      const auto at = [&](std::size_t v) { return scene.mesh.nodes[cases::index(face[v])]; };
      // the unit square, one side of which is a vertex of the triangle
      for (const cases::FacePoint& point : cases::gauss_points({at(0), at(1), at(2), at(2)}, 4)) {
        const std::array<double, 3> share{(1 - point.s) * (1 - point.t), point.s * (1 - point.t), point.t};
        const Vector3d force = point.area * traction(point.at);
        for (std::size_t v = 0; v < 3; ++v) {
          const std::size_t next = (v + 1) % 3;
          forces[cases::index(face[v])] += share[v] * (2 * share[v] - 1) * force;
          forces[cases::index(middles.at({face[v], face[next]}))] += 4 * share[v] * share[next] * force;
        }
      }
    }
  }
  return forces;
}

void write_forces(std::ostream& out, const cases::Scene& scene) {
  const std::vector<Vector3d> forces = is_quadratic(scene)
                                           ? forces_on_quadratic_faces(scene, cases::refine(scene, 1).mesh)
                                           : cases::nodal_forces(scene);
  for (std::size_t n = 0; n < forces.size(); ++n)
    for (int a = 0; a < 3; ++a)
      if (forces[n][a] != 0)
        fmt::print(out, "{}, {}, {}\n", n + 1, a + 1, number(calculix_force_unit * forces[n][a]));
}

/// Sides of linear cells by their vertices' places in the cell, in CalculiX's order: S1, S2 ...
std::vector<std::vector<std::size_t>> sides_of_cells(cases::CellShape shape) {
  if (shape == cases::CellShape::tetrahedron) return {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  return {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
}

/// The surface that a tool may touch, by cells and their sides.
void write_touched_surface(std::ostream& out, const cases::Scene& scene, const cases::Tool& tool) {
  std::set<std::set<int>> touched;
  for (const cases::FaceNodes& face : cases::touched_faces(scene, tool))
    touched.emplace(face.begin(), face.end());
  const auto sides = sides_of_cells(scene.mesh.shape);
  const auto cells = linear_cells(scene.mesh);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t s = 0; s < sides.size(); ++s) {
      std::set<int> side;
      for (const std::size_t v : sides[s]) side.insert(cells[c][v]);
      if (touched.count(side) > 0) fmt::print(out, "{}, S{}\n", c + 1, s + 1);
    }
}

/// Penalty of a contact, MPa/mm: that of a motion, which nothing corrects either.
double contact_penalty(const cases::Scene& scene, const cases::Tool& tool) {
  constexpr double over_that_at_rest = 10;
  double smallest = std::numeric_limits<double>::infinity(); // a side's square
  for (const cases::FaceNodes& face : cases::touched_faces(scene, tool))
    for (const auto& [a, b] : cases::sides_of(face))
      smallest = std::min(
          smallest, (scene.mesh.nodes[cases::index(a)] - scene.mesh.nodes[cases::index(b)]).squaredNorm());
  return over_that_at_rest *
         mechanics::Contact::penalty(mechanics::contact_modulus(scene), std::sqrt(smallest));
}

/// Tools after the body, and which surfaces they meet without friction.
void write_tools(std::ostream& out, const cases::Scene& scene) {
  std::size_t node = scene.mesh.nodes.size() + 1, cell = scene.mesh.cells.size() + 1;
  for (std::size_t t = 0; t < scene.definition.tools.size(); ++t) {
    const cases::Tool& tool = scene.definition.tools[t];
    const ToolMesh mesh = mesh_of_tool(scene, tool);
    if (mesh.cells.empty()) continue;
    const std::size_t first = node, first_cell = cell;
    fmt::print(out, "*NODE, NSET=NTOOL{}\n", t);
    for (const Vector3d& place : mesh.nodes) write_node(out, node++, place);
    fmt::print(out, "*ELEMENT, TYPE=C3D8, ELSET=ETOOL{}\n", t);
    for (const auto& vertices : mesh.cells) {
      fmt::print(out, "{}", cell++);
      for (const int vertex : vertices) fmt::print(out, ", {}", first + cases::index(vertex));
      fmt::print(out, "\n");
    }
    fmt::print(out, "*SOLID SECTION, ELSET=ETOOL{}, MATERIAL=TISSUE\n*SURFACE, NAME=BODY{}\n", t, t);
    write_touched_surface(out, scene, tool);
    fmt::print(out, "*SURFACE, NAME=TOOL{}\n", t);
    for (std::size_t c = first_cell; c < cell; ++c) fmt::print(out, "{}, S1\n", c);
    const double stress_unit = calculix_force_unit * mechanics::contact_modulus(scene);
    fmt::print(
        out,
        "*SURFACE INTERACTION, NAME=CONTACT{}\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{}, {}\n"
        "*CONTACT PAIR, INTERACTION=CONTACT{}, TYPE=NODE TO SURFACE\nBODY{}, TOOL{}\n",
        t, number(calculix_force_unit * contact_penalty(scene, tool)), number(1e-5 * stress_unit), t, t, t);
  }
}

/// Where tools go in a step, and the forces on their nodes.
void write_ways_of_tools(std::ostream& out, const cases::Scene& scene) {
  for (std::size_t t = 0; t < scene.definition.tools.size(); ++t) {
    if (mesh_of_tool(scene, scene.definition.tools[t]).cells.empty()) continue;
    fmt::print(out, "*BOUNDARY\n");
    const Vector3d& way = scene.definition.tools[t].displacement;
    for (int a = 0; a < 3; ++a) fmt::print(out, "NTOOL{0}, {1}, {1}, {2}\n", t, a + 1, number(way[a]));
    fmt::print(out, "*NODE PRINT, NSET=NTOOL{}, FREQUENCY=100000\nRF\n", t);
  }
}

} // namespace

void write_calculix_motion_input(std::ostream& out, const cases::Scene& scene) {
  const cases::Dynamics& dynamics = *scene.definition.dynamics;
  write_model(out, scene);
  for (std::size_t l = 0; l < scene.loads.size(); ++l) {
    const cases::History& history = scene.loads[l].load.history;
    fmt::print(out, "*AMPLITUDE, NAME=LOAD{}\n", l);
    if (history.points.empty()) fmt::print(out, "0., 1.\n{}, 1.\n", number(dynamics.end));
    for (const auto& [time, factor] : history.points)
      fmt::print(out, "{}, {}\n", number(time), number(factor));
  }
  fmt::print(out, "*STEP, INC={}\n*DYNAMIC, DIRECT, ALPHA=0.\n{}, {}\n", 10 * dynamics.n_steps(),
             number(dynamics.step), number(dynamics.end));
  cases::Scene alone = scene;
  for (std::size_t l = 0; l < scene.loads.size(); ++l) {
    alone.loads = {scene.loads[l]};
    fmt::print(out, "*CLOAD, AMPLITUDE=LOAD{}\n", l);
    write_forces(out, alone);
  }
  fmt::print(out, "*NODE PRINT, NSET=NALL, FREQUENCY=1\nU\n*END STEP\n");
}

void write_calculix_input(std::ostream& out, const cases::Scene& scene) {
  const bool is_nonlinear = scene.definition.fem.formulation == cases::Formulation::saint_venant_kirchhoff;
  const std::vector<cases::Tool>& tools = scene.definition.tools;
  write_model(out, scene);
  write_tools(out, scene);
  fmt::print(out, "*STEP{}, INC=1000\n", is_nonlinear ? ", NLGEOM" : "");
  // Newton's method starts with the full load (CalculiX halves it when it must), with tools with the steps
  // that they ask for, and goes on until residual and correction are 1e-8 of what they are measured against:
  // its default, half a per cent, is far above the digits it prints.
  if (is_nonlinear || !tools.empty())
    fmt::print(out, "*CONTROLS, PARAMETERS=FIELD\n1e-8, 1e-8, , , 1e-8, 1e-8\n");
  int n_steps = tools.empty() ? 1 : 2;
  for (const cases::Tool& tool : tools) n_steps = std::max(n_steps, tool.steps);
  fmt::print(out, "*STATIC\n{}, 1.\n", number(1. / n_steps));
  fmt::print(out, "*CLOAD\n");
  write_forces(out, scene);
  write_ways_of_tools(out, scene);
  fmt::print(out, "*NODE PRINT, NSET=NALL, FREQUENCY=100000\nU\n*END STEP\n");
}

} // namespace springproof::compare
