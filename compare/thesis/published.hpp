#pragma once

#include "compare/cube/cube_benchmark.hpp"
#include "compare/solve/solve_jobs.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// The thesis's printed figures, read from cases/published/, the solves behind each, and the command that
/// repeats them.
namespace springproof::compare {

/// One printed figure: an error of tables 4.5 to 5.4 or of figure 5.12, a volume of table 5.2, or a figure of
/// one cell in tables 4.1 to 4.3 (test "cell").
struct PublishedFigure {
  std::string table;     ///< "4.5"
  std::string material;  ///< "linear_elastic" or "ogden"
  double poissons_ratio; ///< in the finite-element reference
  std::string design;    ///< "linear_method" or "nonlinear_method"
  double design_poissons_ratio;
  std::string load_set; ///< "small" or "large"; empty for the bar and the cell
  std::string test;     ///< "tensile", "shear", "torsion", "bar_1x1x4" ..., "cell"
  /// "L_1" ... "beta_2", "volume", "deflection"; a cell's "edge", "face_diagonal", "internal_diagonal"
  /// (k', eq. 4.21), "fem_eigenvalue_2", "msm_multiplicity_1" (numbered from 1), "h"
  std::string measure;
  std::string unit; ///< "%" for an error, "mm3" for the volume of the springs' body, "N/mm", or "1"
  double value;
};

/// All figures of cases/published/figures.csv, table by table as numbered (5.12 after 5.4).
/// @throws InputError naming the file when a row is broken
const std::vector<PublishedFigure>& published_figures();

/// The tables of these figures, each once.
std::vector<std::string> tables_of(const std::vector<PublishedFigure>& figures);

/// Largest change of a cell's volume without outliers, percent, for a load set; section 5.3.1.3.
double published_cell_volume_change(const std::string& load_set);

/// k_e, k_f, k_d in whole N/m where the thesis prints them for this design of the 1 mm cell, else nothing.
std::optional<std::array<double, 3>>
published_stiffness(const std::string& design, const std::string& material, double design_poissons_ratio);

/// A row of a comma-separated file.
struct CsvRow {
  std::string path; ///< the file's
  std::vector<std::string> fields;
  const std::string& operator[](std::size_t field) const { return fields.at(field); }
  double number(std::size_t field) const; ///< @throws InputError naming the file
};

/// Rows of a comma-separated file without its header, every row as wide as the header.  @throws InputError
std::vector<CsvRow> read_csv(const std::string& path);

/// How to compute one number again.
struct Trace {
  std::string case_file{};             ///< relative to cases_folder(); empty when no case stands behind it
  std::vector<std::string> settings{}; ///< for `run CASE --set ...`
  std::string command{};               ///< the whole line, as typed in the source folder
};

/// A finite-element side that a figure is compared with.
struct FemChoice {
  std::string name;                  ///< formulation and element, "small_strain q1_bbar"
  std::vector<std::string> settings; ///< that make it of the case file; empty for the declared one
};

/// The case file's own [fem], the declared reference, first. The published linear elastic figures come from
/// two references: log strain and small strain, both with B-bar; the one that is not declared is the other.
std::vector<FemChoice> references_of(const PublishedFigure& figure);

/// Path below cases_folder() of the case behind a figure of chapters 4.3 and 5.3.
std::string case_file_of(const PublishedFigure& figure);

/// The two sides of one case, solved apart: many springs are compared with the same finite elements.
struct JobPair {
  SolveJob fem, msm;
};

/// Jobs against a reference, with the thesis's springs: the published ones (the bar's case files scale them
/// to their cells), else those of its method.
JobPair thesis_jobs(const PublishedFigure& figure, const FemChoice& reference);
/// The same against the declared reference.
JobPair thesis_jobs(const PublishedFigure& figure);

/// Jobs against the declared reference, with springs that a method designs from the figure's own material,
/// whatever the thesis designed from.
JobPair designed_jobs(const PublishedFigure& figure, const std::string& design);

/// How to run both jobs of one case at once.
Trace trace_of(const JobPair& jobs);

/// The words of a command line of the program, quoted for a shell where needed.
std::string shell_command(const std::vector<std::string>& words);

/// The jobs solved, each once, however many figures share it.
using Solutions = std::map<SolveJob, Comparison>;

/// The springs' case with the finite elements' answer.
Comparison join(const Solutions& solutions, const JobPair& jobs);

/// A measure on the two sides of a case.
struct MeasuredPair {
  std::optional<double> fem, msm;
  std::string reason;                  ///< why one is missing; empty when both are there
  std::optional<double> error() const; ///< error_percent() of both
};
MeasuredPair measured_pair(const Solutions& solutions, const JobPair& jobs, const std::string& measure);

} // namespace springproof::compare
