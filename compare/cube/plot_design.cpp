#include "compare/cube/plot_design.hpp"

#include "compare/solve/design.hpp"
#include "compare/write/gnuplot.hpp"
#include "compare/write/whole_file.hpp"
#include "msm/design/nonlinear_method.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

const std::vector<double>& thesis_poissons_ratios() {
  static const std::vector<double> ratios{0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.49};
  return ratios;
}

std::vector<double> equally_spaced(double lowest, double highest, int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(lowest + (highest - lowest) * i / (n - 1));
  return values;
}

/// Viridis without its yellow end, which is lost on paper: a family of curves in the order of its parameter.
/// @param t  0 (dark) to 1 (light)
std::string sequential_colour(double t) {
  constexpr int anchors[][3] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {170, 205, 40}};
  const double position = 4 * t;
  const int i = std::min(3, static_cast<int>(position));
  int mixed[3];
  for (int c = 0; c < 3; ++c)
    mixed[c] =
        static_cast<int>(std::lround(anchors[i][c] + (position - i) * (anchors[i + 1][c] - anchors[i][c])));
  return fmt::format("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2]);
}

/// Stress of one kind of spring alone at the whole cell's width, MPa.
double contribution(const msm::CellStiffness& part, double lateral_strain, double strain, double edge) {
  const double k[] = {part.edge, part.face_diagonal, part.internal_diagonal};
  return msm::axial_stress(k, std::exp(lateral_strain), std::exp(strain), edge);
}

} // namespace

void plot_linear_method(const std::string& folder, cases::Element element) {
  std::string curves = "# poissons_ratio,engineering_strain,stress_over_E,lateral_strain\n",
              residuals = "# poissons_ratio,residual\n";
  std::string stress_plot = "plot ", lateral_plot = "plot ";
  const std::vector<double>& ratios = thesis_poissons_ratios();
  for (std::size_t block = 0; block < ratios.size(); ++block) {
    const double nu = ratios[block];
    const msm::DesignResult design =
        msm::design(design_request(cases::LinearElastic{1, nu}, msm::cube(1), cases::Msm{}, element));
    residuals += fmt::format("{},{:.8g}\n", nu, *design.residual);
    for (const double strain : equally_spaced(0, 0.1, 21)) {
      const double stretch = 1 + strain;
      const msm::UniaxialCurve curve = msm::uniaxial_response(design.stiffness, 1, {std::log(stretch)});
      const double lateral = std::exp(curve.lateral_strain[0]);
      curves += fmt::format("{},{:.4f},{:.8g},{:.8g}\n", nu, strain, curve.stress[0] * lateral * lateral,
                            lateral - 1);
    }
    curves += "\n\n";
    const std::string colour =
        sequential_colour(static_cast<double>(block) / static_cast<double>(ratios.size() - 1));
    const std::string style = fmt::format(
        "with linespoints lw 1.5 dt solid pt {} pi 4 lc rgb '{}' title 'ν = {}'", block + 1, colour, nu);
    stress_plot += fmt::format("'linear_method_curves.csv' index {} using 2:3 {}, ", block, style);
    lateral_plot +=
        fmt::format("{}'linear_method_curves.csv' index {} using 2:4 {}, -{}*x dt 2 lc rgb '{}' notitle",
                    block == 0 ? "" : ", ", block, style, nu, colour);
  }
  write_file(folder + "/linear_method_curves.csv", [&](std::ostream& out) { out << curves; });
  write_file(folder + "/linear_method_residual.csv", [&](std::ostream& out) { out << residuals; });
  const std::string axes =
      "set key outside right\nset xlabel 'axial engineering strain'\nset xrange [0:0.1]\n";
  stress_plot += "x lt 1 lw 3 dt (8,6) title 'finite element'\n";
  // Close to incompressibility the cell is ten times too stiff: the others are seen in the enlarged panel
  // alone.
  draw(folder, "figure_4_6",
       "set multiplot layout 1,2\n" + axes +
           "set ylabel 'engineering stress / E'\nunset key\nset yrange [0:1]\n" + stress_plot +
           "set key outside right\nset title 'enlarged'\nset yrange [0:0.14]\n" + stress_plot +
           "unset multiplot\n",
       1200, 520);
  draw(folder, "figure_4_7",
       axes + "set ylabel 'lateral engineering strain (dashed: finite element)'\n" + lateral_plot + "\n",
       900);
  draw(folder, "figure_4_8",
       "unset key\nset xlabel 'Poisson ratio ν'\nset ylabel '‖K_{FEM} − K_{MSM}‖_F / (E L_0)'\n"
       "plot 'linear_method_residual.csv' using 1:2 with linespoints lt 2\n");
}

void plot_uniaxial(const std::string& folder, const std::string& name, const msm::CellStiffness& design,
                   double edge, const msm::UniaxialCurve& reference) {
  const msm::UniaxialCurve curve = msm::uniaxial_response(design, edge, reference.axial_strain);
  write_file(folder + "/" + name + ".csv", [&](std::ostream& out) {
    fmt::print(
        out, "# log_strain,stress_reference,stress_cell,lateral_reference,lateral_cell (stresses in MPa)\n");
    for (std::size_t i = 0; i < curve.axial_strain.size(); ++i)
      fmt::print(out, "{:.8g},{:.8g},{:.8g},{:.8g},{:.8g}\n", curve.axial_strain[i], reference.stress[i],
                 curve.stress[i], reference.lateral_strain[i], curve.lateral_strain[i]);
  });
  draw(folder, name,
       fmt::format("set multiplot layout 1,2\nset key left top\nset xlabel 'axial logarithmic strain'\n"
                   "set ylabel 'Cauchy stress, MPa'\n"
                   "plot '{0}.csv' using 1:2 with lines lt 1 title 'reference', "
                   "'' using 1:3 with linespoints lt 2 title 'mass-spring cell'\n"
                   "set key right top\nset ylabel 'lateral logarithmic strain'\n"
                   "plot '{0}.csv' using 1:4 with lines lt 1 title 'reference', "
                   "'' using 1:5 with linespoints lt 2 title 'mass-spring cell'\nunset multiplot\n",
                   name),
       1100, 500);
}

void plot_contributions(const std::string& folder, const std::string& name,
                        const std::vector<PulledCell>& cells) {
  std::string data,
      script = fmt::format("set multiplot layout 1,{}\nset key left top\nset yrange [0:*]\n"
                           "set xlabel 'axial logarithmic strain'\nset ylabel 'Cauchy stress, MPa'\n",
                           cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const msm::CellStiffness& k = cells[c].stiffness;
    const msm::UniaxialCurve curve = msm::uniaxial_response(k, cells[c].edge, cells[c].axial_strain);
    data += fmt::format("{}# {}: log_strain,stress,stress_edges,stress_face_diagonals,"
                        "stress_internal_diagonals (MPa)\n",
                        c == 0 ? "" : "\n\n", cells[c].title);
    for (std::size_t i = 0; i < curve.axial_strain.size(); ++i) {
      const double strain = curve.axial_strain[i], lateral = curve.lateral_strain[i];
      data += fmt::format("{:.8g},{:.8g},{:.8g},{:.8g},{:.8g}\n", strain, curve.stress[i],
                          contribution({k.edge, 0, 0, 0}, lateral, strain, cells[c].edge),
                          contribution({0, k.face_diagonal, 0, 0}, lateral, strain, cells[c].edge),
                          contribution({0, 0, k.internal_diagonal, 0}, lateral, strain, cells[c].edge));
    }
    script += fmt::format(
        "set title '{0}'\nplot '{1}.csv' index {2} using 1:2 with lines lt 7 dt solid lw 3 title 'all "
        "springs', '' index {2} using 1:3 with linespoints lt 2 pi 3 title 'edges', "
        "'' index {2} using 1:4 with linespoints lt 3 pi 3 title 'face diagonals', "
        "'' index {2} using 1:5 with linespoints lt 4 pi 3 title 'internal diagonals'\n",
        cells[c].title, name, c);
  }
  write_file(folder + "/" + name + ".csv", [&](std::ostream& out) { out << data; });
  draw(folder, name, script + "unset multiplot\n", 100 + 500 * static_cast<int>(cells.size()), 500);
}

void plot_incompressible_family(const std::string& folder) {
  const std::vector<double> strains = equally_spaced(0, 0.4, 20);
  std::string data = "# k_e,k_f,k_d (N/mm),log_strain,stress,lateral_strain\n";
  int n_sets = 0;
  for (int e = 0; e <= 5; ++e)
    for (int f = 0; f <= 5; ++f)
      for (int d = 0; d <= 5; ++d) {
        const msm::CellStiffness k = {0.02 * e, 0.02 * f, 0.02 * d, 0};
        if (f + d == 0) continue; // nothing pulls the sides inwards
        const msm::UniaxialCurve curve = msm::uniaxial_response(k, 1, strains);
        double error = 0, norm = 0;
        for (std::size_t i = 0; i < strains.size(); ++i) {
          error += std::pow(curve.lateral_strain[i] + strains[i] / 2, 2);
          norm += std::pow(strains[i] / 2, 2);
        }
        if (!(error / norm <= 0.01)) continue;
        ++n_sets;
        for (std::size_t i = 0; i < strains.size(); ++i)
          data += fmt::format("{:.2f},{:.2f},{:.2f},{:.6g},{:.8g},{:.8g}\n", k.edge, k.face_diagonal,
                              k.internal_diagonal, strains[i], curve.stress[i], curve.lateral_strain[i]);
        data += "\n";
      }
  write_file(folder + "/figure_5_5.csv", [&](std::ostream& out) { out << data; });
  draw(folder, "figure_5_5",
       fmt::format("set multiplot layout 1,2 title '{} sets of stiffnesses'\nset xlabel 'axial "
                   "logarithmic strain'\n"
                   "set ylabel 'Cauchy stress, MPa'\nunset key\n"
                   "plot 'figure_5_5.csv' using 4:5 with lines lt 2 lw 0.7 dt solid\n"
                   "set ylabel 'lateral logarithmic strain'\nset key right top\n"
                   "plot 'figure_5_5.csv' using 4:6 with lines lt 2 lw 0.7 dt solid title 'mass-spring "
                   "cells', -x/2 lt 1 "
                   "lw 3 dt (8,6) title 'incompressible'\n"
                   "unset multiplot\n",
                   n_sets),
       1100, 500);
}

void plot_valley(const std::string& folder, const msm::CellStiffness& minimum, double edge,
                 const msm::UniaxialCurve& reference, const std::vector<msm::CellStiffness>& others) {
  const msm::Identifiability found = msm::identifiability(minimum, edge, reference);
  const Eigen::Vector3d centre(minimum.edge, minimum.face_diagonal, minimum.internal_diagonal);
  const auto in_plane = [&](const Eigen::Vector3d& k) -> Eigen::Vector2d {
    return found.directions.leftCols<2>().transpose() * (k - centre);
  };
  double reach = 0.6 * centre.norm();
  std::string sets = fmt::format("# a,b,phi (the minimum first, then the others projected)\n0,0,{:.8g}\n",
                                 msm::uniaxial_objective(minimum, edge, reference));
  for (const msm::CellStiffness& other : others) {
    const Eigen::Vector2d at = in_plane({other.edge, other.face_diagonal, other.internal_diagonal});
    reach = std::max(reach, 1.2 * at.cwiseAbs().maxCoeff());
    sets += fmt::format("{:.8g},{:.8g},{:.8g}\n", 1e3 * at.x(), 1e3 * at.y(),
                        msm::uniaxial_objective(other, edge, reference));
  }
  write_file(folder + "/valley_sets.csv", [&](std::ostream& out) { out << sets; });
  write_file(folder + "/valley.csv", [&](std::ostream& out) {
    fmt::print(
        out,
        "# a,b (N/m along the two best-determined directions),phi; ? where a stiffness would be negative\n");
    for (const double a : equally_spaced(-reach, reach, 81)) {
      for (const double b : equally_spaced(-reach, reach, 81)) {
        const Eigen::Vector3d k = centre + found.directions.leftCols<2>() * Eigen::Vector2d(a, b);
        const bool allowed = k.minCoeff() >= -1e-9 * centre.norm() &&
                             (k.y() > 1e-6 * centre.norm() || k.z() > 1e-6 * centre.norm());
        const msm::CellStiffness cell = {std::max(0.0, k.x()), std::max(0.0, k.y()), std::max(0.0, k.z()), 0};
        fmt::print(out, "{:.6g},{:.6g},{}\n", 1e3 * a, 1e3 * b,
                   allowed ? fmt::format("{:.8g}", msm::uniaxial_objective(cell, edge, reference)) : "?");
      }
      fmt::print(out, "\n");
    }
  });
  const auto label = [&](int c) {
    const Eigen::Vector3d v = found.directions.col(c);
    return fmt::format("along ({:.2f}, {:.2f}, {:.2f}), N/m; singular value {:.3g}", v.x(), v.y(), v.z(),
                       found.singular_values(c));
  };
  draw(
      folder, "valley",
      fmt::format(
          "set datafile missing '?'\nset title 'log_{{10}} φ; condition number {:.3g}'\nset "
          "xlabel '{}'\nset ylabel '{}'\n"
          "set view map\nset border 15\nunset grid\nset contour base\nset cntrparam levels 12\nunset "
          "key\nset pm3d map\nset "
          "palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n"
          "splot 'valley.csv' using 1:2:(log10($3)) with pm3d nocontour, '' using 1:2:(log10($3)) with lines "
          "nosurface lc rgb '#555555', 'valley_sets.csv' using 1:2:(log10($3)) with points pt 7 ps 1.2 "
          "lc rgb 'black' nocontour\n",
          found.condition, label(0), label(1)),
      800, 700);
}

} // namespace springproof::compare
