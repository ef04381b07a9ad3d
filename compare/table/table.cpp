#include "compare/table/table.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>

namespace springproof::compare {

namespace {

constexpr std::size_t indent_of_tables = 2, gap = 2;

std::string blanks(std::size_t n) {
  return std::string(n, ' ');
}

const std::string& key_of(const Column& column) {
  return column.key.empty() ? column.heading : column.key;
}

std::string printed_value(const Json& value, const std::string& format) {
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (!value.is_number_float()) return value.dump();
  return fmt::format(fmt::runtime(format.empty() ? "{}" : format), value.get<double>());
}

} // namespace

Columns columns_of(const std::string& text) {
  Columns columns;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t end = std::min(word.find('='), word.size());
    columns.push_back({word.substr(0, end), word.substr(std::min(end + 1, word.size()))});
  }
  return columns;
}

Json value_at(const Json& row, const std::string& key) {
  const std::size_t dot = std::min(key.find('.'), key.size());
  const std::string first = key.substr(0, dot), rest = key.substr(std::min(dot + 1, key.size()));
  if (row.is_object()) {
    if (row.contains(key)) return row.at(key); // a measure's name may have dots
    if (row.contains(first) && !rest.empty()) return value_at(row.at(first), rest);
  }
  const auto entry = cases::number_in<std::size_t>(first);
  if (!row.is_array() || !entry || *entry >= row.size()) return nullptr;
  return rest.empty() ? row.at(*entry) : value_at(row.at(*entry), rest);
}

void write_csv(std::ostream& out, const Columns& columns, const Json& rows, int digits) {
  CsvWriter csv(out, digits);
  std::vector<std::string> headings;
  for (const Column& column : columns) headings.push_back(column.heading);
  csv.row(headings);
  for (const Json& row : rows) {
    std::vector<Json> values;
    for (const Column& column : columns) values.push_back(value_at(row, key_of(column)));
    csv.row(values);
  }
}

void write_json_file(const std::string& path, const Json& document) {
  write_file(path, [&](std::ostream& out) { out << json_text(document); });
}

std::size_t printed_width(const std::string& text) {
  return n_characters(one_line(text));
}

void write_wrapped(std::ostream& out, const std::string& text, std::size_t indent) {
  const std::size_t first = std::min(text.find_first_not_of(' '), text.size());
  write_paragraph(out, text.substr(first), blanks(first), blanks(indent));
}

TextTable::TextTable(Columns columns, const Json& rows) : columns_(std::move(columns)) {
  for (const Json& row : rows) {
    rows_.emplace_back();
    for (const Column& column : columns_)
      rows_.back().push_back(printed_value(value_at(row, key_of(column)), column.format));
  }
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
  const auto write_row = [&](const auto& text_in) {
    std::string line;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const std::string text = one_line(text_in(c)), fill = blanks(all[c] - printed_width(text));
      const bool is_left = c == 0 || columns_[c].format.find('<') != std::string::npos;
      line += blanks(c == 0 ? indent_of_tables : gap);
      line += is_left ? text + fill : fill + text;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    print(out, "{}\n", line);
  };
  write_row([&](std::size_t c) { return columns_[c].heading; });
  for (const auto& row : rows_) write_row([&](std::size_t c) { return row.at(c); });
}

} // namespace springproof::compare
