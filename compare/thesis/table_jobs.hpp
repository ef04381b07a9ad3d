#pragma once

#include "compare/solve/solve_jobs.hpp"
#include "compare/thesis/published.hpp"
#include "compare/thesis/results.hpp"

#include <map>
#include <string>
#include <vector>

/// Which solves stand behind a published figure, and the command that repeats them.
namespace springproof::compare {

/// A finite-element side that a figure is held against.
struct FemChoice {
  cases::Formulation formulation;
  cases::Element element;
  bool is_declared; ///< by the case file
  std::string name() const;
};

/// The case file's own [fem] first. The linear elastic figures in print come from two: log strain and small
/// strain, both with B-bar; whichever is not declared is the other.
std::vector<FemChoice> references_of(const PublishedFigure& figure);

/// Path below cases_folder() of the case behind a figure of chapters 4.3 and 5.3.
std::string case_file_of(const PublishedFigure& figure);

SolveJob fem_job(const PublishedFigure& figure, const FemChoice& reference);

/// With the springs of the thesis: those that it prints (the bar's case files scale them to their cells),
/// else those of its method.
SolveJob thesis_msm_job(const PublishedFigure& figure);

/// With springs that a method designs from the figure's own material, whatever the thesis designed from.
SolveJob designed_msm_job(const PublishedFigure& figure, const std::string& design);

/// How to run both jobs of one case at once.
Trace trace_of(const SolveJob& fem, const SolveJob& msm);

/// The words of a command line, quoted for a shell where needed.
std::string shell_command(const std::vector<std::string>& words);

/// Solves that are shared: each is done once, however many figures stand on it. Whoever needs one asks for
/// it, twice: before solve() to have it solved (the answer is empty then), and after it to use it. So the
/// same function says what it needs and what it makes of it; it must not ask for less or more the second
/// time.
class SolveSet {
 public:
  const Comparison& get(const SolveJob& job);
  void solve(const SolveOptions& options, const std::function<void(int done, int all)>& progress);
  double seconds(cases::Side side) const; ///< summed over all solves of that side alone
  std::size_t size() const { return solves_.size(); }

 private:
  std::map<SolveJob, Comparison> solves_;
  bool is_solved_ = false;
};

} // namespace springproof::compare
