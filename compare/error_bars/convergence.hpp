#pragma once

#include "compare/solve/solve.hpp"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

/// The errors that meshes and steps in time leave, and the measures of both models with them.
namespace springproof::compare {

/// What a quantity's values on a sequence of uniformly refined meshes tell of its limit.
struct MeshLimit {
  double order;         ///< observed: p = ln((f3 - f2)/(f2 - f1)) / ln r, f1 on the finest mesh
  double extrapolated;  ///< Richardson: f0 = f1 + (f1 - f2)/(r^p - 1), in the quantity's unit
  double index_percent; ///< grid convergence index of the finest mesh: 1.25 |(f1 - f2)/f1| / (r^p - 1) x 100
};

/// The limit, or why there is none.
using MeshVerdict = std::variant<MeshLimit, std::string>;

/// Judges the three finest values of a sequence.
/// @param coarse_to_fine  three or more values, each mesh refined from the one before
/// @param ratio           ratio of mesh widths, > 1
/// @return a reason instead of a limit if a value is not finite, if the values oscillate or do not draw
/// nearer to each other, if they agree to 1e-9 of their size (there is nothing left to extrapolate), or
/// if the finest is zero. Source: P. J. Roache, Perspective: a method for uniform reporting of grid
/// refinement studies, J. Fluids Eng. 116 (1994).
MeshVerdict judge_refinement(const std::vector<double>& coarse_to_fine, double ratio);

/// Error bar of a value on any of the meshes: 1.25 |(f - f0)/f| x 100, which on the finest is the grid
/// convergence index.
double discretisation_error_percent(double value, const MeshLimit& limit);

/// A quantity's limit as the meshes that there are let it be known.
struct Limit {
  double value;       ///< in the quantity's unit
  double uncertainty; ///< >= 0, in the same unit: the limit is expected within value -+ uncertainty
  std::string note;   ///< how it was found; empty: extrapolated with an order that two steps confirm
  /// Whether the last two changes show no convergence: of opposite sign, or of an order that the elements do
  /// not have. Two parts of the error then nearly cancel, and one more mesh has to show where the values go.
  bool turns = false;
};

/// The limit of a sequence, or why none is approached. From three meshes that draw nearer to each other the
/// extrapolated value, with Roache's factor of 1.25 times its distance to the finest value once the mesh
/// before shows the same order to within 0.3, and of 3 as long as the order is not confirmed (Oberkampf and
/// Roy, Verification and Validation in Scientific Computing, 2010, section 8.7); an observed order above
/// `highest_order` counts as that. From two meshes the finest value -+ three times the last change: the order
/// 1 is assumed, the least that an edge of the boundary leaves. Where the values turn, the finest value -+
/// the larger of the last two changes.
/// @param coarse_to_fine  one value or more, of meshes each of half the width of the one before
/// @param highest_order   what an observed order above it counts as
/// @param formal_order    the elements': values whose observed order is more than 0.3 above it turn
std::variant<Limit, std::string> find_limit(const std::vector<double>& coarse_to_fine,
                                            double highest_order = 2, double formal_order = 2);

/// The same of a field of vectors on nodes that all meshes have. The order is that of the distances in the
/// norm, so that the field is extrapolated as a whole.
struct FieldLimit {
  std::vector<Eigen::Vector3d> value;
  std::vector<Eigen::Vector3d> uncertainty; ///< whose norm, in any norm, is the uncertainty in that norm
  std::string note;
  bool turns = false; ///< as of Limit
};
using FieldNorm = std::function<double(const std::vector<Eigen::Vector3d>&)>;
std::variant<FieldLimit, std::string>
find_limit(const std::vector<const std::vector<Eigen::Vector3d>*>& coarse_to_fine, const FieldNorm& norm,
           double formal_order = 2);

/// One measure on the meshes of a study.
struct StudiedMeasure {
  std::string name;
  std::vector<double> values;     ///< from coarse to fine, in the measure's unit
  std::optional<MeshLimit> limit; ///< limit of the three finest meshes; absent when no order is seen
  /// Error bar of the finite elements' value on the case's own mesh; absent with the order.
  std::optional<double> discretisation_error_percent;
  std::string reason;               ///< why no order is to be seen; empty when one is
  std::optional<Limit> reference{}; ///< what the springs are held against; absent when no limit is approached
  std::string no_reference{};       ///< why; empty when there is one
};

/// The finite elements' own error, from the same case on uniformly refined meshes.
struct MeshStudy {
  std::vector<int> refine; ///< refinements of the body's mesh, ascending
  std::vector<std::size_t> unknowns;
  std::vector<StudiedMeasure>
      measures; ///< all of the case's, in its order; without values when nothing was solved
  std::optional<FieldLimit> field{}; ///< limit of the displacement, for measures that are norms of it
};

/// What the answers on refined meshes tell of the finite elements' own error, measure by measure.
/// @param meshes  the scene's, its own among them   @param own_refine  the scene's own refinement
MeshStudy study_meshes(const cases::Scene& scene, const RefinedMeshes& meshes, int own_refine);

/// A measure on both sides. A side that failed or was skipped has no value; values are finite.
///
/// The reference is the limit of the finite elements under refinement where the case has one and its study
/// shows it, else the finite elements on the case's own mesh. Errors are (value - reference)/reference; a
/// field norm's is taken of the difference of the fields, and never negative.
struct MeasuredValue {
  std::string name, unit;
  std::optional<double> fem, msm;      ///< in the unit
  std::optional<double> error_percent; ///< springs against the reference
  std::optional<double> peer{};        ///< another program's value, when it was asked
  std::optional<Limit> fem_limit{};    ///< the reference, in the unit; absent: the same mesh is the reference
  std::optional<double> error_uncertainty_percent{}; ///< points, left by the limit; absent without it
  std::optional<double> error_same_mesh_percent{};   ///< springs against the finite elements' value
  std::optional<double> fem_error_percent{}; ///< finite elements' value against the limit; absent without it
  /// Estimate of what interpolation from another mesh adds to the springs' value, in the unit, and to their
  /// error, points; for a field norm, the norm of that field. Absent where nothing was interpolated.
  std::optional<double> interpolation_error{}, interpolation_error_percent{};
  /// Why a side that has an answer has no value, such as a frequency of what does not swing; empty: it has
  /// one.
  std::string fem_reason{}, msm_reason{};
};

/// All measures of a case, in its order; after them, of a dynamic case with [surface], that surface's
/// (cases::surface_measure), without values unless both models moved to the end.
/// @param study  study of the same case; null: there is none
std::vector<MeasuredValue> measure(const cases::Scene& scene, const Answers& answers, const MeshStudy* study);

/// A model's value of a measure with the case's step and with half of it.
struct HalvedStep {
  double value, half_step; ///< with the case's step and half of it, in the measure's unit
  double extrapolated;     ///< Richardson's, by the order p of the study: f0 = f2 + (f2 - f1)/(2^p - 1)
  std::optional<double> error_percent; ///< `value` against that; none where it is 0 but for rounding
};

struct TimeError {
  std::string measure, unit;
  std::optional<HalvedStep> fem,
      msm; ///< absent where the model failed, was not asked for, or has no such value
};

/// Order in the step of a motion: that of the scheme; 1 where a load jumps on the way, or a tool may meet the
/// body: the step in which it happens has the load of one side for a part of its length, which moves the
/// jump by that part.
int order_in_time(const cases::Scene& scene);

struct TimeStudy {
  int order = 1;          ///< order_in_time()
  bool has_jumps = false; ///< a load jumps on the way
  bool has_tools = false;
  std::vector<TimeError> errors;       ///< one per measure
  std::vector<std::string> failures{}; ///< a sentence for each model that failed with half the step
};

/// A dynamic case's scene with half its step, which writes the same bodies.
cases::Scene with_half_the_step(cases::Scene scene);

/// @throws InputError if the case has no [dynamics], or a model whose steps are left unsolved
void check_time_study(const cases::Scene& scene, const Request& request);

/// Solves a dynamic case once more with half its step. Collective over MPI_COMM_WORLD.
/// @param answers  those to the case as it is
/// @throws InputError as check_time_study()
TimeStudy study_time(const cases::Scene& scene, const Answers& answers, const Request& request,
                     SolveFem solve_fem);

void write_time_study_text(std::ostream& out, const TimeStudy& study);

/// {"order", "load_jumps", "failures": [...], "measures": [{"measure", "unit", "fem": {"value", "half_step",
/// "extrapolated", "error_percent"} or null, "msm"}]}
nlohmann::ordered_json time_study_to_json(const TimeStudy& study);

} // namespace springproof::compare
