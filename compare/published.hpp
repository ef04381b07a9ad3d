#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

/// The thesis's printed figures, read from cases/published/.
namespace compare {

/// One printed figure: an error of tables 4.5 to 5.4 or of figure 5.12, or a volume of table 5.2.
struct PublishedFigure {
  std::string table;     ///< "4.5"
  std::string material;  ///< "linear_elastic" or "ogden"
  double poissons_ratio; ///< of the finite-element reference
  std::string design;    ///< "linear_method" or "nonlinear_method"
  double design_poissons_ratio;
  std::string load_set; ///< "small" or "large"; empty for the bar
  std::string test;     ///< "tensile", "shear", "torsion", "bar_1x1x4" ...
  std::string measure;  ///< "L_1" ... "beta_2", "volume", "deflection"
  std::string unit;     ///< "%" for an error, "mm3" for the volume of the springs' body
  double value;
};

/// Folder of the case files and data that come with the program; the environment variable SPRINGPROOF_CASES
/// moves it.
std::string cases_folder();

/// All figures of errors.csv, volumes.csv and bar_deflection.csv.
/// @throws InputError naming the file when a row is broken
std::vector<PublishedFigure> read_published_figures();

/// k_e, k_f, k_d in whole N/m where the thesis prints them for this design of the 1 mm cell, else nothing.
std::optional<std::array<double, 3>>
published_stiffness(const std::string& design, const std::string& material, double design_poissons_ratio);

/// Rows of a comma-separated file without its header, every row as wide as the header.  @throws InputError
std::vector<std::vector<std::string>> read_csv(const std::string& path);

} // namespace compare
