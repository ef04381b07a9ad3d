#include "mechanics/real_time/colours.hpp"

namespace springproof::mechanics {

Colours colour(const std::vector<std::vector<int>>& touched, std::size_t n_things) {
  Colours colours;
  std::vector<std::vector<bool>> colours_at(n_things); // those of the items that touch a thing
  for (std::size_t item = 0; item < touched.size(); ++item) {
    const auto is_taken = [&](std::size_t one) {
      for (const int thing : touched[item])
        if (one < colours_at[std::size_t(thing)].size() && colours_at[std::size_t(thing)][one]) return true;
      return false;
    };
    std::size_t first = 0;
    while (is_taken(first)) ++first;
    if (first == colours.size()) colours.emplace_back();
    colours[first].push_back(static_cast<int>(item));
    for (const int thing : touched[item]) {
      std::vector<bool>& at = colours_at[std::size_t(thing)];
      if (at.size() <= first) at.resize(first + 1);
      at[first] = true;
    }
  }
  return colours;
}

} // namespace springproof::mechanics
