#include "compare/cube/write_design.hpp"

#include "cases/case/error.hpp"
#include "compare/solve/springs.hpp"
#include "compare/table/table.hpp"
#include "compare/write/gnuplot.hpp"
#include "msm/design/cells.hpp"
#include "msm/design/multi_load.hpp"
#include "msm/design/uniaxial.hpp"

#include <Eigen/LU>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

std::vector<double> equally_spaced(double lowest, double highest, int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(lowest + (highest - lowest) * i / (n - 1));
  return values;
}

/// Stress of one kind of spring alone at the whole cell's width, MPa.
double contribution(const msm::CellStiffness& part, double lateral_strain, double strain, double edge) {
  return msm::axial_stress(part, std::exp(lateral_strain), std::exp(strain), edge);
}

/// A homogeneous test, as a figure shows it.
struct HomogeneousTest {
  std::string file;
  cases::LoadPath path;
  int row, column; ///< entry of the nominal stress
  std::vector<double> strains;
};

/// First Piola-Kirchhoff stress of the material, MPa.
double nominal_stress(const HomogeneousTest& test, const cases::Material& material, double strain) {
  const auto [f, cauchy] = msm::material_state(material, test.path, strain);
  const Eigen::Matrix3d nominal = f.determinant() * cauchy * f.transpose().inverse();
  return nominal(test.row, test.column);
}

/// The lattice's; nothing where its sides find no equilibrium.
std::optional<double> nominal_stress(const HomogeneousTest& test, const msm::CellStiffness& springs,
                                     double edge, double strain) {
  try {
    Eigen::Matrix3d f = msm::simple_shear(strain);
    if (test.path == cases::LoadPath::uniaxial) {
      const double axial = std::exp(strain), lateral = msm::free_lateral_stretch(springs, edge, axial);
      f = Eigen::Vector3d(lateral, lateral, axial).asDiagonal();
    }
    return msm::lattice_stress(springs, edge, f)(test.row, test.column);
  } catch (const cases::SolveError&) {
    return std::nullopt;
  }
}

} // namespace

void plot_linear_method(const std::string& folder, cases::Element element) {
  const std::vector<double> ratios{0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.49}; // the thesis's
  std::vector<double> residuals;
  cases::Msm options;
  options.design = cases::Design::linear_method;
  write_csv_file(folder + "/linear_method_curves.csv", [&](CsvWriter& csv) {
    csv.row("# poissons_ratio", "engineering_strain", "stress_over_E", "lateral_strain");
    for (const double nu : ratios) {
      const msm::DesignResult design =
          msm::design(design_request(cases::LinearElastic{1, nu}, msm::cube(1), options, element));
      residuals.push_back(*design.residual);
      for (const double strain : equally_spaced(0, 0.1, 21)) {
        const msm::UniaxialCurve curve = msm::uniaxial_response(design.stiffness, 1, {std::log(1 + strain)});
        const double lateral = std::exp(curve.lateral_strain[0]);
        csv.row(nu, strain, curve.stress[0] * lateral * lateral, lateral - 1);
      }
      csv.end_block();
    }
  });
  write_csv_file(folder + "/linear_method_residual.csv", [&](CsvWriter& csv) {
    csv.row("# poissons_ratio", "residual");
    for (std::size_t i = 0; i < ratios.size(); ++i) csv.row(ratios[i], residuals[i]);
  });
  draw(folder, "figure_4_6", "linear_method_stress",
       {{"ratios", ratios}, {"width", 1200.}, {"height", 520.}});
  draw(folder, "figure_4_7", "linear_method_lateral", {{"ratios", ratios}, {"width", 900.}});
  draw(folder, "figure_4_8", "linear_method_residual");
}

void plot_uniaxial(const std::string& folder, const std::string& name, const msm::CellStiffness& design,
                   double edge, const msm::UniaxialCurve& reference) {
  const msm::UniaxialCurve curve = msm::uniaxial_response(design, edge, reference.axial_strain);
  write_csv_file(folder + "/" + name + ".csv", [&](CsvWriter& csv) {
    csv.row("# log_strain", "stress_reference", "stress_cell", "lateral_reference",
            "lateral_cell (stresses in MPa)");
    for (std::size_t i = 0; i < curve.axial_strain.size(); ++i)
      csv.row(curve.axial_strain[i], reference.stress[i], curve.stress[i], reference.lateral_strain[i],
              curve.lateral_strain[i]);
  });
  draw(folder, name, "uniaxial", {{"width", 1100.}, {"height", 500.}});
}

void plot_contributions(const std::string& folder, const std::string& name,
                        const std::vector<PulledCell>& cells) {
  std::vector<std::string> titles;
  write_csv_file(folder + "/" + name + ".csv", [&](CsvWriter& csv) {
    csv.row("# log_strain", "stress", "stress_edges", "stress_face_diagonals",
            "stress_internal_diagonals (MPa)");
    for (const PulledCell& cell : cells) {
      titles.push_back(cell.title);
      const msm::CellStiffness& k = cell.stiffness;
      const msm::UniaxialCurve curve = msm::uniaxial_response(k, cell.edge, cell.axial_strain);
      for (std::size_t i = 0; i < curve.axial_strain.size(); ++i) {
        const double strain = curve.axial_strain[i], lateral = curve.lateral_strain[i];
        csv.row(strain, curve.stress[i], contribution({k.edge, 0, 0, 0}, lateral, strain, cell.edge),
                contribution({0, k.face_diagonal, 0, 0}, lateral, strain, cell.edge),
                contribution({0, 0, k.internal_diagonal, 0}, lateral, strain, cell.edge));
      }
      csv.end_block();
    }
  });
  const double width = 100 + 500 * static_cast<double>(cells.size());
  draw(folder, name, "contributions", {{"titles", titles}, {"width", width}, {"height", 500.}});
}

void plot_incompressible_family(const std::string& folder) {
  const std::vector<double> strains = equally_spaced(0, 0.4, 20);
  double n_sets = 0;
  write_csv_file(folder + "/figure_5_5.csv", [&](CsvWriter& csv) {
    csv.row("# k_e", "k_f", "k_d (N/mm)", "log_strain", "stress", "lateral_strain");
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
            csv.row(k.edge, k.face_diagonal, k.internal_diagonal, strains[i], curve.stress[i],
                    curve.lateral_strain[i]);
          csv.row(); // ends the curve
        }
  });
  draw(folder, "figure_5_5", "incompressible_family",
       {{"n_sets", n_sets}, {"width", 1100.}, {"height", 500.}});
}

void plot_stress_strain(const std::string& folder, const cases::Material& material,
                        const std::vector<NamedSprings>& designs, double edge) {
  const double youngs_modulus = msm::small_strain_material(material).youngs_modulus;
  std::vector<std::string> names;
  for (const NamedSprings& springs : designs) names.push_back(springs.name);
  for (const HomogeneousTest& test :
       {HomogeneousTest{"uniaxial", cases::LoadPath::uniaxial, 2, 2, equally_spaced(-0.3, 0.3, 61)},
        HomogeneousTest{"shear", cases::LoadPath::simple_shear, 0, 2, equally_spaced(0, 0.6, 61)}})
    write_csv_file(folder + "/stress_strain_" + test.file + ".csv", [&](CsvWriter& csv) {
      csv.row("# design", test.row == test.column ? "log_strain" : "amount_of_shear",
              "nominal_stress_over_E; the material first");
      for (const double strain : test.strains)
        csv.row("material", strain, nominal_stress(test, material, strain) / youngs_modulus);
      csv.end_block();
      for (const NamedSprings& springs : designs) {
        for (const double strain : test.strains)
          if (const auto stress = nominal_stress(test, springs.stiffness, edge, strain))
            csv.row(springs.name, strain, *stress / youngs_modulus);
        csv.end_block();
      }
    });
  draw(folder, "stress_strain", "stress_strain", {{"designs", names}, {"width", 1200.}, {"height", 500.}});
}

void plot_valley(const std::string& folder, const msm::CellStiffness& minimum, double edge,
                 const msm::UniaxialCurve& reference, const std::vector<msm::CellStiffness>& others) {
  const msm::Identifiability found = msm::identifiability(minimum, edge, reference);
  const Eigen::Vector3d centre(minimum.edge, minimum.face_diagonal, minimum.internal_diagonal);
  const auto in_plane = [&](const Eigen::Vector3d& k) -> Eigen::Vector2d {
    return found.directions.leftCols<2>().transpose() * (k - centre);
  };
  double reach = 0.6 * centre.norm();
  write_csv_file(folder + "/valley_sets.csv", [&](CsvWriter& csv) {
    csv.row("# a", "b", "phi (the minimum first, then the others projected)");
    csv.row(0, 0, msm::uniaxial_objective(minimum, edge, reference));
    for (const msm::CellStiffness& other : others) {
      const Eigen::Vector2d at = in_plane({other.edge, other.face_diagonal, other.internal_diagonal});
      reach = std::max(reach, 1.2 * at.cwiseAbs().maxCoeff());
      csv.row(1e3 * at.x(), 1e3 * at.y(), msm::uniaxial_objective(other, edge, reference));
    }
  });
  write_csv_file(folder + "/valley.csv", [&](CsvWriter& csv) {
    csv.row("# a", "b (N/m along the two best-determined directions)",
            "phi; empty where a stiffness would be negative");
    for (const double a : equally_spaced(-reach, reach, 81)) {
      for (const double b : equally_spaced(-reach, reach, 81)) {
        const Eigen::Vector3d k = centre + found.directions.leftCols<2>() * Eigen::Vector2d(a, b);
        const bool allowed = k.minCoeff() >= -1e-9 * centre.norm() &&
                             (k.y() > 1e-6 * centre.norm() || k.z() > 1e-6 * centre.norm());
        const msm::CellStiffness cell = {std::max(0.0, k.x()), std::max(0.0, k.y()), std::max(0.0, k.z()), 0};
        csv.row(1e3 * a, 1e3 * b,
                allowed ? std::optional(msm::uniaxial_objective(cell, edge, reference)) : std::nullopt);
      }
      csv.row();
    }
  });
  const auto label = [&](int c) {
    const Eigen::Vector3d v = found.directions.col(c);
    return fmt::format("along ({:.2f}, {:.2f}, {:.2f}), N/m; singular value {:.3g}", v.x(), v.y(), v.z(),
                       found.singular_values(c));
  };
  draw(folder, "valley", "valley",
       {{"condition", found.condition}, {"labels", std::vector{label(0), label(1)}}, {"height", 700.}});
}

} // namespace springproof::compare
