#pragma once

#include <fmt/ostream.h>
#include <string>
#include <type_traits>

/// Texts of strangers (names, descriptions, reasons, paths) in what the program prints: a terminal and a
/// continuous-integration server read along, and each takes some texts for commands.
namespace springproof::compare {

/// The text as a part of one line: control characters, what breaks lines or turns their direction, characters
/// that XML cannot hold and bytes that are no UTF-8 stand as escapes (\n, \x1b, \u202e); so does a character
/// of what servers take for a command: a colon that begins the text, and the second of "##". Tabs stay.
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

} // namespace springproof::compare
