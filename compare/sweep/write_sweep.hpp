#pragma once

#include "compare/sweep/sweep.hpp"
#include "compare/table/json.hpp"

#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

/// What a sweep's numbers say, and sweeps as text, CSV, JSON and plots, and on one screen; those of motions
/// too. Variants and motions that failed or could not be measured give no points.
namespace springproof::compare {

/// One variant as a point of the plane of time and error.
struct Point {
  std::string name;
  Family family;
  double seconds;       ///< > 0
  double error_percent; ///< >= 0
  /// The method's error with the most cells (in time: on its finest mesh with the shortest step), where that
  /// is clearly larger: then errors of mesh and model cancel here, by accident. At a rate it is the error of
  /// the same springs in equilibrium, which steps leave unsolved.
  std::optional<double> more_cells_percent{};
  double step = 0; ///< a motion's, s
};

Family other(Family family);

/// The points that no other one beats: none is at most as slow and at most as wrong. Of equal ones the first.
/// @return them in the order of time
std::vector<Point> pareto_front(const std::vector<Point>& points);

/// The points of that front, at most `n` of them, spread evenly from the fastest to the most accurate.
std::vector<Point> thinned_front(const std::vector<Point>& points, std::size_t n);

/// The fastest point whose error is at most a level, of one family or of all; of equally fast ones the more
/// accurate.
std::optional<std::size_t> fastest_within(const std::vector<Point>& points, double error_percent,
                                          std::optional<Family> family = std::nullopt);

/// The most accurate point that takes at most a time, of one family or of all; of equally accurate ones the
/// faster.
std::optional<std::size_t> most_accurate_within(const std::vector<Point>& points, double seconds,
                                                std::optional<Family> family = std::nullopt);

/// An error is at its floor when it is within this fraction of the one with the most cells.
constexpr double floor_fraction = 0.1;

/// Whether errors of mesh and model cancel, so that the error is less than more cells leave of it.
bool is_accidental(double error, double with_most_cells);

/// The coarsest level from which on every error is at the floor that refinement leads to. The last level
/// itself: no floor is in sight. Nothing without an error on the last level.
/// @param errors  per level, coarse to fine; where one is missing, no floor reaches across
std::optional<std::size_t> first_level_at_floor(const std::vector<std::optional<double>>& errors);

/// What an error is of.
enum class Error { field, worst_measure };
/// What a time is of.
enum class Clock {
  first_answer, ///< setup and the solve from rest
  re_solve      ///< the solve after a small change of the load, from the displacement before
};

/// "displacement field"; "re-solve after a load change of 5 %".
const char* what(Error error);
const char* what(Clock clock);

/// Largest error of a measure, without sign; nothing when no measure has one.
std::optional<double> worst_measure_error(const SweepRow& row);

/// A motion's first answer is a second of motion. Nothing for a row that lacks a time or an error.
std::optional<Point> point_of(const Sweep& sweep, const SweepRow& row, Error error, Clock clock);
std::vector<Point> points_of(const Sweep& sweep, Error error, Clock clock);

/// Errors of a method at its tightest tolerance, per level of the plan.
std::vector<std::optional<double>> errors_by_level(const Sweep& sweep, const std::string& method,
                                                   Error error);

/// The reference's own uncertainty, percent: of the displacement, or the largest of a measure.
double uncertainty_percent(const Reference& reference, Error error);

/// Names of the methods in the order of the rows.
std::vector<std::string> methods_of(const Sweep& sweep);

/// "springs" or "finite elements".
const char* family_name(Family family);

/// Two digits, or the whole number.
std::string short_number(double value);

/// A time for reading: "0.41 ms", "16 ms", "2.5 s".
std::string time_text(double seconds);

/// Says which model is fastest at an error, and by what factor over the fastest of the other family.
/// @param uncertainty_percent  the reference's own; no model can be told to be within less
std::string fastest_sentence(const std::vector<Point>& points, double error_percent,
                             double uncertainty_percent);

/// Says which model is most accurate at a time.
std::string most_accurate_sentence(const std::vector<Point>& points, double seconds,
                                   double uncertainty_percent);

/// Says where more cells stop helping a design.
/// @param levels  names of the resolutions, coarse to fine     @param errors  percent, one per level
std::string floor_sentence(const std::string& design, const std::vector<std::string>& levels,
                           const std::vector<std::optional<double>>& errors);

/// What a sweep's numbers say, grouped: a heading and its sentences.
struct Conclusions {
  std::string heading;
  std::vector<std::string> sentences;
};
/// Concludes for both errors and both clocks: the fastest at 10, 5 and 1 per cent, the most accurate in 1, 16
/// and 100 ms; and for each error where more cells stop helping the springs.
std::vector<Conclusions> conclusions(const Sweep& sweep);

/// Names for pictures a second the most accurate of the motions whose step is no longer than a picture and
/// that take no longer than the motion itself, and the most accurate of the other family. Where errors of
/// mesh and model cancel in the first, the most accurate in which they do not, too.
std::string interactive_sentence(const Sweep& sweep, double hertz);

/// Sentences at 30, 60 and 500 pictures a second.
std::vector<std::string> interactive_sentences(const Sweep& sweep);

/// A row per variant, the reference, what was left out, and the conclusions.
void write_sweep_text(std::ostream& out, const Sweep& sweep);

/// One row per variant; the header names the columns and their units, and fields without a value are empty.
void write_sweep_csv(std::ostream& out, const Sweep& sweep);

Json sweep_to_json(const Sweep& sweep);

/// Error against time, log-log, as NAME.svg and NAME.png for both errors and both clocks, with the Pareto
/// front, the reference's uncertainty and the floor of each spring design. Of motions one, of the error
/// against computing per second of motion: motion_sweep. Nothing without a reference.
/// @throws InputError as draw()
void plot_sweep(const std::string& folder, const Sweep& sweep);

/// What a sweep found, on one screen: the fastest of springs and finite elements at several errors, the most
/// accurate in real time, speed against error, and what was not solved. All rows are in the files.
/// @param folder  value of `--out`, where the files are; empty: none was given, and what to type is told
void write_sweep_screen(std::ostream& out, const Sweep& sweep, const std::string& folder);

/// Instructions of one call of each kernel, which are the same on every run of the same binary.
struct InstructionCounts {
  std::string instruction_set;                          ///< that of the kernels: valgrind knows no AVX-512
  std::vector<std::pair<std::string, double>> per_call; ///< kernels by name
  std::string reason;                                   ///< why there are none; empty when there are
};

/// Counts the instructions of the springs' kernels with valgrind's callgrind: each runs twice, a few times
/// and a few times more, and the difference is that of the calls alone. The kernels are those that the
/// environment variable SPRINGPROOF_INSTRUCTION_SET names, by default the ones for AVX2.
InstructionCounts count_instructions();

void write_instructions_text(std::ostream& out, const InstructionCounts& counts);
Json instructions_to_json(const InstructionCounts& counts);

/// The total that a callgrind output file ends with: "totals: N" or "summary: N".
/// @throws std::runtime_error when there is none
double callgrind_total(std::istream& in);

} // namespace springproof::compare
