#include "compare/write/columns.hpp"

#include "compare/provenance/paragraph.hpp"
#include "compare/provenance/print.hpp"

#include <algorithm>
#include <numeric>

namespace springproof::compare {

namespace {

constexpr std::size_t indent_of_tables = 2, gap = 2;

std::string blanks(std::size_t n) {
  return std::string(n, ' ');
}

} // namespace

std::size_t printed_width(const std::string& text) {
  return n_characters(one_line(text));
}

void write_wrapped(std::ostream& out, const std::string& text, std::size_t indent) {
  const std::size_t first = std::min(text.find_first_not_of(' '), text.size());
  write_paragraph(out, text.substr(first), blanks(first), blanks(indent));
}

std::vector<std::size_t> TextTable::widths() const {
  std::vector<std::size_t> all;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    all.push_back(printed_width(columns_[c].heading));
    for (const auto& row : rows_) all.back() = std::max(all.back(), printed_width(row.at(c)));
  }
  return all;
}

std::size_t TextTable::width() const {
  const std::vector<std::size_t> all = widths();
  return std::accumulate(all.begin(), all.end(), indent_of_tables + gap * (all.size() - 1));
}

void TextTable::write(std::ostream& out) const {
  const std::vector<std::size_t> all = widths();
  const auto write_row = [&](const auto& text_of) {
    std::string line;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const std::string text = one_line(text_of(c)), fill = blanks(all[c] - printed_width(text));
      line += blanks(c == 0 ? indent_of_tables : gap);
      line += columns_[c].side == Side::left ? text + fill : fill + text;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    print(out, "{}\n", line);
  };
  write_row([&](std::size_t c) { return columns_[c].heading; });
  for (const auto& row : rows_) write_row([&](std::size_t c) { return row.at(c); });
}

} // namespace springproof::compare
