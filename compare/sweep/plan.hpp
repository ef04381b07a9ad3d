#pragma once

#include "compare/sweep/variant.hpp"

#include <vector>

namespace springproof::compare {

enum class Extent { full, quick };

/// Something that a full answer would have and this sweep has not.
struct LeftOut {
  std::string what, reason;
};

/// What a sweep solves.
struct Plan {
  std::vector<std::array<int, 3>> levels; ///< cells, each of twice the level before
  std::vector<Variant> reference; ///< the finite-strain meshes that the truth comes from, coarse to fine
  std::vector<Variant> variants;  ///< the reference's among them
  std::vector<LeftOut> left_out;
};

/// The plan for a case: every spring design at every level and tolerance, small- and finite-strain finite
/// elements (q1, q1_bbar, q2) and CalculiX as far as their unknowns allow. Levels start at half the case's
/// own cells where these are even, at its own otherwise.
/// @throws InputError for a body that is no box or a material without small strain
Plan plan_sweep(const cases::Case& definition, Extent extent);

/// Unknowns of a displacement element on a box, held ones included.
long n_unknowns(const std::array<int, 3>& cells, cases::Element element);

} // namespace springproof::compare
