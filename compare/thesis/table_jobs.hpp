#pragma once

#include "compare/cube/cube_benchmark.hpp"
#include "compare/solve/solve_jobs.hpp"
#include "compare/thesis/published.hpp"

#include <map>

/// The solves behind a published figure, and the command that repeats them.
namespace springproof::compare {

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

/// Against a reference, with the springs of the thesis: the published ones (the bar's case files scale them
/// to their cells), else those of its method.
JobPair thesis_jobs(const PublishedFigure& figure, const FemChoice& reference);
/// Against the declared reference.
JobPair thesis_jobs(const PublishedFigure& figure);

/// Against the declared reference, with springs that a method designs from the figure's own material,
/// whatever the thesis designed from.
JobPair designed_jobs(const PublishedFigure& figure, const std::string& design);

/// How to run both jobs of one case at once.
Trace trace_of(const JobPair& jobs);

/// The words of a command line of the program, quoted for a shell where needed.
std::string shell_command(const std::vector<std::string>& words);

/// The jobs solved, each once, however many figures share it.
using Solutions = std::map<SolveJob, Comparison>;

} // namespace springproof::compare
