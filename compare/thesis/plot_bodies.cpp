#include "compare/thesis/plot_bodies.hpp"

#include "compare/provenance/whole_file.hpp"
#include "compare/write/gnuplot.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/ostream.h>
#include <map>

namespace springproof::compare {

namespace {

/// Parallel projection: the rows point across, up and towards a viewer in front of the body (small y), a
/// little to its right and above. Orthonormal.
Eigen::Matrix3d oblique_view() {
  constexpr double azimuth = 0.55, elevation = 0.35; // radians
  const double s = std::sin(azimuth), c = std::cos(azimuth);
  const Eigen::Vector3d across(c, s, 0);
  const Eigen::Vector3d towards(s * std::cos(elevation), -c * std::cos(elevation), std::sin(elevation));
  Eigen::Matrix3d view;
  view << across.transpose(), towards.cross(across).transpose(), towards.transpose();
  return view;
}

struct Face {
  std::array<int, 4> nodes; ///< around the face
  std::array<Eigen::Vector3d, 4> corners;
  Eigen::Vector3d normal() const {
    return (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalized();
  }
};

/// The surface's faces that look at the viewer, the farthest first.
/// @param displacement  empty: at rest
std::vector<Face> visible_faces(const cases::HexMesh& mesh, const std::vector<Eigen::Vector3d>& displacement,
                                const Eigen::Matrix3d& view) {
  const Eigen::Vector3d towards = view.row(2);
  std::vector<Face> faces;
  for (const std::array<int, 4>& nodes : cases::boundary_faces(mesh)) {
    Face face{nodes, {}};
    for (std::size_t v = 0; v < 4; ++v) {
      face.corners[v] = mesh.nodes[nodes[v]];
      if (!displacement.empty()) face.corners[v] += displacement[nodes[v]];
    }
    if (face.normal().dot(towards) > 0) faces.push_back(face);
  }
  const auto depth = [&](const Face& f) {
    return towards.dot(f.corners[0] + f.corners[1] + f.corners[2] + f.corners[3]);
  };
  std::stable_sort(faces.begin(), faces.end(),
                   [&](const Face& a, const Face& b) { return depth(a) < depth(b); });
  return faces;
}

using Line = std::vector<Eigen::Vector3d>;

std::vector<Line> closed_polygons(const std::vector<Face>& faces) {
  std::vector<Line> polygons;
  for (const auto& [nodes, corners] : faces)
    polygons.push_back({corners[0], corners[1], corners[2], corners[3], corners[0]});
  return polygons;
}

enum class Edges { all, sharp };

/// The faces' edges, each once; or those alone where the surface bends or ends.
std::vector<Line> edges_of(const std::vector<Face>& faces, Edges wanted) {
  struct Edge {
    Line line;
    Eigen::Vector3d normal; ///< of the first face that has it
    bool is_sharp = true;
  };
  std::map<std::pair<int, int>, Edge> edges;
  for (const Face& face : faces)
    for (std::size_t v = 0; v < 4; ++v) {
      const std::size_t next = (v + 1) % 4;
      const auto [edge, is_new] =
          edges.try_emplace(std::minmax(face.nodes[v], face.nodes[next]),
                            Edge{{face.corners[v], face.corners[next]}, face.normal()});
      if (!is_new) edge->second.is_sharp = edge->second.normal.dot(face.normal()) < 0.9;
    }
  std::vector<Line> lines;
  for (const auto& [nodes, edge] : edges)
    if (wanted == Edges::all || edge.is_sharp) lines.push_back(edge.line);
  return lines;
}

/// What is seen of a panel, by name. A side without displacements is empty.
std::vector<std::pair<std::string, std::vector<Line>>> blocks_of(const Overlay& panel,
                                                                 const Eigen::Matrix3d& view) {
  std::vector<Line> fem, springs;
  if (panel.fem.is_there())
    fem = closed_polygons(visible_faces(*panel.fem.mesh, *panel.fem.displacement, view));
  if (panel.springs.is_there())
    springs = edges_of(visible_faces(*panel.springs.mesh, *panel.springs.displacement, view), Edges::all);
  return {{panel.title + " - finite elements", fem},
          {panel.title + " - springs", springs},
          {panel.title + " - at rest", edges_of(visible_faces(*panel.springs.mesh, {}, view), Edges::sharp)}};
}

/// Of coordinates: four, and more for a body smaller than 1 mm.
int decimals_of(const cases::HexMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : mesh.nodes) box.extend(x);
  return 4 + std::max(0, -static_cast<int>(std::floor(std::log10(box.sizes().maxCoeff()))));
}

} // namespace

Overlay overlay_of(const Comparison& comparison, const std::string& title) {
  const cases::HexMesh* mesh = &comparison.scene.mesh;
  return {title,
          {mesh, &comparison.answers.fem.solution.displacement},
          {mesh, &comparison.answers.msm.solution.displacement}};
}

void plot_bodies(const std::string& folder, const std::string& name, const std::vector<Overlay>& panels,
                 int columns, int size) {
  const Eigen::Matrix3d view = oblique_view();
  const int n_decimals = decimals_of(*panels.front().fem.mesh);
  Eigen::AlignedBox2d box; // holds all panels, so that they have one scale
  std::vector<std::string> titles;
  write_file(folder + "/" + name + ".csv", [&](std::ostream& out) {
    for (const Overlay& panel : panels) {
      titles.push_back(panel.title);
      for (const auto& [block, lines] : blocks_of(panel, view)) {
        fmt::print(out, "# {}: x,y,z,across,up (mm)\n", block);
        for (const Line& line : lines) { // with a blank line after each
          for (const Eigen::Vector3d& x : line) {
            const Eigen::Vector2d seen = view.topRows<2>() * x;
            box.extend(seen);
            fmt::print(out, "{1:.{0}f},{2:.{0}f},{3:.{0}f},{4:.{0}f},{5:.{0}f}\n", n_decimals, x.x(), x.y(),
                       x.z(), seen.x(), seen.y());
          }
          fmt::print(out, "\n");
        }
        if (lines.empty()) fmt::print(out, "?,?,?,?,?\n\n"); // an empty block would not be counted
        fmt::print(out, "\n");
      }
    }
  });
  const double margin = 0.03 * box.sizes().maxCoeff();
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  draw(folder, name, "bodies",
       {{"titles", titles},
        {"rows", 1. * rows},
        {"columns", 1. * columns},
        {"width", 1. * size * columns},
        {"height", 1. * size * rows + 90},
        {"left", box.min().x() - margin},
        {"right", box.max().x() + margin},
        {"bottom", box.min().y() - margin},
        {"top", box.max().y() + margin}});
}

} // namespace springproof::compare
