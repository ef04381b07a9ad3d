#pragma once

#include <fmt/ostream.h>
#include <ostream>
#include <string>
#include <type_traits>

/// What the program prints: prose in lines that a terminal shows whole, and texts of strangers (names,
/// descriptions, reasons, paths). A terminal and a continuous-integration server read along, and each takes
/// some texts for commands.
namespace springproof::compare {

/// The text as a part of one line: control characters, what breaks lines or turns their direction, characters
/// that XML cannot hold and bytes that are no UTF-8 stand as escapes (\n, \x1b, \u202e); so do characters
/// that servers take for commands: a colon that begins the text, and the second of "##". Tabs stay.
std::string one_line(const std::string& text);

template<class Value>
constexpr bool is_text = std::is_convertible_v<const Value&, std::string>;

/// A text as one_line(); any other value as it is.
template<class Value>
std::conditional_t<is_text<Value>, std::string, const Value&> printed(const Value& value) {
  if constexpr (is_text<Value>)
    return one_line(value);
  else
    return value;
}

/// fmt::print() of values that are printed().
template<class... Values>
void print(std::ostream& out,
           fmt::format_string<std::conditional_t<is_text<Values>, std::string, const Values&>...> format,
           const Values&... values) {
  fmt::vprint(out, fmt::string_view(format), fmt::make_format_args(printed(values)...));
}

/// Characters of the widest line that the program prints on a screen.
constexpr std::size_t screen_width = 100;

/// How many characters a text of UTF-8 has.
std::size_t n_characters(const std::string& text);

/// Breaks a text at its blanks into lines of at most `width` characters, each ended by a newline. A word that
/// is longer than a line stays whole.
/// @param first, others  what the first line and the others begin with
std::string paragraph(const std::string& text, const std::string& first = "", const std::string& others = "",
                      std::size_t width = screen_width);

/// Writes one_line() of a text as a paragraph().
void write_paragraph(std::ostream& out, const std::string& text, const std::string& first = "",
                     const std::string& others = "");

/// The start of a text in at most `n` characters: a text that is longer ends at a word, with "...".
std::string in_short(const std::string& text, std::size_t n);

} // namespace springproof::compare
