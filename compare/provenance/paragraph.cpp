#include "compare/provenance/paragraph.hpp"

#include "compare/provenance/print.hpp"

#include <algorithm>

namespace springproof::compare {

namespace {

bool starts_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; // the other bytes of a character begin with 10
}

} // namespace

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
