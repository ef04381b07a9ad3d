#pragma once

#include "cases/case/case.hpp"
#include "compare/client/ask_client.hpp"
#include "compare/fit/least_squares.hpp"
#include "compare/solve/solve_jobs.hpp"
#include "compare/table/json.hpp"
#include "msm/design/uniaxial.hpp"

#include <iosfwd>
#include <optional>

/// Values of a model's parameters from data, with what the data leave open and the error on data that the
/// fit did not see: `springproof fit`.
namespace springproof::compare {

/// A datum beside what the fitted model has in its place.
struct FittedDatum {
  std::string place;   ///< "beam.toml, load[0].value[2]=-1", or the strain
  std::string measure; ///< what was measured
  std::string unit;
  int line = 0; ///< in the data's file; 0: there is none
  double value = 0;
  std::optional<double> fitted{};
  bool is_held_out = false;
};

/// Data of one name, together.
struct FittedMeasure {
  std::string measure;
  std::size_t n = 0;
  std::optional<double> error_percent{}; ///< as prediction_error_percent()
  bool is_held_out = false;
};

/// What was fitted, and how well.
struct Fit {
  std::string model; ///< "springs", "finite elements", a client's or a law's name
  std::string data;  ///< name of the data's file, or "limit"
  std::vector<FreeParameter> parameters;
  LeastSquares found;
  std::vector<FittedDatum> rows{};       ///< one for each datum, but for those of a field
  std::vector<FittedMeasure> measures{}; ///< summaries of the data
  std::size_t n_data = 0;                ///< those that were fitted
  bool has_deviations = false;           ///< the data have their standard deviations
  std::size_t n_solves = 0;              ///< number of cases solved, or of a client's answers; 0: a curve's
  HeldOut held_out{};
  std::vector<std::string>
      settings{}; ///< values for `--set`; empty where the fit has none, or no case takes it
};

/// Laws of incompressible materials that a machine's curve is fitted by.
SPRINGPROOF_ENUMERATION(CurveLaw,
                        neo_hookean,   ///< W = mu/2 (I1 - 3)
                        mooney_rivlin, ///< W = C10 (I1 - 3) + C01 (I2 - 3)
                        yeoh,          ///< W = sum_i C_i (I1 - 3)^i
                        ogden          ///< as cases::Ogden
)

/// A law's parameters from a curve, least squares of the nominal stress.
/// @param n_terms  of Yeoh's and Ogden's law    @param name  the curve's file
/// @throws InputError for fewer strains than the law has parameters, and one more
Fit fit_curve(const msm::UniaxialCurve& curve, CurveLaw law, int n_terms, const std::string& name);

/// A datum of a model's answer to a case.
struct Datum {
  std::size_t state;                 ///< index in FitData::states
  cases::Measure measure;            ///< as the case has it, or a marker's displacement
  double value;                      ///< in the measure's unit
  std::optional<double> deviation{}; ///< standard deviation
  int line = 0;
};

/// A surface of the deformed body as it was measured, by its vertices. Distances go from these to the
/// model's surface: a measured surface may be a part of the body's, which the nodes of the rest would be
/// far from, and every vertex has one error of measurement.
struct MeasuredSurface {
  std::string file;
  std::vector<Eigen::Vector3d> points; ///< mm
  Eigen::VectorXd moved;               ///< mm: distances from the body's surface at rest, < 0: inside
  std::optional<double> deviation;     ///< standard deviation of the points along the normal, mm
};

/// @param path  .stl, .obj, .ply or .vtp   @param place  of the data that name it, for messages
/// @throws InputError if it cannot be read, and for a network, which has no surface
MeasuredSurface read_measured_surface(const std::string& path, const cases::Scene& scene,
                                      const std::string& place);

/// Distances of points from the outer surface of a deformed body, mm; < 0: inside.
Eigen::VectorXd distances_from(const cases::Scene& scene, const std::vector<Eigen::Vector3d>& displacement,
                               const std::vector<Eigen::Vector3d>& points);

/// A case with settings of its own, that is solved once for all of its data.
struct FitState {
  std::string file;                  ///< the case's
  std::vector<std::string> settings; ///< KEY=VALUE
  bool is_held_out;
  std::vector<cases::Measure> markers{};
  std::vector<Eigen::Vector3d>
      field{}; ///< displacement of every node, mm, that is to be fitted; may be empty
  std::optional<MeasuredSurface> surface{};

  std::size_t n_beside_data() const { return 3 * field.size() + (surface ? surface->points.size() : 0); }
};

struct FitData {
  std::vector<FitState> states;
  std::vector<Datum> data;
};

/// Cases that data are of.
struct FitCases {
  std::vector<std::string> files, held_out;
  std::vector<std::string> settings; ///< `--set`, for all of them
};

/// Reads data: a table with a heading. Columns are measures of the case by their names, with standard
/// deviations in a column `NAME sigma` or `sigma` for all of a row; keys of the case, such as
/// load[0].value[2], which are set to the row's values; `case`, the case's name where there are several; or
/// x, y, z (mm, at rest) of markers, with any of ux, uy, uz; or `surface`, a file of a measured surface,
/// relative to the data's folder. Empty fields are no data.
/// @param name  the file's, for messages   @throws InputError with the line
FitData read_fit_data(const std::string& text, const std::string& name, const FitCases& cases);

/// A state's scene, with the markers among the measures.
/// @param values  KEY=VALUE of the case, after all other settings
cases::Scene scene_of(const FitCases& all, const FitState& state,
                      const std::vector<std::string>& values = {});

/// The limits of the finite elements' displacement under refinement, as data for springs.
/// @param answer  solves questions    @throws InputError for a case whose limit is not found
FitData limits_as_data(const FitCases& cases, const AnswerQuestions& answer);

/// Whether a free parameter is a client's own, client.NAME: its value takes the place of {NAME} in the
/// client's command, and no case has such a key.
bool is_of_client(const std::string& key);

/// Asks a client with values of its own parameters. Springs that cannot be designed for it are a failure.
Answers ask_with_values(const cases::Scene& scene, const Client& client,
                        const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& values);

/// @throws InputError for a client.NAME without {NAME} in the client's command, or without a client
void check_client_parameters(const std::vector<FreeParameter>& parameters,
                             const std::optional<Client>& client);

/// Fits keys of cases to data, by one model.
/// @param free  KEY or KEY=START; empty: the moduli of the body's material
/// @param client  is asked in place of the springs
/// @throws InputError for a key that is no number in a case, and for data that cannot tell so many keys
Fit fit_cases(const FitCases& cases, const FitData& data, const std::string& data_name,
              const std::vector<std::string>& free, cases::Side side, const AnswerQuestions& answer,
              const std::optional<Client>& client = {});

Json fits_to_json(const std::vector<Fit>& fits);
void write_fit_text(std::ostream& out, const Fit& fit, bool has_rows = true);
void write_fit_csv(std::ostream& out, const std::vector<Fit>& fits);

} // namespace springproof::compare
