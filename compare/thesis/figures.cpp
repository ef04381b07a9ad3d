#include "compare/thesis/figures.hpp"

#include "cases/case/read_case.hpp"
#include "compare/cube/write_design.hpp"
#include "compare/modes/modes.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"
#include "compare/write/gnuplot.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <map>
#include <nlohmann/json.hpp>

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
  cases::FaceNodes nodes; ///< around the face
  cases::Few<Eigen::Vector3d, 4> corners;
  Eigen::Vector3d normal() const { // across a quadrangle's diagonals
    return (corners[2] - corners[0]).cross(corners.back() - corners[1]).normalized();
  }
};

/// The surface's faces that look at the viewer, the farthest first.
/// @param displacement  empty: at rest
std::vector<Face> visible_faces(const cases::Mesh& mesh, const std::vector<Eigen::Vector3d>& displacement,
                                const Eigen::Matrix3d& view) {
  const Eigen::Vector3d towards = view.row(2);
  std::vector<Face> faces;
  for (const cases::FaceNodes& nodes : cases::boundary_faces(mesh)) {
    Face face{nodes, {}};
    for (const int node : nodes) {
      face.corners.push_back(mesh.nodes[node]);
      if (!displacement.empty()) face.corners.back() += displacement[node];
    }
    if (face.normal().dot(towards) > 0) faces.push_back(face);
  }
  const auto depth = [&](const Face& f) {
    double sum = 0;
    for (const Eigen::Vector3d& corner : f.corners) sum += towards.dot(corner);
    return sum; // faces of one mesh have as many corners
  };
  std::stable_sort(faces.begin(), faces.end(),
                   [&](const Face& a, const Face& b) { return depth(a) < depth(b); });
  return faces;
}

using Line = std::vector<Eigen::Vector3d>;

std::vector<Line> closed_polygons(const std::vector<Face>& faces) {
  std::vector<Line> polygons;
  for (const auto& [nodes, corners] : faces)
    polygons.emplace_back(corners.begin(), corners.end()).push_back(corners[0]);
  return polygons;
}

enum class Edges { all, sharp };

/// The faces' edges, each once; or those alone where the surface bends or ends.
std::vector<Line> edges_of(const std::vector<Face>& faces, Edges wanted) {
  struct Edge {
    Line line;
    Eigen::Vector3d normal; ///< normal of the first face that has it
    bool is_sharp = true;
  };
  std::map<std::pair<int, int>, Edge> edges;
  for (const Face& face : faces)
    for (std::size_t v = 0; v < face.nodes.size(); ++v) {
      const std::size_t next = (v + 1) % face.nodes.size();
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

/// A network's springs.  @param displacement  empty: at rest
std::vector<Line> lines_of(const cases::Mesh& mesh, const std::vector<Eigen::Vector3d>& displacement) {
  const auto at = [&](int node) -> Eigen::Vector3d {
    const Eigen::Vector3d rest = mesh.nodes[cases::index(node)];
    return displacement.empty() ? rest : rest + displacement[cases::index(node)];
  };
  std::vector<Line> lines;
  for (const auto& [a, b] : mesh.lines) lines.push_back({at(a), at(b)});
  return lines;
}

/// What is seen of a panel, by name. A side without displacements is empty.
std::vector<std::pair<std::string, std::vector<Line>>> blocks_of(const Overlay& panel,
                                                                 const Eigen::Matrix3d& view) {
  const auto seen = [&](const DeformedBody& body, const std::vector<Eigen::Vector3d>& displacement,
                        Edges wanted) {
    return body.mesh->lines.empty() ? edges_of(visible_faces(*body.mesh, displacement, view), wanted)
                                    : lines_of(*body.mesh, displacement);
  };
  std::vector<Line> fem, springs;
  if (panel.fem.is_there())
    fem = panel.fem.mesh->lines.empty()
              ? closed_polygons(visible_faces(*panel.fem.mesh, *panel.fem.displacement, view))
              : lines_of(*panel.fem.mesh, *panel.fem.displacement);
  if (panel.springs.is_there()) springs = seen(panel.springs, *panel.springs.displacement, Edges::all);
  return {{panel.title + " - finite elements", fem},
          {panel.title + " - springs", springs},
          {panel.title + " - at rest", seen(panel.springs, {}, Edges::sharp)}};
}

/// Decimals of coordinates: four, and more for a body smaller than 1 mm.
int decimals_of(const cases::Mesh& mesh) {
  const double size = cases::bounding_box(mesh.nodes).sizes().maxCoeff();
  return 4 + std::max(0, -static_cast<int>(std::floor(std::log10(size))));
}

/// The order of figures 4.15 and 5.9: a row per test, small loads left and large ones right.
constexpr CubeTest panel_order[] = {{"tensile", "small"}, {"tensile", "large"}, {"shear", "small"},
                                    {"shear", "large"},   {"torsion", "small"}, {"torsion", "large"}};

const Comparison* find_case(const std::vector<Comparison>& cases, const std::string& name) {
  for (const Comparison& comparison : cases)
    if (comparison.scene.definition.name == name) return &comparison;
  return nullptr;
}

/// The printed set for nu = 0.5.
msm::CellStiffness published_cell(const std::string& material) {
  const auto k = published_stiffness("nonlinear_method", material, 0.5);
  if (!k) throw cases::InputError("published/stiffness.csv: no nonlinear_method set for " + material);
  return {1e-3 * (*k)[0], 1e-3 * (*k)[1], 1e-3 * (*k)[2], 0};
}

/// Figures with their numbers, captions and commands, which are data.
void describe(const std::vector<std::string>& names, std::vector<Figure>& figures) {
  static const nlohmann::json all =
      nlohmann::json::parse(read_file(cases_folder() + "/published/figures.json"));
  for (const std::string& name : names) {
    const nlohmann::json& entry = all.at(name);
    figures.push_back({entry["number"], name, entry["caption"], entry["command"]});
  }
}

void draw_nonlinear_designs(const std::string& folder, std::vector<Figure>& figures) {
  msm::DesignRequest ogden, linear;
  ogden.material = cases::read_case(cases_folder() + "/thesis/ogden/cube_tensile_small.toml").material;
  linear.material = cases::LinearElastic{0.3, 0.5}; // eq. 5.13
  const msm::UniaxialCurve ogden_curve = msm::uniaxial_reference(ogden);
  const msm::UniaxialCurve linear_curve = msm::uniaxial_reference(linear);
  const msm::CellStiffness ogden_cell = published_cell("ogden");
  const msm::CellStiffness linear_cell = published_cell("linear_elastic");
  plot_uniaxial(folder, "figure_5_4", {0.05, 0.05, 0.05, 0}, 1, ogden_curve);
  plot_incompressible_family(folder);
  plot_uniaxial(folder, "figure_5_6", ogden_cell, 1, ogden_curve);
  plot_uniaxial(folder, "figure_5_7", linear_cell, 1, linear_curve);
  plot_contributions(folder, "figure_5_8",
                     {{"Ogden (14, 17, 63 N/m)", ogden_cell, 1, ogden_curve.axial_strain},
                      {"linear elastic (23, 43, 509 N/m)", linear_cell, 1, linear_curve.axial_strain}});
  describe({"figure_5_4", "figure_5_5", "figure_5_6", "figure_5_7", "figure_5_8"}, figures);
}

/// Appendix A groups the Poisson's ratios whose diagrams have the same pattern.
void draw_dot_diagrams(const std::string& folder, const ThesisResults& results,
                       std::vector<Figure>& figures) {
  const std::pair<const char*, std::vector<double>> groups[] = {
      {"4.11 / A.1", {0}},  {"A.2", {0.05, 0.1, 0.15}},
      {"A.3", {0.2, 0.25}}, {"A.4", {0.3}},
      {"A.5", {0.35}},      {"A.6", {0.4}},
      {"A.7", {0.45}},      {"A.8", {0.49}}};
  for (std::size_t g = 0; g < std::size(groups); ++g) {
    const auto& [number, ratios] = groups[g];
    std::vector<DotDiagram> panels;
    std::vector<std::string> commands;
    for (const CellAnalysis& cell : results.cells) // ascending, as the ratios
      for (const double nu : ratios)
        if (std::abs(cell.poissons_ratio - nu) < 1e-9) {
          panels.push_back({fmt::format("ν = {:.2f},", nu), &cell.spaces});
          commands.push_back(fmt::format("build/springproof eigen --poisson {:g} --out DIR", nu));
        }
    if (panels.empty()) continue;
    const std::string name = fmt::format("figure_A_{}", g + 1);
    plot_dot_diagrams(folder, name, panels);
    figures.push_back(
        {number, name,
         "Eigenvectors of both stiffness matrices of one cell, rigid motions first. Lines part the "
         "eigenspaces; a mark's size is what two spaces share. Squares on shaded blocks: equivalent spaces.",
         fmt::format("{}", fmt::join(commands, "; "))});
  }
}

void draw_cubes(const std::string& folder, const std::string& name, const std::vector<Comparison>& cases,
                const std::string& ending, std::vector<Figure>& figures) {
  std::vector<Overlay> panels;
  for (const auto& [test, load_set] : panel_order)
    if (const Comparison* cube = find_case(cases, fmt::format("cube-{}-{}{}", test, load_set, ending)))
      panels.push_back(overlay_of(*cube, fmt::format("{}, {} load", test, load_set)));
  if (panels.empty()) return;
  plot_bodies(folder, name, panels, 2);
  describe({name}, figures);
}

/// Figure 5.10: box plots of the springs' cells' volumes, one for each cube that has them, and the outliers.
void draw_volumes(const std::string& folder, const std::vector<CaseVolumes>& all,
                  std::vector<Figure>& figures) {
  std::vector<std::string> labels; // two words, which stand below each other
  std::vector<const CaseVolumes*> drawn;
  for (const auto& [test, load_set] : panel_order)
    for (const CaseVolumes& of_case : all)
      if (of_case.name == fmt::format("cube-{}-{}-ogden", test, load_set) && of_case.msm) {
        labels.push_back(fmt::format("{} {}", test, load_set));
        drawn.push_back(&of_case);
      }
  if (drawn.empty()) return;
  write_csv_file(folder + "/figure_5_10.csv", [&](CsvWriter& csv) {
    csv.row("# position", "case", "lower_whisker", "lower_quartile", "median", "upper_quartile",
            "upper_whisker (mm3)");
    for (std::size_t c = 0; c < drawn.size(); ++c) {
      const BoxPlot& b = drawn[c]->msm->per_cell;
      csv.row(c + 1, drawn[c]->name, b.lower_whisker, b.lower_quartile, b.median, b.upper_quartile,
              b.upper_whisker);
    }
    csv.end_block();
    csv.row("# position", "volume (mm3) of an outlier");
    for (std::size_t c = 0; c < drawn.size(); ++c)
      for (const double volume : drawn[c]->msm->per_cell.outliers) csv.row(c + 1, volume);
  });
  const double rest = drawn.back()->rest_per_cell;
  draw(folder, "figure_5_10", "volumes", {{"labels", labels}, {"rest", rest}, {"width", 900.}});
  describe({"figure_5_10"}, figures);
}

void draw_bars(const std::string& folder, const ThesisResults& results, std::vector<Figure>& figures) {
  std::vector<Overlay> panels;
  for (const char* cells : {"1x1x4", "2x2x8", "4x4x16"})
    if (const Comparison* bar = find_case(results.cases, fmt::format("bar-{}-ogden", cells)))
      panels.push_back(thesis_overlay(results, *bar, fmt::format("springs {}", cells)));
  if (panels.empty()) return;
  plot_bodies(folder, "figure_5_12", panels, 3);
  describe({"figure_5_12"}, figures);
}

} // namespace

Overlay overlay_of(const Comparison& comparison, const std::string& title) {
  const cases::Mesh* mesh = &comparison.scene.mesh;
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

Overlay thesis_overlay(const ThesisResults& results, const Comparison& comparison, const std::string& title) {
  Overlay overlay = overlay_of(comparison, title);
  const Comparison* finest = find_case(results.cases, "bar-4x4x16-ogden");
  if (finest && comparison.scene.definition.name.rfind("bar-", 0) == 0)
    overlay.fem = overlay_of(*finest, "").fem;
  return overlay;
}

std::vector<Figure> draw_figures(const std::string& folder, const ThesisResults& results) {
  std::vector<Figure> figures;
  plot_linear_method(folder, cases::Element::q1);
  describe({"figure_4_6", "figure_4_7", "figure_4_8"}, figures);
  draw_dot_diagrams(folder, results, figures);
  draw_nonlinear_designs(folder, figures);
  draw_cubes(folder, "figure_4_15", results.figure_4_15, "", figures);
  draw_cubes(folder, "figure_5_9", results.cases, "-ogden", figures);
  draw_volumes(folder, results.volumes, figures);
  draw_bars(folder, results, figures);
  return figures;
}

} // namespace springproof::compare
