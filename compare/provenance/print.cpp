#include "compare/provenance/print.hpp"

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <utility>

namespace springproof::compare {

namespace {

/// Ranges of code points, first and last.
constexpr std::pair<char32_t, char32_t> not_shown[] = {
    {0x00, 0x08},     {0x0a, 0x1f},     {0x7f, 0x9f},     // control characters but the tab
    {0x061c, 0x061c}, {0x200e, 0x200f}, {0x202a, 0x202e}, // changes of a line's direction
    {0x2066, 0x2069}, {0x2028, 0x2029},                   // more of them, and ends of lines
    {0xfffe, 0xffff}};                                    // not in XML 1.0

bool is_shown(char32_t c) {
  return std::none_of(std::begin(not_shown), std::end(not_shown),
                      [c](const auto& range) { return range.first <= c && c <= range.second; });
}

/// A character of UTF-8, or a byte that is none.
struct Character {
  char32_t code;
  std::size_t size;
  bool is_valid;
};

Character character_at(const std::string& text, std::size_t at) {
  namespace utf = boost::locale::utf;
  const auto begin = text.begin() + static_cast<std::ptrdiff_t>(at);
  auto end = begin;
  const utf::code_point code = utf::utf_traits<char>::decode(end, text.end());
  if (code == utf::illegal || code == utf::incomplete) return {static_cast<unsigned char>(*begin), 1, false};
  return {code, static_cast<std::size_t>(end - begin), true};
}

std::string in_escapes(char32_t code) {
  if (code == '\n') return "\\n";
  if (code == '\r') return "\\r";
  return code < 0x100 ? fmt::format("\\x{:02x}", static_cast<unsigned>(code))
                      : fmt::format("\\u{:04x}", static_cast<unsigned>(code));
}

bool starts_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; // the other bytes of a character begin with 10
}

} // namespace

std::string one_line(const std::string& text) {
  std::string line;
  const std::size_t begin = text.find_first_not_of(" \t\n\r\v\f");
  for (std::size_t at = 0; at < text.size();) {
    const auto [code, size, is_valid] = character_at(text, at);
    const bool is_command = (at == begin && code == ':') || (code == '#' && at > 0 && text[at - 1] == '#');
    line += is_valid && is_shown(code) && !is_command ? text.substr(at, size) : in_escapes(code);
    at += size;
  }
  return line;
}

std::size_t n_characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts_character));
}

std::string paragraph(const std::string& text, const std::string& first, const std::string& others,
                      std::size_t width) {
  std::string done, line = first;
  bool is_empty = true; // but for what it begins with
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin); // empty between two blanks, which stay
    begin = end + 1;
    if (!is_empty && n_characters(line) + 1 + n_characters(word) > width) {
      done += line + "\n";
      line = others;
      is_empty = true;
    }
    line += (is_empty ? "" : " ") + word;
    is_empty = false;
  }
  return done + line + "\n";
}

void write_paragraph(std::ostream& out, const std::string& text, const std::string& first,
                     const std::string& others) {
  out << paragraph(one_line(text), first, others);
}

std::string in_short(const std::string& text, std::size_t n) {
  if (n_characters(text) <= n) return text;
  const std::string dots = "...";
  std::size_t end = 0; // where the first n - 3 characters end
  for (std::size_t n_seen = 0; end < text.size(); ++end)
    if (starts_character(text[end]) && n_seen++ == n - dots.size()) break;
  const std::size_t blank = text.find_last_of(' ', end);
  return text.substr(0, blank == std::string::npos || blank == 0 ? end : blank) + dots;
}

} // namespace springproof::compare
