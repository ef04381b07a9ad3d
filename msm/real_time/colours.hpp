#pragma once

#include "mechanics/real_time/colours.hpp"
#include "msm/lattice.hpp"

/// The terms of a lattice as items to be coloured.
namespace springproof::msm {

/// The nodes of all terms, kind after kind.
inline std::vector<std::vector<int>> nodes_of_terms(const Lattice& lattice) {
  std::vector<std::vector<int>> all;
  for_each_kind(lattice, [&](const auto& terms) {
    for (const auto& term : terms) {
      const auto nodes = nodes_of(term);
      all.emplace_back(nodes.begin(), nodes.end());
    }
  });
  return all;
}

/// action(term) for the term of a number in nodes_of_terms().
template<class Action>
void with_term(const Lattice& lattice, std::size_t number, const Action& action) {
  bool is_found = false;
  for_each_kind(lattice, [&](const auto& terms) {
    if (is_found) return;
    is_found = number < terms.size();
    if (is_found)
      action(terms[number]);
    else
      number -= terms.size();
  });
}

} // namespace springproof::msm
