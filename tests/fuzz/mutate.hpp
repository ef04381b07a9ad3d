#pragma once

#include <array>
#include <random>
#include <sstream>
#include <string>
#include <vector>

/// Damage to case files: what a slip of the keyboard, a bad merge or a broken disk leaves.
namespace fuzz {

using Random = std::mt19937;

/// A number from 0 to n - 1, the same on every machine (unlike the standard's distributions).
inline std::size_t any_of(std::size_t n, Random& random) {
  return n == 0 ? 0 : random() % n;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line + '\n');
  return lines;
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

inline std::string with_flipped_bytes(std::string text, Random& random) {
  for (std::size_t n = 1 + any_of(8, random); n > 0 && !text.empty(); --n)
    text[any_of(text.size(), random)] ^= static_cast<char>(1u << any_of(8, random));
  return text;
}

inline std::string with_line_dropped(const std::string& text, Random& random) {
  std::vector<std::string> lines = lines_of(text);
  if (!lines.empty()) lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(any_of(lines.size(), random)));
  return joined(lines);
}

inline std::string with_line_doubled(const std::string& text, Random& random) {
  std::vector<std::string> lines = lines_of(text);
  if (lines.empty()) return text;
  const std::string line = lines[any_of(lines.size(), random)];
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(any_of(lines.size() + 1, random)), line);
  return joined(lines);
}

/// Replaces one of the text's numbers by one that somebody did not think of.
inline std::string with_number_replaced(std::string text, Random& random) {
  static const std::array<const char*, 16> others{"0",
                                                  "-1",
                                                  "nan",
                                                  "-inf",
                                                  "1e308",
                                                  "1e-320",
                                                  "2147483648",
                                                  "9223372036854775807",
                                                  "99999999999999999999",
                                                  "0.5",
                                                  "-0.0",
                                                  "1_000",
                                                  "0x7fffffff",
                                                  "\"1\"",
                                                  "[1, 2]",
                                                  "{ a = 1 }"};
  std::vector<std::array<std::size_t, 2>> numbers;
  const std::string digits = "0123456789.";
  for (std::size_t at = 0; (at = text.find_first_of(digits, at)) != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_not_of(digits, at), text.size());
    numbers.push_back({at, end - at});
    at = end;
  }
  if (numbers.empty()) return text;
  const auto& [at, size] = numbers[any_of(numbers.size(), random)];
  return text.replace(at, size, others[any_of(others.size(), random)]);
}

inline std::string cut_short(const std::string& text, Random& random) {
  return text.substr(0, any_of(text.size(), random));
}

/// One to four kinds of damage, one after the other.
inline std::string mutated(std::string text, Random& random) {
  for (std::size_t n = 1 + any_of(4, random); n > 0; --n) switch (any_of(9, random)) {
    case 0:
    case 1:
      text = with_flipped_bytes(text, random);
      break;
    case 2:
    case 3:
      text = with_line_dropped(text, random);
      break;
    case 4:
    case 5:
      text = with_line_doubled(text, random);
      break;
    case 6:
    case 7:
      text = with_number_replaced(text, random);
      break;
    default:
      text = cut_short(text, random);
    }
  return text;
}

} // namespace fuzz
