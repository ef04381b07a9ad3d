#pragma once

#include "compare/gates/comparison.hpp"
#include "compare/peers/getfem.hpp"
#include "compare/table/json.hpp"

#include <ostream>

/// Limits of an independent program's own meshes beside ours: a second code, with elements, refinement,
/// quadrature and a solver of its own.
namespace springproof::compare {

struct PeerLimit {
  std::string measure, unit;
  std::optional<Limit> ours;                        ///< in the unit; absent: the case has none
  std::optional<Limit> peer;                        ///< likewise
  std::string reason;                               ///< why the peer has none; empty: it has one
  std::optional<double> difference_percent() const; ///< (peer - ours)/ours; absent where one is missing
  /// Whether the difference is at most the sum of both uncertainties.
  std::optional<bool> is_within_bars() const;
};

struct PeerStudy {
  std::string program;
  cases::Status status = cases::Status::skipped;
  std::string message; ///< why it was skipped or failed, or why there is no finer mesh
  double seconds = 0;  ///< all meshes together
  std::vector<int> refine;
  std::vector<std::size_t> unknowns; ///< as many
  std::vector<PeerLimit> limits;     ///< one for each measure that displacements tell
};

/// Asks GetFEM about a case that this program has solved. A solve that fails is a failed study.
PeerStudy study_by_getfem(const Comparison& comparison, int most_meshes = most_getfem_meshes);

void write_peer_study_text(std::ostream& out, const PeerStudy& study);

/// {"program", "status", "message", "seconds", "meshes": [{"refine", "unknowns"}], "measures": [{"measure",
/// "unit", "fem_limit", "fem_limit_uncertainty", "limit", "limit_uncertainty", "note", "difference_percent",
/// "within_bars"}]}
Json peer_study_to_json(const PeerStudy& study);

} // namespace springproof::compare
