#pragma once

#include "cases/case/case.hpp"
#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "compare/client/methods.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/solve/estimate.hpp"

#include <array>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

/// Speed against error of a case: springs and finite elements at several resolutions, at rest and in time.
namespace springproof::compare {

/// A number that is known up to an error bar.
struct ReferenceValue {
  std::string name, unit;
  double value;               ///< extrapolated to no mesh width, where there is an order to do that by
  double uncertainty_percent; ///< grid convergence index of the finest mesh
  std::string note;           ///< how it was found when there is no order
};

/// What every variant of a sweep is held against: the finite-strain answer extrapolated from three meshes,
/// each known on the nodes of a grid.
struct Reference {
  cases::Scene scene;       ///< that of the middle grid, on whose nodes displacements are compared
  cases::Solution solution; ///< the extrapolated displacement there
  ReferenceValue field;     ///< the displacement as a whole; its value is the root mean square, mm
  std::vector<ReferenceValue> measures; ///< those of the case, in its order
};

/// Extrapolates by Richardson's rule, measures by what judge_refinement() finds, the displacement by the
/// order of its differences' L2 norms on the coarsest grid's nodes. Without an order the finest mesh's value
/// stands, and its uncertainty is three times the difference to the next mesh: an order of 1 is assumed, with
/// the safety factor that Roache (1994) asks for then.
/// @param definition    its body is a box
/// @param cells         cells of three grids, each with twice those of the one before
/// @param displacement  mm, on the nodes of each
/// @throws InputError if the case's measures have no nodes on the middle grid
Reference make_reference(const cases::Case& definition, const std::array<std::array<int, 3>, 3>& cells,
                         const std::array<std::vector<Eigen::Vector3d>, 3>& displacement);

/// The finite elements' limit on the nodes of a case's own mesh, or where none is known their answer there.
/// @param solved  the finite elements of a case at rest
Reference reference_of(const Comparison& solved);

/// Error of a displacement on another grid of the same box, percent of the reference's: L2 norm of the
/// difference, on the reference's mesh.
/// @param cells  0: the displacement is of the reference's mesh
std::optional<double> field_error_percent(const Reference& reference, const std::array<int, 3>& cells,
                                          const std::vector<Eigen::Vector3d>& displacement);

/// Errors of the case's measures, percent, with their sign; volumes are those of the interpolated
/// displacement.
std::vector<std::optional<double>> measure_errors_percent(const Reference& reference,
                                                          const std::array<int, 3>& cells,
                                                          const std::vector<Eigen::Vector3d>& displacement);

/// The case's scene on a box of that many cells, measures and all.  @throws InputError
cases::Scene scene_on(const cases::Case& definition, const std::array<int, 3>& cells);

/// A field on the nodes of a box's grid, trilinear between them, at the nodes of another grid of the same
/// box.
/// @param field     one vector per node, x fastest
/// @param from, to  cells along x, y, z
std::vector<Eigen::Vector3d> interpolate(const std::vector<Eigen::Vector3d>& field,
                                         const std::array<int, 3>& from, const std::array<int, 3>& to);

SPRINGPROOF_ENUMERATION(Program, springs, finite_elements, calculix)

/// Springs against everything else: what "which model is faster" is about.
enum class Family { springs, finite_elements };

/// One way to answer a case on a box: a model, its resolution, and how exactly its equations are solved, or
/// in which steps it moves.
struct Variant {
  Program program = Program::springs;
  cases::Design design{};           ///< springs
  cases::Formulation formulation{}; ///< finite elements, CalculiX
  cases::Element element{};         ///< finite elements, CalculiX
  std::array<int, 3> cells{};       ///< those of the box, along x, y, z
  /// On |imbalance| / |applied load|; CalculiX has its own, and a sweep at a rate 0: none.
  double tolerance = 1e-9;
  double step = 0;                  ///< a motion's, s; 0: at rest
  std::optional<Steps> real_time{}; ///< there in a sweep at a rate; then cells of 0 are a mesh's own
};

Family family_of(const Variant& variant);

/// What a method of real time steps: "springs hybrid", "q1_bbar elements".
std::string model_name(const Variant& variant);

/// The model without its resolution: "springs hybrid", "log_strain q2", "CalculiX small_strain q1".
std::string method_name(const Variant& variant);

/// "8x8x8"
std::string cells_name(const std::array<int, 3>& cells);

/// The grid on whose nodes a variant knows displacements: that of its cells, for a quadratic element of twice
/// as many.
std::array<int, 3> field_cells(const Variant& variant);

/// Method, cells and tolerance: "springs hybrid 8x2x2 to 1e-09"; of a motion "springs hybrid, 8x2x2 cells,
/// steps of 2 ms"; at a rate "springs hybrid, 8x2x2 cells, xpbd, 1 iteration, 50 substeps" or "q1_bbar
/// elements, 8x2x2 cells, fem.corotational, 10 iterations".
std::string full_name(const Variant& variant);

/// The case as a variant has it, without measures: their nodes need not exist on every mesh.
/// @param definition  its body is a box
cases::Case with_variant(const cases::Case& definition, const Variant& variant);

enum class Extent { full, quick };

/// Something that a full answer would have and this sweep has not.
struct LeftOut {
  std::string what, reason;
};

/// Levels of cells, each of twice the level before: four, of a quick sweep three. They start at half the
/// box's own cells where these are even, at its own otherwise.  @throws InputError for another body
std::vector<std::array<int, 3>> levels_of(const cases::Case& definition, Extent extent);

/// Tolerances (in time: steps) with which a sweep solves springs.
enum class Settings { all, one };

/// A design of springs on one level.
struct SweptSprings {
  cases::Design design{};
  std::array<int, 3> cells{};
  Settings settings{};
};

/// The designs that are made from a material, each on every level. Designs of others are there to be compared
/// with: one setting is enough, and all have the sizes that those of them have that are factorised. A quick
/// sweep has one setting of every design.
/// @param left_out  what is too large is added to it
std::vector<SweptSprings> springs_to_sweep(const cases::Material& material,
                                           const std::vector<std::array<int, 3>>& levels, Extent extent,
                                           std::vector<LeftOut>& left_out);

/// What a sweep solves.
struct Plan {
  std::vector<std::array<int, 3>> levels; ///< cells, each of twice the level before
  std::vector<Variant> reference; ///< the finite-strain meshes that the truth comes from, coarse to fine
  std::vector<Variant> variants;  ///< the reference's among them
  std::vector<LeftOut> left_out;
};

/// The plan for a case: every spring design at every level and tolerance, small- and finite-strain finite
/// elements (q1, q1_bbar, q1_wilson, q2) and CalculiX as far as their unknowns allow, on levels_of() its
/// body.
/// @throws InputError for a body that is no box or a material without small strain
Plan plan_sweep(const cases::Case& definition, Extent extent);

/// How often a variant is timed.
struct TimingRules {
  int repetitions = 5;       ///< after a warm-up
  double budget_seconds = 2; ///< for the repetitions together
};

/// Repetitions that follow a first round of that many seconds: as many as the budget pays for, at most those
/// asked for; 0 when it does not pay for one, and then the first round has to stand for all.
int n_repetitions(double seconds_of_first, const TimingRules& rules);

/// How much the load grows before the re-solve: from 95 to 100 per cent of the case's.
constexpr double load_change = 0.05;

/// A variant's answer, what it took, and how long. Wall-clock seconds, one entry per repetition.
struct VariantRun {
  cases::Solution
      first; ///< from rest, displacement on the grid of field_cells(); failed or skipped with the reason
  cases::Solution again; ///< after the load change, from the displacement before it; without displacement;
                         ///< skipped with the reason when the first solve takes longer than the budget
  std::vector<double> setup_seconds;
  std::vector<double> first_seconds;
  std::vector<double> again_seconds;
  bool is_warm = false;                  ///< a round came before those that were timed
  std::optional<double> peak_megabytes;  ///< resident memory of the process that did nothing else
  std::optional<double> start_megabytes; ///< the same before the model was made
};

/// Solves a variant of a case again and again on one thread. Springs have to be stable under the smaller
/// load, which is looked at once; the solves that are timed do not diagnose stability. Collective over
/// MPI_COMM_WORLD; all but finite elements run on rank 0 alone, where alone their answer is.
/// @throws InputError when the case has no such variant
VariantRun time_variant(const cases::Case& definition, const Variant& variant, const TimingRules& rules);

/// A job of a worker, and its answer with the memory of that process in it.
std::string timing_job(const cases::Case& definition, const Variant& variant, const TimingRules& rules);
std::string answer_timing_job(const std::string& job);
std::string bytes_of(const VariantRun& run);
/// @param answer  any bytes   @throws std::exception if they are no answer, or not this variant's
VariantRun variant_run_from(const std::string& answer, const Variant& variant);

/// One variant, what it took, and how far it is from the truth. Its displacement is no longer kept. A
/// motion's first_seconds are those of computing for a second of motion, in one run without setting up, and
/// its field's error is that of its watched nodes over time. At a rate first_seconds are those of a frame.
struct SweepRow {
  Variant variant;
  VariantRun run;
  std::optional<double> field_error_percent{};
  std::vector<std::optional<double>> measure_error_percent{}; ///< one a measure of the case, with its sign
  std::optional<double>
      in_equilibrium_percent{}; ///< at a rate: the field's, of the same springs in equilibrium
};

enum class Processes { one_per_variant, this_one };

/// What a sweep at a rate is asked for.
struct Rate {
  double hertz;
  double budget_seconds = 60; ///< the search's, beside its reference
};

/// Speed against error of one case: one plain record, which the writers read.
struct Sweep {
  cases::Case definition;
  std::vector<std::string> settings{}; ///< what `--set` has set in the definition
  Plan plan;
  TimingRules rules;
  Processes processes = Processes::one_per_variant;
  int n_ranks = 1;
  std::optional<Rate> rate{};
  std::vector<SweepRow>
      rows; ///< one a variant of the plan, in its order; at a rate, of those followed through
  std::optional<Reference> reference;
  std::string reason_without_reference;
  double seconds = 0; ///< that the sweep took
};

/// Whether the reference was solved, and of the other models or motions, if there are any, one at least.
bool has_answer(const Sweep& sweep);

/// A sweep without rows.
/// @param budget_seconds  see cut_to_budget(); nothing: the plan as it is
/// @throws InputError for a case without a continuum limit, with another body than a box, or with measures
/// that the reference's mesh does not have
Sweep make_sweep(const cases::Case& definition, Extent extent, const TimingRules& rules,
                 const std::optional<double>& budget_seconds = std::nullopt);

/// Solves and times the plan's variants one after the other, each in a process of its own, and holds them
/// against the extrapolated reference. A variant that fails is a row with its reason. A quick sweep, and any
/// under MPI, runs in this process, and then memory is not told (collective; rank 0 alone has the springs'
/// rows).
/// @param sweep    made by make_sweep()
/// @param program  whose hidden command `worker` serves
/// @param on_row   called with the sweep as it is after every variant
Sweep run_sweep(Sweep sweep, const std::string& program, const std::function<void(const Sweep&)>& on_row);

/// Estimates one variant; seconds with all its rounds.
Estimate estimate_of(const Sweep& sweep, const Variant& variant);
/// Estimates each variant, in the order of the plan.
std::vector<double> estimated_seconds(const Sweep& sweep);

/// Leaves out the variants of the longest estimated times until the others fit into the budget, each with the
/// reason. The reference's meshes stay, whatever they take.
void cut_to_budget(Sweep& sweep, double budget_seconds);

/// @throws InputError if a variant needs more memory than there is
void check_memory(const Sweep& sweep);

/// A line per method: variants, the largest one's unknowns and memory, seconds of all; then what is left out.
void write_plan(std::ostream& out, const Sweep& sweep);

/// The steps that a sweep in time takes, in those of the case.
constexpr std::array<double, 3> step_factors{2, 1, 0.5};

/// Springs of the designs that a sweep takes (springs_to_sweep()), the case's own with its settings and the
/// others with their defaults, and the case's finite elements, on levels_of() its body, with twice, once and
/// half the case's step or with that one alone, against the finite-strain motion on the finest level by
/// generalized_alpha with a quarter of the step. One after the other in this process. Of the reference its
/// field has a note, which says what it is, and the uncertainty: what the last halvings of its cells and of
/// its step changed, together.
/// @param on_row  called with the sweep as it is after every motion
/// @throws InputError for a body that is no box, a case without measures of nodes, or with nodes that a level
/// has not or that do not move; SolveError when the reference fails
Sweep sweep_motion(const cases::Case& definition, Extent extent,
                   const std::function<void(const Sweep&)>& on_row);

/// Levels of the cells, of a case that can be swept in time.
/// @throws InputError
std::vector<std::array<int, 3>> levels_in_time(const cases::Case& definition, Extent extent,
                                               std::vector<LeftOut>& left_out);

/// What all motions of a sweep are held against. Its uncertainty is added to the sweep.
/// @param step  s, four of the reference's
/// @throws InputError when it does not move; SolveError
cases::Trajectory add_reference_motion(Sweep& sweep, const std::vector<std::array<int, 3>>& levels,
                                       double step);

/// Difference of two motions of equal nodes at the times of the second that both have, percent of the
/// first's: root mean squares over times and nodes.
std::optional<double> motion_error_percent(const cases::Trajectory& reference,
                                           const cases::Trajectory& other);

} // namespace springproof::compare
