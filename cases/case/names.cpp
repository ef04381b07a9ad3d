#include "cases/case/names.hpp"

#include <algorithm>

namespace springproof::cases {

std::vector<std::string> split_enumerators(const char* list) {
  std::vector<std::string> names(1);
  for (; *list != '\0'; ++list)
    if (*list == ',')
      names.emplace_back();
    else if (*list != ' ')
      names.back() += *list;
  return names;
}

template<>
const NameTable<Outcome>& names() {
  static const NameTable<Outcome> table = [] {
    NameTable<Outcome> all;
    for (std::string& name : split_enumerators(enumerators(Outcome{}))) {
      std::replace(name.begin(), name.end(), '_', ' ');
      all.emplace_back(static_cast<Outcome>(all.size()), std::move(name));
    }
    return all;
  }();
  return table;
}

namespace {

/// Least number of insertions, deletions, replacements and exchanges of neighbours that turn a into b
/// (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

} // namespace

std::string alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "\"" : " | \"") + word + "\"";
  return text;
}

std::optional<std::string> nearest_name(const std::string& written, const std::vector<std::string>& known) {
  std::optional<std::string> nearest;
  if (written.size() < 3) return nearest; // a single letter is one edit away from every other
  std::size_t allowed = written.size() / 3;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(written, candidate);
    if (distance > allowed || (nearest && distance == allowed)) continue;
    nearest = candidate;
    allowed = distance;
  }
  return nearest;
}

} // namespace springproof::cases
