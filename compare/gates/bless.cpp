#include "compare/gates/bless.hpp"

#include "cases/case/error.hpp"
#include "compare/provenance/whole_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <sstream>

namespace springproof::compare {

namespace {

/// Two digits finer than the interval is wide, so that the rounding does not matter; all digits of an
/// interval without width.
std::string written(double end, double width) {
  if (!(width > 0)) return fmt::format("{}", end);
  const int decimals = std::max(0, 2 - static_cast<int>(std::floor(std::log10(width))));
  return fmt::format("{:.{}f}", end, decimals);
}

[[noreturn]] void refuse_place(const cases::Where& where) {
  throw cases::InputError(where, "no interval stands here any more, so that it cannot be blessed");
}

/// Where a place of the case reader stands in the text: lines count from 1, and columns count characters, of
/// which UTF-8 writes some as several bytes.
std::size_t offset_of(const std::string& text, const cases::Where& where) {
  std::size_t at = 0;
  for (int line = 1; line < where.line && at != std::string::npos; ++line) {
    at = text.find('\n', at);
    if (at != std::string::npos) ++at;
  }
  const auto is_continuation = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  for (int column = 1; column < where.column && at < text.size(); ++column) do
      ++at;
    while (at < text.size() && is_continuation(text[at]));
  if (!(at < text.size()) || text[at] != '[') refuse_place(where);
  return at;
}

/// A part of a text, and what it is replaced by.
struct Piece {
  std::size_t begin, end;
  std::string replacement;
};

/// Where the numbers behind an opening bracket stand, up to the closing one. An array may go over several
/// lines, and hold comments, which may hold anything.
std::vector<Piece> numbers_in(const std::string& text, std::size_t bracket) {
  const std::string between = " \t\r\n,";
  std::vector<Piece> numbers;
  for (std::size_t at = bracket + 1; at < text.size() && text[at] != ']';) {
    if (text[at] == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (between.find(text[at]) != std::string::npos) {
      ++at;
    } else {
      const std::size_t end = std::min(text.find_first_of(between + "]#", at), text.size());
      numbers.push_back({at, end, ""});
      at = end;
    }
  }
  return numbers;
}

/// The text of a case file with some intervals replaced.
std::string with_intervals(const std::string& text, const std::vector<BlessedInterval>& blessed) {
  std::vector<Piece> pieces;
  for (const BlessedInterval& next : blessed) {
    std::vector<Piece> ends = numbers_in(text, offset_of(text, next.where));
    if (ends.size() != 2) refuse_place(next.where);
    for (std::size_t e = 0; e < 2; ++e)
      ends[e].replacement = written(next.interval[e], next.interval[1] - next.interval[0]);
    pieces.insert(pieces.end(), ends.begin(), ends.end());
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.begin > b.begin; });
  std::string result = text;
  for (const Piece& piece : pieces) result.replace(piece.begin, piece.end - piece.begin, piece.replacement);
  return result;
}

/// The lines that two texts of equally many lines differ in.
std::string changed_lines(const std::string& path, const std::string& before, const std::string& after) {
  std::istringstream old_lines(before), new_lines(after);
  std::string text = fmt::format("--- {0}\n+++ {0}\n", path), removed, added;
  for (int n = 1; std::getline(old_lines, removed) && std::getline(new_lines, added); ++n)
    if (removed != added) text += fmt::format("@@ -{0} +{0} @@\n-{1}\n+{2}\n", n, removed, added);
  return text;
}

} // namespace

std::vector<BlessedInterval> intervals_to_bless(const Comparison& judged) {
  std::vector<BlessedInterval> blessed;
  for (const Gate& gate : judged.gates) {
    const cases::Expectation& expected = gate.expectation;
    if (expected.reference != cases::ReferenceKind::regression || gate.met() || !gate.value) continue;
    const double half = (expected.interval[1] - expected.interval[0]) / 2;
    blessed.push_back({expected.interval_where, {*gate.value - half, *gate.value + half}});
  }
  return blessed;
}

std::string bless(const Comparison& judged) {
  const std::vector<BlessedInterval> blessed = intervals_to_bless(judged);
  if (blessed.empty()) return "";
  const std::string before = read_file(judged.scene.definition.file);
  const std::string after = with_intervals(before, blessed);
  write_file(std::filesystem::canonical(judged.scene.definition.file),
             [&](std::ostream& out) { out << after; });
  return changed_lines(judged.scene.definition.file, before, after);
}

bool has_regression(const cases::Case& definition) {
  return std::any_of(
      definition.expectations.begin(), definition.expectations.end(),
      [](const auto& expected) { return expected.reference == cases::ReferenceKind::regression; });
}

} // namespace springproof::compare
