#include "cases/case/names.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <sstream>

namespace springproof::cases {

const std::vector<std::string> face_names{"x-", "x+", "y-", "y+", "z-", "z+"};

bool are_faces(const std::vector<std::string>& words) {
  return !words.empty() && std::all_of(words.begin(), words.end(),
                                       [](const std::string& word) { return contains(face_names, word); });
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::vector<std::string> split_enumerators(const char* list, char between_words) {
  std::string text(list);
  std::replace(text.begin(), text.end(), ',', ' ');
  std::vector<std::string> names = words_of(text);
  for (std::string& name : names) std::replace(name.begin(), name.end(), '_', between_words);
  return names;
}

namespace {

/// Least number of insertions, deletions, replacements and exchanges of neighbours that turn a into b
/// (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      d[i][j] = std::max(i, j); // all that one of them has, when the other has nothing
      if (i == 0 || j == 0) continue;
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

} // namespace

std::string alternatives(const std::vector<std::string>& words) {
  return words.empty() ? "" : fmt::format("\"{}\"", fmt::join(words, "\" | \""));
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
