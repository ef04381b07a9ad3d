#pragma once

#include "compare/gates/comparison.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

/// Springs of several kinds held against finite elements that were solved once: the designs of `run CASE
/// --designs`, of the cube benchmark and of the advice of `tables`.
namespace springproof::compare {

/// Worst and mean of |error| over errors that are added one by one: of measures, tests, figures or modes.
/// Every worst error of the program is found here.
struct WorstError {
  int n = 0;
  double total = 0;
  std::optional<double> worst{};
  std::size_t place = 0; ///< place of the worst, as its caller counts

  /// @param error  finite    @return whether it is the worst so far; of equal ones the first
  bool add(double error, std::size_t at = 0) {
    const double size = std::abs(error);
    ++n;
    total += size;
    if (worst && size <= *worst) return false;
    worst = size;
    place = at;
    return true;
  }
  std::optional<double> mean() const { return n > 0 ? std::optional(total / n) : std::nullopt; }
};

/// One way to answer a case. Exactly one of refusal, failure and worst is there.
struct Trial {
  std::string name;      ///< what was varied: the design
  std::string refusal{}; ///< why it does not apply to the case
  std::string failure{}; ///< why there is no equilibrium under the whole load, or no error
  std::string springs{}; ///< as springs_text() has them
  std::optional<double> worst{}, worst_volume{}; ///< largest |error|, percent, of measures (but volumes,
                                                 ///< where there are others) and of volumes
  std::string worst_at{};                        ///< the measure
  std::optional<double> worst_bar{};             ///< points: what the reference's uncertainty leaves of worst
  bool is_stable = false;                        ///< see the function
  std::optional<double> misfit{}; ///< msm::ModuliMisfit::largest of the lattice, where it is known
  double milliseconds = 0;        ///< design, setup and solve
  std::optional<double> milliseconds_a_step{}; ///< for a motion
  std::vector<MeasuredValue> measures{};
  std::vector<Gate> gates{}; ///< one per expectation of the case; empty when it was refused
  bool is_sound = false;     ///< Comparison::is_sound(); false when it was refused

  /// Whether the lattice is known to have the material's moduli.
  bool has_moduli() const { return misfit && *misfit <= msm::told_moduli_misfit; }
};

constexpr double milliseconds_a_picture = 1e3 / 60; ///< a screen of 60 Hz has a step for each of its pictures

/// Mean over the steps of a motion, without the setup; nothing for what did not move to the end.
std::optional<double> milliseconds_a_step(const Answer& answer);

/// What a comparison comes to, with the worst errors of the measures that have one.
Trial trial_of(const Comparison& comparison);

/// Holds springs against finite elements that were solved apart from them.
/// @param scene  scene of the springs    @param fem, springs  answers, of which the side of that name is
/// taken; all of them must be here
Comparison compare_sides(cases::Scene scene, const Answers& fem, const Answers& springs);

/// Solves a scene's springs in this process and holds them against its finite elements.
/// @throws InputError when no springs can be designed, or need more memory than there is
Comparison try_springs(const cases::Scene& scene, const Answers& fem);

/// Solves the finite elements that springs are held against. Collective over MPI_COMM_WORLD.
/// @param meshes  meshes for the finite elements' limit, as in Request    @return all of them on every rank
Answers solve_reference(const cases::Scene& scene, int meshes = 0);

/// Whether springs converged to a stable equilibrium without inverted cells; the end of a motion, and
/// where one comes to rest, need not be stable.
bool is_stable(const cases::Solution& springs);

/// The numbers by which trials are ranked.
struct Standing {
  std::optional<double> worst{}; ///< |error|, percent; absent where there is none, or the trial is not stable
  double bar = 0;                ///< points: what the reference's uncertainty leaves of it
  bool has_moduli = false;       ///< the material's, in its lattice
  double milliseconds = 0;
};

/// The trial of the smallest worst error, the first of equal ones, and those whose error bars meet its own,
/// in the order of their errors.
std::vector<std::size_t> best_of(const std::vector<Standing>& trials);

/// The one of best_of() to be used: one whose lattice has the material's moduli before others, then the
/// fastest; nothing when there is none.
std::optional<std::size_t> recommended_of(const std::vector<Standing>& trials);

/// The designs of a case, each held against the same finite elements.
struct Ranking {
  std::string case_name;
  cases::Fem resolved;          ///< [fem] of the reference
  Answer fem;                   ///< without its fields
  std::vector<Trial> designs{}; ///< by worst error, then those that failed, then those refused
  std::vector<Gate> gates{};    ///< the case's expectations, by the case's own design; where that is not
                                ///< among the designs, what is expected of springs is not judged
  bool is_case_sound = true;    ///< Comparison::is_sound() of the finite elements and the case's own design;
                                ///< where that is not among the designs, of the finite elements

  std::vector<const Trial*> best() const;
  const Trial* recommended() const; ///< null when there is none
  /// The success of `run --designs`: the case itself is sound, and some design has an answer. Another design
  /// that is refused or fails is a row of the ranking with its reason, and no failure of the command.
  bool is_sound() const;
};

/// Solves the finite elements of a scene once, and its springs by every design. The case's own design keeps
/// the case's settings, others have their defaults. Collective over MPI_COMM_WORLD; springs are solved on
/// rank 0, the ranking of the other ranks has no designs.
/// @param meshes  meshes for the finite elements' limit, as in Request
/// @throws InputError when the case has no measure
Ranking rank_designs(const cases::Scene& scene, const std::vector<cases::Design>& designs, int meshes = 0);

/// The same with finite elements that were solved before; all of them must be here.
Ranking rank_designs(const cases::Scene& scene, const std::vector<cases::Design>& designs,
                     const Answers& fem);

/// Puts designs into the order of a ranking.
void sort_by_error(std::vector<Trial>& designs);

} // namespace springproof::compare
