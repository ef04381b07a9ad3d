#include "compare/thesis/plot_bodies.hpp"

#include "compare/provenance/whole_file.hpp"
#include "compare/write/gnuplot.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <map>

namespace springproof::compare {

namespace {

/// Parallel projection towards a viewer in front of the body (small y), a little to its right and above.
struct View {
  Eigen::Vector3d across, up, towards; ///< orthonormal; towards the viewer
  View() {
    constexpr double azimuth = 0.55, elevation = 0.35; // radians
    const double s = std::sin(azimuth), c = std::cos(azimuth);
    across = {c, s, 0};
    towards = {s * std::cos(elevation), -c * std::cos(elevation), std::sin(elevation)};
    up = towards.cross(across);
  }
};

struct Face {
  std::array<int, 4> nodes; ///< around the face
  std::array<Eigen::Vector3d, 4> corners;
  Eigen::Vector3d normal() const {
    return (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalized();
  }
};

/// The surface's faces that look at the viewer, the farthest first.
std::vector<Face> visible_faces(const DeformedBody& body, const View& view) {
  std::vector<Face> faces;
  for (const std::array<int, 4>& nodes : cases::boundary_faces(*body.mesh)) {
    Face face{nodes, {}};
    for (std::size_t v = 0; v < 4; ++v) {
      const auto node = static_cast<std::size_t>(nodes[v]);
      face.corners[v] = body.mesh->nodes[node];
      if (body.is_there()) face.corners[v] += (*body.displacement)[node];
    }
    if (face.normal().dot(view.towards) > 0) faces.push_back(face);
  }
  const auto depth = [&](const Face& f) {
    return view.towards.dot(f.corners[0] + f.corners[1] + f.corners[2] + f.corners[3]);
  };
  std::stable_sort(faces.begin(), faces.end(),
                   [&](const Face& a, const Face& b) { return depth(a) < depth(b); });
  return faces;
}

using Line = std::vector<Eigen::Vector3d>;

std::vector<Line> closed_polygons(const std::vector<Face>& faces) {
  std::vector<Line> polygons;
  for (const Face& face : faces) {
    polygons.emplace_back(face.corners.begin(), face.corners.end());
    polygons.back().push_back(face.corners.front());
  }
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

/// One block of the data file: lines, a blank line after each.
void write_block(std::ostream& out, const std::string& panel, const char* what,
                 const std::vector<Line>& lines, const View& view) {
  fmt::print(out, "# {} - {}: x,y,z,across,up (mm)\n", panel, what);
  for (const Line& line : lines) {
    for (const Eigen::Vector3d& point : line)
      fmt::print(out, "{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", point.x(), point.y(), point.z(),
                 point.dot(view.across), point.dot(view.up));
    fmt::print(out, "\n");
  }
  if (lines.empty()) fmt::print(out, "?,?,?,?,?\n\n"); // an empty block would not be counted
  fmt::print(out, "\n");
}

/// What is seen of one panel.
struct Drawing {
  std::string title;
  std::vector<Line> fem, springs, rest;
};

Drawing drawing_of(const Overlay& overlay, const View& view) {
  static const std::vector<Eigen::Vector3d> at_rest;
  Drawing drawing{
      overlay.title, {}, {}, edges_of(visible_faces({overlay.springs.mesh, &at_rest}, view), Edges::sharp)};
  if (overlay.fem.is_there()) drawing.fem = closed_polygons(visible_faces(overlay.fem, view));
  if (overlay.springs.is_there())
    drawing.springs = edges_of(visible_faces(overlay.springs, view), Edges::all);
  return drawing;
}

/// The window that holds all panels, so that they have one scale.
Eigen::AlignedBox2d window(const std::vector<Drawing>& drawings, const View& view) {
  Eigen::AlignedBox2d box;
  for (const Drawing& drawing : drawings)
    for (const std::vector<Line>* lines : {&drawing.fem, &drawing.springs, &drawing.rest})
      for (const Line& line : *lines)
        for (const Eigen::Vector3d& point : line)
          box.extend(Eigen::Vector2d(point.dot(view.across), point.dot(view.up)));
  return box;
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
  const View view;
  std::vector<Drawing> drawings;
  for (const Overlay& panel : panels) drawings.push_back(drawing_of(panel, view));
  write_file(folder + "/" + name + ".csv", [&](std::ostream& out) {
    for (const Drawing& drawing : drawings) {
      write_block(out, drawing.title, "finite elements", drawing.fem, view);
      write_block(out, drawing.title, "springs", drawing.springs, view);
      write_block(out, drawing.title, "at rest", drawing.rest, view);
    }
  });

  std::vector<std::string> titles;
  for (const Drawing& drawing : drawings) titles.push_back(drawing.title);
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  const Eigen::AlignedBox2d box = window(drawings, view);
  draw(folder, name, "bodies",
       {{"titles", titles},
        {"rows", 1. * rows},
        {"columns", 1. * columns},
        {"width", 1. * size * columns},
        {"height", 1. * size * rows + 90},
        {"left", box.min().x() - 0.5},
        {"right", box.max().x() + 0.5},
        {"bottom", box.min().y() - 0.5},
        {"top", box.max().y() + 0.5}});
}

} // namespace springproof::compare
