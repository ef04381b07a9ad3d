#pragma once

#include <ostream>
#include <string>

/// Prose in lines that a terminal shows whole.
namespace springproof::compare {

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
