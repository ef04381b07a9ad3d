#pragma once

#include "compare/gates/comparison.hpp"
#include "compare/write/json.hpp"

#include <iosfwd>

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
  std::vector<MeasuredValue> measures{};
  std::vector<Gate> gates{}; ///< of the case's expectations; empty when it was refused
};

struct Ranking {
  std::string case_name;
  cases::Fem resolved;                 ///< [fem] of the reference
  Answer fem;                          ///< without its fields
  std::vector<RankedDesign> designs{}; ///< by worst error, then those that failed, then those refused
  std::vector<Gate> gates{}; ///< of the case's expectations, by the case's own design; where that is not
                             ///< among the designs, what is expected of springs is not judged

  /// The stable design of the smallest worst error and those whose error bars meet its own.
  std::vector<const RankedDesign*> best() const;
  /// Of the best: one whose lattice has the material's moduli before others, then the fastest; null when
  /// there is none.
  const RankedDesign* recommended() const;
  /// The success of `run --designs`: a design is recommended, and no expectation is missed.
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

/// A table, and a sentence that names the design to use.
void write_ranking_text(std::ostream& out, const Ranking& ranking);

/// What a case's own springs come to, in a sentence: their worst errors, with the reference's uncertainty,
/// and the finite elements' own, of the measures whose limit is known; or why there is nothing to compare.
std::string verdict_of(const Comparison& comparison);

/// The sentence: the design, its numbers as the table has them, the finite elements' own error as far as it
/// is known, what the reference's uncertainty does not tell it from, and why it and not those.
std::string advice_of(const Ranking& ranking);

nlohmann::ordered_json ranking_to_json(const Ranking& ranking);

} // namespace springproof::compare
