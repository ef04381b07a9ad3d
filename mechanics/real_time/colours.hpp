#pragma once

#include "mechanics/grid/field.hpp"

#include <vector>

/// Work on the terms, cells or nodes of a body one after the other, and on several at a time where the order
/// makes no difference.
namespace springproof::mechanics {

/// Items in an order: those of a colour touch nothing in common, and may be worked on at once.
using Colours = std::vector<std::vector<int>>;

/// Gives each item, in order, the first colour whose items touch nothing that it touches.
/// @param touched  by each item: numbers below n_things
Colours colour(const std::vector<std::vector<int>>& touched, std::size_t n_things);

/// action(item) for all items, colour after colour. The result does not depend on the number of threads.
template<class Action>
void for_each_item(const Colours& colours, int n_threads, const Action& action) {
  for (const std::vector<int>& items : colours)
    grid::on_threads(
        static_cast<std::ptrdiff_t>(items.size()), n_threads,
        [&](std::ptrdiff_t i) { action(static_cast<std::size_t>(items[std::size_t(i)])); }, 16);
}

} // namespace springproof::mechanics
