#include "compare/gates/bless.hpp"

#include "cases/case/error.hpp"
#include "cases/case/rows.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <sstream>

namespace springproof::compare {

namespace {

/// Two digits finer than the interval is wide, so that the rounding does not matter; all digits of an
/// interval without width, and with an exponent what TOML could not hold as a whole number.
std::string written(double end, double width) {
  if (!(width > 0) || std::abs(end) >= 1e15) return fmt::format("{}", end);
  const int decimals = std::max(0, 2 - static_cast<int>(std::floor(std::log10(width))));
  return fmt::format("{:.{}f}", end, decimals);
}

/// Where a place of the case reader stands in the text: lines count from 1, and columns count characters, of
/// which UTF-8 writes some as several bytes.
std::size_t offset_of(const std::string& text, const cases::Where& where) {
  std::size_t at = 0;
  for (int line = 1; line < where.line && at < text.size(); ++line)
    at = std::min(text.find('\n', at), text.size()) + 1;
  const auto is_continuation = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  for (int column = 1; column < where.column && at < text.size(); ++column) do
      ++at;
    while (at < text.size() && is_continuation(text[at]));
  return std::min(at, text.size());
}

bool is_regression(const cases::Expectation& expected) {
  return expected.reference == cases::ReferenceKind::regression;
}

/// The text of a judged case's file with the intervals that are blessed.
std::string blessed_text(const std::string& text, const Comparison& judged) {
  std::map<std::size_t, std::string, std::greater<>> ends; // by their places, the last one first
  for (const Gate& gate : judged.gates) {
    const cases::Expectation& old = gate.expectation;
    if (!is_regression(old) || gate.met() || !gate.value) continue;
    const double half = (old.interval[1] - old.interval[0]) / 2;
    const std::array<double, 2> interval{*gate.value - half, *gate.value + half};
    for (std::size_t e = 0; e < 2; ++e) {
      const std::size_t at = offset_of(text, old.ends_where[e]);
      std::string number = text.substr(at, text.find_first_of(" \t\r\n,]#", at) - at);
      number.erase(std::remove(number.begin(), number.end(), '_'), number.end()); // TOML's, in long numbers
      if (cases::number_in<double>(number) != old.interval[e])
        throw cases::InputError(old.ends_where[e],
                                "no interval stands here any more, so that it cannot be blessed");
      if (!std::isfinite(interval[e]))
        throw cases::InputError(old.ends_where[e], "the interval is so wide that it cannot be moved");
      ends[at] = written(interval[e], interval[1] - interval[0]);
    }
  }
  std::string result = text;
  for (const auto& [at, number] : ends) result.replace(at, text.find_first_of(" \t\r\n,]#", at) - at, number);
  return result;
}

/// The lines that two texts of equally many lines differ in.
std::string changed_lines(const std::string& path, const std::string& before, const std::string& after) {
  std::istringstream old_lines(before), new_lines(after);
  std::string text = fmt::format("--- {0}\n+++ {0}\n", one_line(path)), removed, added;
  for (int n = 1; std::getline(old_lines, removed) && std::getline(new_lines, added); ++n)
    if (removed != added)
      text += fmt::format("@@ -{0} +{0} @@\n-{1}\n+{2}\n", n, one_line(removed), one_line(added));
  return text;
}

} // namespace

std::string blessed_file(const cases::Case& definition) {
  return std::filesystem::canonical(definition.file);
}

std::string bless(const Comparison& judged) {
  const std::string before = read_file(judged.scene.definition.file);
  const std::string after = blessed_text(before, judged);
  if (after == before) return "";
  write_named_file(blessed_file(judged.scene.definition), [&](std::ostream& out) { out << after; });
  return changed_lines(judged.scene.definition.file, before, after);
}

bool has_regression(const cases::Case& definition) {
  return std::any_of(definition.expectations.begin(), definition.expectations.end(), is_regression);
}

} // namespace springproof::compare
