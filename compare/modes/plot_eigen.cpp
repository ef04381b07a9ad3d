#include "compare/write/gnuplot.hpp"
#include "compare/write/whole_file.hpp"
#include "compare/write/write.hpp"
#include "compare/write/write_eigen.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

bool is_equivalent(const EigenspaceAnalysis& analysis, std::size_t fem, std::size_t msm) {
  for (const Equivalence& e : analysis.equivalent)
    if (e.fem_space == static_cast<int>(fem) && e.msm_space == static_cast<int>(msm)) return true;
  return false;
}

/// A dot for every pair of eigenvectors whose spaces are not orthogonal. Its size is the spaces' coupling,
/// not the vectors' projection, which depends on the basis that the solver happened to return.
void write_dots(std::ostream& out, const EigenspaceAnalysis& analysis) {
  fmt::print(out, "# msm_vector,fem_vector,size,equivalent\n");
  for (std::size_t i = 0; i < analysis.fem_spaces.size(); ++i)
    for (std::size_t j = 0; j < analysis.msm_spaces.size(); ++j) {
      const Eigenspace &fem = analysis.fem_spaces[i], &msm = analysis.msm_spaces[j];
      const double share = analysis.coupling(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (share < 1e-12) continue; // orthogonal: the square of round-off is left
      for (int a = 0; a < fem.dimension; ++a)
        for (int b = 0; b < msm.dimension; ++b)
          fmt::print(out, "{},{},{:.6f},{}\n", msm.offset + b + 1, fem.offset + a + 1, 0.4 + std::sqrt(share),
                     is_equivalent(analysis, i, j) ? 1 : 0);
    }
}

/// One panel: lines between the eigenspaces of both cells, blocks of equivalent ones shaded, and the dots.
/// @param block  of the data file that holds the panel's dots
std::string dot_panel(const EigenspaceAnalysis& analysis, const std::string& title, const std::string& data,
                      std::size_t block) {
  std::string script =
      fmt::format("unset arrow\nunset object\nset title '{} h = {:.2f}'\n", title, analysis.h);
  for (const Eigenspace& space : analysis.msm_spaces)
    script += fmt::format("set arrow from {0},0.5 to {0},24.5 nohead lc rgb '#999999'\n", space.offset + 0.5);
  for (const Eigenspace& space : analysis.fem_spaces)
    script += fmt::format("set arrow from 0.5,{0} to 24.5,{0} nohead lc rgb '#999999'\n", space.offset + 0.5);
  for (const Equivalence& e : analysis.equivalent) {
    const Eigenspace &fem = analysis.fem_spaces[static_cast<std::size_t>(e.fem_space)],
                     &msm = analysis.msm_spaces[static_cast<std::size_t>(e.msm_space)];
    script +=
        fmt::format("set object rectangle from {},{} to {},{} fc rgb '#f5d3bd' fs solid noborder behind\n",
                    msm.offset + 0.5, fem.offset + 0.5, msm.offset + msm.dimension + 0.5,
                    fem.offset + fem.dimension + 0.5);
  }
  return script +
         fmt::format("plot '{0}' index {1} using 1:($4 > 0 ? 1/0 : $2):3 with points pt 7 ps variable lt 1, "
                     "'' index {1} using 1:($4 > 0 ? $2 : 1/0):3 with points pt 5 ps variable lt 2\n",
                     data, block);
}

std::vector<Eigen::Vector3d> as_points(const Eigen::VectorXd& vector) {
  std::vector<Eigen::Vector3d> points;
  for (Eigen::Index n = 0; n < vector.size() / 3; ++n) points.emplace_back(vector.segment<3>(3 * n));
  return points;
}

cases::HexMesh cell_mesh(const msm::CellVertices& vertices) {
  cases::HexMesh mesh;
  mesh.nodes.assign(vertices.begin(), vertices.end());
  mesh.cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
  return mesh;
}

/// The 12 edges as separate lines: rest position and displaced one.
void write_edges(std::ostream& out, const msm::CellVertices& rest, const Eigen::VectorXd& mode) {
  const double size = 0.35 * (rest[7] - rest[0]).norm() / mode.cwiseAbs().maxCoeff() / 2;
  for (const auto& edge : cases::cell_edges) {
    for (const int v : edge) {
      const Eigen::Vector3d x = rest[static_cast<std::size_t>(v)], y = x + size * mode.segment<3>(3 * v);
      fmt::print(out, "{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", x.x(), x.y(), x.z(), y.x(), y.y(),
                 y.z());
    }
    fmt::print(out, "\n\n");
  }
}

/// One picture for every deforming eigenspace, of its first canonical vector, with the eigenspace's number in
/// brackets.
void write_mode_sheet(const std::string& folder, const std::string& name, const Spectrum& spectrum,
                      const std::vector<Eigenspace>& spaces, const msm::CellVertices& rest) {
  std::vector<cases::PointField> fields;
  std::string script =
      "unset border\nunset tics\nunset key\nunset grid\nset view 65,25\nset view equal xyz\n";
  const int n_pictures = static_cast<int>(spaces.size()) - 1;
  script += fmt::format("set multiplot layout {},3\n", (n_pictures + 2) / 3);
  for (std::size_t s = 0; s < spaces.size(); ++s) {
    const Eigen::MatrixXd shapes = canonical_basis(basis(spectrum, spaces[s]));
    for (Eigen::Index c = 0; c < shapes.cols(); ++c)
      fields.push_back({fmt::format("space {} vector {}", s + 1, c + 1), as_points(shapes.col(c))});
    if (s == 0) continue; // rigid motions
    const std::string data = fmt::format("{}_{}.csv", name, s + 1);
    write_file(folder + "/" + data, [&](std::ostream& out) { write_edges(out, rest, shapes.col(0)); });
    script += fmt::format(
        "set title '({}) {:.3g}, dimension {}'\nsplot '{}' using 1:2:3 with lines lt 8 lw 1 dt solid, "
        "'' using 4:5:6 with lines lt 2 dt solid\n",
        s + 1, spaces[s].eigenvalue, spaces[s].dimension, data);
  }
  draw(folder, name, script + "unset multiplot\n", 900, 300 * ((n_pictures + 2) / 3));
  write_file(folder + "/" + name + ".vtu",
             [&](std::ostream& out) { write_vtu(out, cell_mesh(rest), fields); });
}

} // namespace

void plot_dot_diagrams(const std::string& folder, const std::string& name,
                       const std::vector<DotDiagram>& panels) {
  const int n = static_cast<int>(panels.size());
  std::string script = fmt::format(
      "set multiplot layout 1,{}\nset border 15\nunset grid\nset size square\nset xrange [0.5:24.5]\n"
      "set yrange [24.5:0.5]\nset xtics 4\nset ytics 4\nunset key\n"
      "set xlabel 'eigenvectors of the mass-spring cell'\n"
      "set ylabel 'eigenvectors of the finite element'\n",
      n);
  for (std::size_t p = 0; p < panels.size(); ++p)
    script += dot_panel(*panels[p].analysis, panels[p].title, name + ".csv", p);
  write_file(folder + "/" + name + ".csv", [&](std::ostream& out) {
    for (std::size_t p = 0; p < panels.size(); ++p) {
      if (p > 0) fmt::print(out, "\n\n"); // gnuplot's mark of a new block
      write_dots(out, *panels[p].analysis);
    }
  });
  draw(folder, name, script + "unset multiplot\n", 100 + 500 * n, 580);
}

void write_eigenspaces_files(const std::string& folder, const EigenspaceAnalysis& analysis,
                             const msm::CellVertices& vertices) {
  plot_dot_diagrams(folder, "dot_diagram", {{"", &analysis}});
  write_file(folder + "/coupling.csv", [&](std::ostream& out) {
    const Eigen::IOFormat csv(8, Eigen::DontAlignCols, ",", "\n");
    out << analysis.coupling.format(csv) << '\n';
  });
  write_mode_sheet(folder, "fem_modes", analysis.fem, analysis.fem_spaces, vertices);
  write_mode_sheet(folder, "msm_modes", analysis.msm, analysis.msm_spaces, vertices);
}

void write_free_modes_files(const std::string& folder, const FreeBodyModes& modes,
                            const cases::HexMesh& mesh) {
  std::vector<cases::PointField> fields;
  write_file(folder + "/body_modes.csv", [&](std::ostream& out) {
    fmt::print(out, "# mode,fem_eigenvalue,msm_eigenvalue,ratio,angle_degrees\n");
    for (std::size_t m = 0; m < modes.pairs.size(); ++m) {
      const ModePair& pair = modes.pairs[m];
      fmt::print(out, "{},{:.8g},{:.8g},{:.6g},{:.6g}\n", m + 1, pair.fem.eigenvalue, pair.msm.eigenvalue,
                 pair.ratio, pair.angle_degrees);
      for (const auto& [model, spectrum, space] :
           {std::tuple("fem", &modes.fem, &pair.fem), std::tuple("msm", &modes.msm, &pair.msm)})
        fields.push_back({fmt::format("{}_mode_{}", model, m + 1),
                          as_points(canonical_basis(basis(*spectrum, *space)).col(0))});
    }
  });
  write_file(folder + "/body_modes.vtu", [&](std::ostream& out) { write_vtu(out, mesh, fields); });
  draw(folder, "body_modes",
       "set multiplot layout 2,1\nset key off\nset xlabel 'mode'\nset ylabel 'eigenvalue, msm/fem'\n"
       "plot 'body_modes.csv' using 1:4 with linespoints lt 2\nset ylabel 'angle, degrees'\n"
       "plot 'body_modes.csv' using 1:5 with linespoints lt 2\nunset multiplot\n");
}

} // namespace springproof::compare
