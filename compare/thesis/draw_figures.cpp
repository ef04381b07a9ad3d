#include "compare/thesis/draw_figures.hpp"

#include "cases/case/read_case.hpp"
#include "compare/cube/plot_design.hpp"
#include "compare/provenance/cases_folder.hpp"
#include "compare/thesis/plot_bodies.hpp"
#include "compare/thesis/plot_volumes.hpp"
#include "compare/write/write_eigen.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

const std::string all_figures = "build/springproof tables --out DIR";

/// The cube's six tests in the order of figures 4.15 and 5.9: a row per test, small loads left and large ones
/// right.
struct CubeTest {
  const char *test, *load_set;
};
constexpr CubeTest cube_tests[] = {{"tensile", "small"}, {"tensile", "large"}, {"shear", "small"},
                                   {"shear", "large"},   {"torsion", "small"}, {"torsion", "large"}};

template<class Record, class Name>
const Record* find_named(const std::vector<Record>& records, const std::string& name, const Name& name_of) {
  const auto found = std::find_if(records.begin(), records.end(),
                                  [&](const Record& record) { return name_of(record) == name; });
  return found == records.end() ? nullptr : &*found;
}

const Comparison* find_case(const std::vector<Comparison>& cases, const std::string& name) {
  return find_named(cases, name, [](const Comparison& c) { return c.scene.definition.name; });
}

msm::CellStiffness published_cell(const std::string& design, const std::string& material,
                                  double poissons_ratio) {
  const auto k = published_stiffness(design, material, poissons_ratio);
  if (!k) throw cases::InputError("published/stiffness.csv: no " + design + " set for " + material);
  return {1e-3 * (*k)[0], 1e-3 * (*k)[1], 1e-3 * (*k)[2], 0};
}

void draw_linear_designs(const std::string& folder, std::vector<Figure>& figures) {
  plot_linear_method(folder, cases::Element::q1);
  const std::string command =
      "build/springproof design --young 1 --poisson 0.35 --method linear_method --out DIR";
  figures.push_back(
      {"4.6", "figure_4_6",
       "Pulled cells of the linear method, one curve per Poisson's ratio, with the nonlinear spring law: "
       "engineering stress per unit of Young's modulus; the right panel enlarges the lower part. The finite "
       "element's answer is the line of slope 1. Data: linear_method_curves.csv.",
       command});
  figures.push_back({"4.7", "figure_4_7",
                     "The same cells: how much their sides draw in. Dashed, in the same colour, the finite "
                     "element, whose slope is "
                     "-ν. Data: linear_method_curves.csv.",
                     command});
  figures.push_back({"4.8", "figure_4_8",
                     "What the linear method's minimisation leaves over: the Frobenius norm of the "
                     "difference of both stiffness "
                     "matrices. Data: linear_method_residual.csv.",
                     command});
}

void draw_nonlinear_designs(const std::string& folder, std::vector<Figure>& figures) {
  msm::DesignRequest ogden, linear;
  ogden.material = cases::read_case(cases_folder() + "/thesis/ogden/cube_tensile_small.toml").material;
  linear.material = cases::LinearElastic{0.3, 0.5}; // eq. 5.13
  const msm::UniaxialCurve ogden_curve = msm::uniaxial_reference(ogden);
  const msm::UniaxialCurve linear_curve = msm::uniaxial_reference(linear);
  const msm::CellStiffness ogden_cell = published_cell("nonlinear_method", "ogden", 0.5);
  const msm::CellStiffness linear_cell = published_cell("nonlinear_method", "linear_elastic", 0.5);
  plot_uniaxial(folder, "figure_5_4", {0.05, 0.05, 0.05, 0}, 1, ogden_curve);
  plot_incompressible_family(folder);
  plot_uniaxial(folder, "figure_5_6", ogden_cell, 1, ogden_curve);
  plot_uniaxial(folder, "figure_5_7", linear_cell, 1, linear_curve);
  plot_contributions(folder, "figure_5_8",
                     {{"Ogden (14, 17, 63 N/m)", ogden_cell, 1, ogden_curve.axial_strain},
                      {"linear elastic (23, 43, 509 N/m)", linear_cell, 1, linear_curve.axial_strain}});
  figures.push_back({"5.4", "figure_5_4",
                     "A cell before its adjustment (all springs 50 N/m, edge 1 mm) beside the Ogden "
                     "reference that it is to follow.",
                     all_figures});
  figures.push_back(
      {"5.5", "figure_5_5",
       "All stiffnesses from 0 to 0.1 N/mm in steps of 0.02 whose lateral strain follows an incompressible "
       "material's: the second term of eq. 5.9 is at most 0.01.",
       all_figures});
  figures.push_back(
      {"5.6", "figure_5_6", "The printed Ogden set (14, 17, 63 N/m) beside its reference.", all_figures});
  figures.push_back({"5.7", "figure_5_7",
                     "The printed set (23, 43, 509 N/m) for E = 0.3 MPa and ν = 0.5 beside its reference.",
                     all_figures});
  figures.push_back({"5.8", "figure_5_8",
                     "What each kind of spring contributes to the stress of a pulled cell. A stiff spring "
                     "contributes little "
                     "where it is hardly stretched.",
                     all_figures});
}

/// Appendix A groups the Poisson's ratios whose diagrams have the same pattern.
void draw_dot_diagrams(const std::string& folder, const ThesisResults& results,
                       std::vector<Figure>& figures) {
  const std::pair<const char*, std::vector<double>> groups[] = {
      {"4.11 / A.1", {0}},  {"A.2", {0.05, 0.1, 0.15}},
      {"A.3", {0.2, 0.25}}, {"A.4", {0.3}},
      {"A.5", {0.35}},      {"A.6", {0.4}},
      {"A.7", {0.45}},      {"A.8", {0.49}}};
  int n = 0;
  for (const auto& [number, ratios] : groups) {
    ++n;
    std::vector<DotDiagram> panels;
    std::string command;
    for (const double nu : ratios)
      for (const CellAnalysis& cell : results.cells)
        if (std::abs(cell.poissons_ratio - nu) < 1e-9) {
          panels.push_back({fmt::format("ν = {:.2f},", nu), &cell.spaces});
          command += fmt::format("{}build/springproof eigen --poisson {:g} --out DIR",
                                 command.empty() ? "" : "; ", nu);
        }
    if (panels.empty()) continue;
    const std::string name = fmt::format("figure_A_{}", n);
    plot_dot_diagrams(folder, name, panels);
    figures.push_back(
        {number, name,
         "Eigenvectors of both stiffness matrices of one cell, rigid motions first. Lines part the "
         "eigenspaces; a mark's size is what two spaces share. Squares on shaded blocks: equivalent spaces.",
         command});
  }
}

std::string label_of(const CubeTest& test) {
  return fmt::format("{}, {} load", test.test, test.load_set);
}

void draw_cubes(const std::string& folder, const ThesisResults& results, std::vector<Figure>& figures) {
  std::vector<Overlay> panels;
  for (const CubeTest& test : cube_tests)
    if (const Comparison* cube =
            find_case(results.figure_4_15, fmt::format("cube-{}-{}", test.test, test.load_set)))
      panels.push_back(overlay_of(*cube, label_of(test)));
  if (!panels.empty()) {
    plot_bodies(folder, "figure_4_15", panels, 2);
    figures.push_back(
        {"4.15", "figure_4_15",
         "The cube with E = 0.3 MPa and ν = 0.25, springs of the printed set (25, 36, 23 N/m) over finite "
         "elements (log_strain, q1_bbar). Displacements at true scale.",
         "build/springproof run cases/thesis/linear_elastic/cube_*.toml --set "
         "material.poissons_ratio=0.25 --set "
         "msm.design=given --set 'msm.stiffness=[25,36,23]' --out DIR"});
  }
  panels.clear();
  std::vector<const CaseVolumes*> volumes;
  std::vector<std::string> labels;
  for (const CubeTest& test : cube_tests) {
    const std::string name = fmt::format("cube-{}-{}-ogden", test.test, test.load_set);
    if (const Comparison* cube = find_case(results.cases, name))
      panels.push_back(overlay_of(*cube, label_of(test)));
    if (const CaseVolumes* of_case =
            find_named(results.volumes, name, [](const CaseVolumes& v) { return v.name; })) {
      volumes.push_back(of_case);
      labels.push_back(fmt::format("{}\\n{}", test.test, test.load_set));
    }
  }
  const std::string command = "build/springproof run cases/thesis/ogden/cube_*.toml --out DIR";
  if (!panels.empty()) {
    plot_bodies(folder, "figure_5_9", panels, 2);
    figures.push_back({"5.9", "figure_5_9",
                       "The Ogden cube, springs of the printed set (14, 17, 63 N/m) over finite elements "
                       "(hyperelastic, q1_p0). "
                       "Displacements at true scale.",
                       command});
  }
  if (!volumes.empty()) {
    plot_volumes(folder, "figure_5_10", volumes, labels);
    figures.push_back(
        {"5.10", "figure_5_10",
         "Volumes of the 1000 cells of the springs' Ogden cube, each 1 mm³ at rest; the finite elements are "
         "incompressible.",
         command});
  }
}

void draw_bars(const std::string& folder, const ThesisResults& results, std::vector<Figure>& figures) {
  std::vector<Overlay> panels;
  for (const char* cells : {"1x1x4", "2x2x8", "4x4x16"})
    if (const Comparison* bar = find_case(results.cases, fmt::format("bar-{}-ogden", cells)))
      panels.push_back(thesis_overlay(results, *bar, fmt::format("springs {}", cells)));
  if (panels.empty()) return;
  plot_bodies(folder, "figure_5_12", panels, 3);
  figures.push_back({"5.12", "figure_5_12",
                     "The bar, held at its foot, 0.05 N to the left shared by an edge of its free end: "
                     "springs at three resolutions "
                     "over 4x4x16 finite elements. Displacements at true scale.",
                     "build/springproof run cases/thesis/ogden/bar_*.toml --out DIR"});
}

} // namespace

Overlay thesis_overlay(const ThesisResults& results, const Comparison& comparison, const std::string& title) {
  Overlay overlay = overlay_of(comparison, title);
  const Comparison* finest = find_case(results.cases, "bar-4x4x16-ogden");
  if (finest && comparison.scene.definition.name.rfind("bar-", 0) == 0)
    overlay.fem = overlay_of(*finest, "").fem;
  return overlay;
}

std::vector<Figure> draw_figures(const std::string& folder, const ThesisResults& results) {
  std::vector<Figure> figures;
  draw_linear_designs(folder, figures);
  draw_dot_diagrams(folder, results, figures);
  draw_nonlinear_designs(folder, figures);
  draw_cubes(folder, results, figures);
  draw_bars(folder, results, figures);
  return figures;
}

} // namespace springproof::compare
