#pragma once

#include "mechanics/grid/field.hpp"
#include "msm/lattice.hpp"

/// Work on the terms or nodes of a lattice one after the other, and on several at a time where the order
/// makes no difference.
namespace springproof::msm {

/// Items in an order: those of a colour touch nothing in common, and may be worked on at once.
using Colours = std::vector<std::vector<int>>;

/// Gives each item, in order, the first colour whose items touch nothing that it touches.
/// @param touched  by each item: numbers below n_things
Colours colour(const std::vector<std::vector<int>>& touched, std::size_t n_things);

/// The nodes of all terms, kind after kind.
std::vector<std::vector<int>> nodes_of_terms(const Lattice& lattice);

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

/// action(item) for all items, colour after colour. The result does not depend on the number of threads.
template<class Action>
void for_each_item(const Colours& colours, int n_threads, const Action& action) {
  for (const std::vector<int>& items : colours)
    mechanics::grid::on_threads(
        static_cast<std::ptrdiff_t>(items.size()), n_threads,
        [&](std::ptrdiff_t i) { action(cases::index(items[std::size_t(i)])); }, 16);
}

} // namespace springproof::msm
