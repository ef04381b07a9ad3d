#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// Opens all files of strangers that are read here and not by a library, and reads their numbers and rows.
namespace springproof::cases {

inline constexpr std::uint64_t largest_case = 64'000'000, largest_text = 2'000'000'000,
                               largest_file = 64'000'000'000; ///< bytes

/// All bytes of a regular file. A pipe is read where the command line's shell has made it (/dev/fd/...,
/// /dev/stdin): any other pipe or device may never end.
/// @throws InputError "PATH: ...", also for more bytes than `largest`
std::string read_bytes(const std::string& path, std::uint64_t largest = largest_file);

/// A text in UTF-8, without the mark of its order of bytes that some programs put first.
/// @throws InputError as read_bytes(), and for UTF-16 and other bytes that no text has
std::string read_text_file(const std::string& path, std::uint64_t largest = largest_text);

/// Parses a whole text as a number. Returns nothing for an empty text, a rest behind the number, or a number
/// that the type cannot hold: 4294967296 is no int, and 1e400, inf and nan are no double here.
template<class Number>
std::optional<Number> number_in(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>)
    if (!std::isfinite(number)) return std::nullopt;
  return number;
}

/// Makes the letters of ASCII small, and leaves others as they are.
inline std::string in_small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string_view without_blanks(std::string_view text);

/// One row of a table; views of the text that it was read from.
struct TextRow {
  std::vector<std::string_view> fields; ///< without the blanks around them
  std::string_view line;                ///< likewise
  const std::string& name;              ///< the file's
  int number;                           ///< the line's, from 1
  std::string place() const { return name + ":" + std::to_string(number) + ": "; }
};

/// What divides a row: commas, or else (in a row without one) blanks.
enum class Between { commas, commas_or_blanks };

/// Reads a table row by row. Empty lines and those that begin with # are left out. The first of the others is
/// a heading if it begins with a letter and has no number; no later one is.
/// @param name  the file's, for messages   @return whether there was a heading
bool read_rows(const std::string& text, const std::string& name, Between between,
               const std::function<void(const TextRow&)>& heading,
               const std::function<void(const TextRow&)>& row);

} // namespace springproof::cases
