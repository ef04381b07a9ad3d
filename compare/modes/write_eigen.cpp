#include "compare/modes/modes.hpp"

#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"
#include "compare/write/gnuplot.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

std::string line_of(const char* model, const std::vector<Eigenspace>& spaces) {
  std::vector<std::string> words;
  for (const Eigenspace& space : spaces) {
    const double value = std::abs(space.eigenvalue) < 1e-9 * spaces.back().eigenvalue ? 0 : space.eigenvalue;
    words.push_back(fmt::format("{:.4g}({})", value, space.dimension));
  }
  return paragraph(fmt::format("{}", fmt::join(words, " ")), fmt::format("{:<5}", model), "     ");
}

constexpr std::size_t share_columns = 7; ///< columns of the coupling's text

void write_coupling(std::ostream& out, const Eigen::MatrixXd& coupling) {
  if (static_cast<std::size_t>(coupling.cols()) * share_columns > screen_width) {
    fmt::print(out, "coupling of {} fem and {} msm spaces: coupling.csv of --out\n", coupling.rows(),
               coupling.cols());
    return;
  }
  fmt::print(out, "coupling: share of each fem space (row) in each msm space (column)\n");
  for (const auto row : coupling.rowwise()) {
    for (const double share : row)
      fmt::print(out, "{:>{}}", share < 1e-12 ? "." : fmt::format("{:.3f}", share), share_columns);
    fmt::print(out, "\n");
  }
}

Json space_to_json(const Eigenspace& space) {
  return {{"eigenvalue", space.eigenvalue}, {"multiplicity", space.dimension}};
}

Json pair_to_json(const ModePair& pair) {
  return {{"fem_eigenvalue", pair.fem.eigenvalue},
          {"fem_multiplicity", pair.fem.dimension},
          {"msm_eigenvalue", pair.msm.eigenvalue},
          {"msm_multiplicity", pair.msm.dimension},
          {"ratio", pair.ratio},
          {"angle_degrees", pair.angle_degrees}};
}

Json mode_to_json(const MatchedModes& mode) {
  return {{"fem_hz", mode.fem_hz},
          {"multiplicity", mode.dimension},
          {"msm_hz", mode.msm_hz},
          {"overlap", mode.overlap},
          {"error_percent", mode.error_percent}};
}

/// A design's modes; a network's, which have no finite elements beside them, by their frequencies alone.
Json modes_to_json(const VibrationStudy& study, const DesignVibrations& design) {
  if (study.fem.hertz.size() > 0) return json_list(design.modes, mode_to_json);
  return json_list(cluster(design.msm.hertz, 0, same_frequency), [](const Eigenspace& space) -> Json {
    return {{"fem_hz", nullptr},
            {"multiplicity", space.dimension},
            {"msm_hz", space.eigenvalue},
            {"overlap", nullptr},
            {"error_percent", nullptr}};
  });
}

/// Rigid motions of a study's body, by its finite elements or else by its springs.
int n_rigid_of(const VibrationStudy& study) {
  return study.fem.hertz.size() > 0 ? study.fem.n_rigid : study.designs.front().msm.n_rigid;
}

void write_rows(const std::string& path, const std::string& columns, const Json& rows) {
  write_file(path, [&](std::ostream& out) { write_csv(out, columns_of(columns), rows, 8); });
}

/// Writes shapes of modes on a mesh as arrows.
void write_shapes(const std::string& path, const cases::Mesh& mesh,
                  const std::vector<cases::PointField>& shapes) {
  write_file(path, [&](std::ostream& out) { write_vtu(out, mesh, shapes); });
}

/// A panel's blocks: a dot for every pair of eigenvectors whose spaces are not orthogonal, lines between the
/// eigenspaces of both cells, blocks of equivalent ones. A dot's size is the spaces' coupling, not the
/// vectors' projection, which depends on the basis that the solver happened to return.
void write_panel(CsvWriter& csv, const EigenspaceAnalysis& analysis) {
  const auto is_equivalent = [&](std::size_t i, std::size_t j) {
    return std::any_of(analysis.equivalent.begin(), analysis.equivalent.end(),
                       [&](const Equivalence& e) { return e.fem_space == i && e.msm_space == j; });
  };
  csv.row("# msm_vector", "fem_vector", "size", "equivalent");
  for (std::size_t i = 0; i < analysis.fem_spaces.size(); ++i)
    for (std::size_t j = 0; j < analysis.msm_spaces.size(); ++j) {
      const Eigenspace &fem = analysis.fem_spaces[i], &msm = analysis.msm_spaces[j];
      const double share = analysis.coupling(i, j);
      if (share < 1e-12) continue; // orthogonal: the square of round-off is left
      for (int a = 0; a < fem.dimension; ++a)
        for (int b = 0; b < msm.dimension; ++b)
          csv.row(msm.offset + b + 1, fem.offset + a + 1, 0.4 + std::sqrt(share),
                  is_equivalent(i, j) ? 1 : 0);
    }
  csv.end_block();
  csv.row("# line from", "", "to");
  for (const Eigenspace& space : analysis.msm_spaces)
    csv.row(space.offset + 0.5, 0.5, space.offset + 0.5, 24.5);
  for (const Eigenspace& space : analysis.fem_spaces)
    csv.row(0.5, space.offset + 0.5, 24.5, space.offset + 0.5);
  csv.end_block();
  csv.row("# equivalent from", "", "to");
  for (const Equivalence& e : analysis.equivalent) {
    const Eigenspace &fem = analysis.fem_spaces[e.fem_space], &msm = analysis.msm_spaces[e.msm_space];
    csv.row(msm.offset + 0.5, fem.offset + 0.5, msm.offset + msm.dimension + 0.5,
            fem.offset + fem.dimension + 0.5);
  }
  if (analysis.equivalent.empty()) csv.row("nan", "nan", "nan", "nan"); // an empty block would not be counted
  csv.end_block();
}

std::vector<Eigen::Vector3d> as_points(const Eigen::VectorXd& vector) {
  std::vector<Eigen::Vector3d> points;
  for (Eigen::Index n = 0; n < vector.size() / 3; ++n) points.emplace_back(vector.segment<3>(3 * n));
  return points;
}

cases::Mesh cell_mesh(const msm::CellVertices& vertices) {
  cases::Mesh mesh;
  mesh.nodes.stored().assign(vertices.begin(), vertices.end());
  mesh.cells.stored() = {cases::CellNodes{0, 1, 2, 3, 4, 5, 6, 7}};
  return mesh;
}

/// The 12 edges as separate lines: rest position and displaced one.
void write_edges(CsvWriter& csv, const msm::CellVertices& rest, const Eigen::VectorXd& mode) {
  const double size = 0.35 * (rest[7] - rest[0]).norm() / mode.cwiseAbs().maxCoeff() / 2;
  for (const auto& edge : cases::cell_edges) {
    for (const int v : edge) {
      const Eigen::Vector3d x = rest[v], y = x + size * mode.segment<3>(3 * v);
      csv.row(x.x(), x.y(), x.z(), y.x(), y.y(), y.z());
    }
    csv.end_block();
  }
}

/// One picture for every deforming eigenspace, of its first canonical vector, with the eigenspace's number in
/// brackets.
void write_mode_sheet(const std::string& folder, const std::string& name, const Spectrum& spectrum,
                      const std::vector<Eigenspace>& spaces, const msm::CellVertices& rest) {
  std::vector<cases::PointField> fields;
  std::vector<std::string> titles;
  for (std::size_t s = 0; s < spaces.size(); ++s) {
    const Eigen::MatrixXd shapes = canonical_basis(basis(spectrum, spaces[s]));
    for (Eigen::Index c = 0; c < shapes.cols(); ++c)
      fields.push_back({fmt::format("space {} vector {}", s + 1, c + 1), as_points(shapes.col(c))});
    if (s == 0) continue; // rigid motions
    const std::string data = fmt::format("{}_{}.csv", name, s + 1);
    write_csv_file(
        folder + "/" + data, [&](CsvWriter& csv) { write_edges(csv, rest, shapes.col(0)); }, 6);
    titles.push_back(
        fmt::format("({}) {:.3g}, dimension {}", s + 1, spaces[s].eigenvalue, spaces[s].dimension));
  }
  const double height = 300 * static_cast<double>((titles.size() + 2) / 3);
  draw(folder, name, "mode_sheet", {{"titles", titles}, {"width", 900.}, {"height", height}});
  write_shapes(folder + "/" + name + ".vtu", cell_mesh(rest), fields);
}

} // namespace

void write_eigenspaces_text(std::ostream& out, const EigenspaceAnalysis& analysis) {
  fmt::print(out, "eigenvalues in N/mm (multiplicity)\n{}{}", line_of("fem", analysis.fem_spaces),
             line_of("msm", analysis.msm_spaces));
  fmt::print(out, "equivalent eigenspaces\n");
  for (const Equivalence& e : analysis.equivalent)
    fmt::print(out, "  fem {} = msm {}, dimension {}, distance {}\n", e.fem_space + 1, e.msm_space + 1,
               analysis.fem_spaces[e.fem_space].dimension, e.distance);
  write_coupling(out, analysis.coupling);
  fmt::print(out, "N = {}, h = {:.4f}\n", analysis.fem_spaces.size(), analysis.h);
}

void write_free_modes_text(std::ostream& out, const FreeBodyModes& modes) {
  fmt::print(out, "free body, lowest deforming modes\n");
  write_table(out,
              columns_of("fem~N/mm=fem_eigenvalue{:.6g} dim=fem_multiplicity msm~N/mm=msm_eigenvalue{:.6g} "
                         "dim=msm_multiplicity msm/fem=ratio{:.4f} angle~°=angle_degrees{:.2f}"),
              free_modes_to_json(modes));
}

Json eigenspaces_to_json(const EigenspaceAnalysis& analysis) {
  Json equivalent = Json::array(), coupling = Json::array();
  for (const Equivalence& e : analysis.equivalent)
    equivalent.push_back(
        {{"fem_space", e.fem_space + 1}, {"msm_space", e.msm_space + 1}, {"distance", e.distance}});
  for (const auto row : analysis.coupling.rowwise())
    coupling.push_back(std::vector<double>(row.begin(), row.end()));
  return {{"h", analysis.h},
          {"fem", json_list(analysis.fem_spaces, space_to_json)},
          {"msm", json_list(analysis.msm_spaces, space_to_json)},
          {"equivalent", equivalent},
          {"coupling", coupling}};
}

Json free_modes_to_json(const FreeBodyModes& modes) {
  return json_list(modes.pairs, pair_to_json);
}

void plot_dot_diagrams(const std::string& folder, const std::string& name,
                       const std::vector<DotDiagram>& panels) {
  std::vector<std::string> titles;
  write_csv_file(folder + "/" + name + ".csv", [&](CsvWriter& csv) {
    for (const DotDiagram& panel : panels) {
      titles.push_back(fmt::format("{} h = {:.2f}", panel.title, panel.analysis->h));
      write_panel(csv, *panel.analysis);
    }
  });
  const double width = 100 + 500 * static_cast<double>(panels.size());
  draw(folder, name, "dot_diagram", {{"titles", titles}, {"width", width}, {"height", 580.}});
}

void write_eigenspaces_files(const std::string& folder, const EigenspaceAnalysis& analysis,
                             const msm::CellVertices& vertices) {
  plot_dot_diagrams(folder, "dot_diagram", {{"", &analysis}});
  write_csv_file(folder + "/coupling.csv", [&](CsvWriter& csv) {
    for (const auto row : analysis.coupling.rowwise()) csv.row(std::vector<double>(row.begin(), row.end()));
  });
  write_mode_sheet(folder, "fem_modes", analysis.fem, analysis.fem_spaces, vertices);
  write_mode_sheet(folder, "msm_modes", analysis.msm, analysis.msm_spaces, vertices);
}

void write_free_modes_files(const std::string& folder, const FreeBodyModes& modes, const cases::Mesh& mesh) {
  std::vector<cases::PointField> fields;
  Json rows = free_modes_to_json(modes);
  for (std::size_t m = 0; m < modes.pairs.size(); ++m) {
    rows[m]["# mode"] = m + 1;
    for (const auto& [model, spectrum, space] : {std::tuple("fem", &modes.fem, &modes.pairs[m].fem),
                                                 std::tuple("msm", &modes.msm, &modes.pairs[m].msm)})
      fields.push_back({fmt::format("{}_mode_{}", model, m + 1),
                        as_points(canonical_basis(basis(*spectrum, *space)).col(0))});
  }
  write_rows(folder + "/body_modes.csv", "#~mode fem_eigenvalue msm_eigenvalue ratio angle_degrees", rows);
  write_shapes(folder + "/body_modes.vtu", mesh, fields);
  draw(folder, "body_modes", "body_modes");
}

void write_vibrations_text(std::ostream& out, const VibrationStudy& study) {
  print(out, "{}: vibrations about rest", study.name);
  if (const int n = n_rigid_of(study); n > 0) print(out, ", {} rigid motions left out", n);
  print(out, "\n");
  for (const DesignVibrations& design : study.designs) {
    if (!design.refusal.empty()) {
      write_paragraph(out, design.design + ": " + design.refusal, "  ", "    ");
      continue;
    }
    print(out, "  {}\n", design.design);
    write_table(out,
                columns_of("fem~Hz=fem_hz{:.6g} dim=multiplicity msm~Hz=msm_hz{:.6g} "
                           "error~%=error_percent{:+.2f} overlap{:.4f}"),
                modes_to_json(study, design));
  }
}

Json vibrations_to_json(const VibrationStudy& study) {
  const Json designs = json_list(study.designs, [&](const DesignVibrations& design) -> Json {
    return {{"design", design.design}, {"refusal", design.refusal}, {"modes", modes_to_json(study, design)}};
  });
  return {{"case", study.name},
          {"rigid_motions", n_rigid_of(study)},
          {"fem_hz", std::vector<double>(study.fem.hertz.begin(), study.fem.hertz.end())},
          {"designs", designs},
          {"modes", designs.front()["modes"]}};
}

void write_vibrations_files(const std::string& folder, const VibrationStudy& study, const cases::Mesh& mesh) {
  std::vector<cases::PointField> fields;
  const auto add = [&](const std::string& model, int mode, const Eigen::VectorXd& shape) {
    fields.push_back(
        {fmt::format("{}_mode_{}", model, mode + 1), as_points(shape / shape.cwiseAbs().maxCoeff())});
  };
  Json rows = Json::array();
  for (const DesignVibrations& design : study.designs) {
    int first = 0; // mode of a row
    for (Json row : modes_to_json(study, design)) {
      row["design"] = design.design;
      row["mode"] = first + 1;
      first += row["multiplicity"].get<int>();
      rows.push_back(std::move(row));
    }
    for (const MatchedModes& mode : design.modes) {
      if (&design == &study.designs.front()) add("fem", mode.fem_mode, study.fem.shapes.col(mode.fem_mode));
      if (mode.msm_hz) add(design.design, mode.fem_mode, design.msm.shapes.col(mode.msm_mode));
    }
    for (Eigen::Index m = 0; m < design.msm.shapes.cols() && study.fem.hertz.size() == 0; ++m)
      add(design.design, static_cast<int>(m), design.msm.shapes.col(m));
  }
  const std::string path = folder + "/" + study.name + "_modes";
  write_rows(path + ".csv", "design mode fem_hz multiplicity msm_hz overlap error_percent", rows);
  write_shapes(path + ".vtu", mesh, fields);
}

} // namespace springproof::compare
