#pragma once

#include "compare/gates/comparison.hpp"

/// Which springs to use for a case: its finite elements solved once, every design that applies held against
/// them. `run CASE --designs`.
namespace springproof::compare {

/// What one design comes to. Exactly one of refusal, failure and worst is there.
struct RankedDesign {
  std::string name;
  std::string refusal{}; ///< why it does not apply to the case
  std::string failure{}; ///< why there is no equilibrium under the whole load, or no error
  std::string springs{}; ///< as springs_text() has them
  std::optional<double> worst{}, worst_volume{}; ///< of |error|, percent; of all but volumes, where there are
                                                 ///< others, and of volumes
  std::string worst_at{};                        ///< the measure
  std::optional<double> worst_bar{};             ///< points: what the reference's uncertainty leaves of worst
  bool is_stable = false;                        ///< in a stable equilibrium without inverted cells
  std::optional<double> misfit{}; ///< msm::ModuliMisfit::largest of the lattice, where it is known
  double milliseconds = 0;        ///< design, setup and solve
  std::optional<double> milliseconds_a_step{}; ///< for a motion
  std::vector<MeasuredValue> measures{};
  std::vector<Gate> gates{}; ///< of the case's expectations; empty when it was refused
  bool is_sound = false;     ///< Comparison::is_sound(); false when it was refused

  /// Whether the lattice is known to have the material's moduli.
  bool has_moduli() const { return misfit && *misfit <= msm::told_moduli_misfit; }
};

struct Ranking {
  std::string case_name;
  cases::Fem resolved;                 ///< [fem] of the reference
  Answer fem;                          ///< without its fields
  std::vector<RankedDesign> designs{}; ///< by worst error, then those that failed, then those refused
  std::vector<Gate> gates{}; ///< of the case's expectations, by the case's own design; where that is not
                             ///< among the designs, what is expected of springs is not judged
  bool is_case_sound = true; ///< Comparison::is_sound() of the finite elements and the case's own design;
                             ///< where that is not among the designs, of the finite elements

  /// The stable design of the smallest worst error and those whose error bars meet its own.
  std::vector<const RankedDesign*> best() const;
  /// Of the best: one whose lattice has the material's moduli before others, then the fastest; null when
  /// there is none.
  const RankedDesign* recommended() const;
  /// The success of `run --designs`: the case itself is sound, and some design has an answer. Another design
  /// that is refused or fails is a row of the ranking with its reason, and no failure of the command.
  bool is_sound() const;
};

/// Solves the finite elements of a scene once, and its springs by every design. The case's own design keeps
/// the case's settings, others have their defaults. Collective over MPI_COMM_WORLD; springs are solved on
/// rank 0, the ranking of the other ranks has no designs.
/// @param meshes  of the finite elements' limit, as in Request
/// @throws InputError when the case has no measure
Ranking rank_designs(const cases::Scene& scene, const std::vector<cases::Design>& designs, int meshes = 0);

/// The same with finite elements that were solved before; all of them must be here.
Ranking rank_designs(const cases::Scene& scene, const std::vector<cases::Design>& designs,
                     const Answers& fem);

/// Puts designs into the order of a ranking.
void sort_by_error(std::vector<RankedDesign>& designs);

/// Adds the worst errors of the measures that have one.
void add_errors(RankedDesign& ranked, const Comparison& comparison);

} // namespace springproof::compare
