#include "compare/table/table.hpp"

#include "cases/case/input_file.hpp"

#include <algorithm>
#include <fmt/ostream.h>
#include <sstream>

namespace springproof::compare {

namespace {

constexpr const char* gap = "  "; ///< in front of each column

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

/// Follows RFC 4180: a text with a comma or a quote stands in quotes, and its quotes are doubled. An
/// apostrophe goes before what begins as a formula does.
std::string text_field(const std::string& any_text) {
  std::string text = one_line(any_text);
  // A spreadsheet would take it for a formula, which can start programs.
  if (text.find_first_of("=+-@\t") == 0 && !cases::number_in<double>(text)) text.insert(0, 1, '\'');
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string csv_field(const Json& value, int digits) {
  if (value.is_null()) return "";
  if (value.is_string()) return text_field(value.get_ref<const std::string&>());
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  if (value.is_number_float()) return fmt::format("{:.{}g}", value.get<double>(), digits);
  if (!value.is_array()) return value.dump();
  std::vector<std::string> entries;
  for (const Json& entry : value)
    entries.push_back(entry.is_string() ? entry.get<std::string>() : csv_field(entry, digits));
  return text_field(fmt::format("{}", fmt::join(entries, " ")));
}

using Texts = std::vector<std::string>;

/// Texts of a column, the heading first, filled up to the width of the longest.
Texts filled_texts(const Column& column, const Json& rows, bool is_left) {
  Texts texts{one_line(column.heading)};
  for (const Json& row : rows)
    texts.push_back(one_line(printed_value(value_at(row, key_of(column)), column.format)));
  std::size_t width = 0;
  for (const std::string& text : texts) width = std::max(width, n_characters(text));
  for (std::string& text : texts) text.insert(is_left ? text.size() : 0, width - n_characters(text), ' ');
  return texts;
}

/// The columns' texts. Those of the first column begin at the left unless it has a format.
std::vector<Texts> filled_columns(const Columns& columns, const Json& rows) {
  std::vector<Texts> all;
  for (const Column& column : columns)
    all.push_back(
        filled_texts(column, rows,
                     (all.empty() && column.format.empty()) || column.format.find('<') != std::string::npos));
  return all;
}

} // namespace

Columns columns_of(const std::string& text) {
  Columns columns;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::replace(word.begin(), word.end(), '~', ' ');
    const std::size_t format = std::min(word.find('{'), word.size()), key = std::min(word.find('='), format);
    columns.push_back({word.substr(0, key), word.substr(key, format - key), word.substr(format)});
    columns.back().key.erase(0, 1); // the sign of equality, where there is one
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

void CsvWriter::write(const Json& fields) {
  std::vector<std::string> texts;
  for (const Json& value : fields)
    for (const Json& part : value.is_array() ? value : Json::array({value}))
      texts.push_back(csv_field(part, digits_));
  fmt::print(out_, "{}\n", fmt::join(texts, ","));
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

void write_wrapped(std::ostream& out, const std::string& text, std::size_t indent) {
  const std::size_t first = std::min(text.find_first_not_of(' '), text.size());
  write_paragraph(out, text.substr(first), std::string(first, ' '), std::string(indent, ' '));
}

std::size_t table_width(const Columns& columns, const Json& rows) {
  std::string line;
  for (const Texts& texts : filled_columns(columns, rows)) line += gap + texts.front();
  return n_characters(line);
}

void write_table(std::ostream& out, const Columns& columns, const Json& rows) {
  const std::vector<Texts> all = filled_columns(columns, rows);
  for (std::size_t row = 0; row <= rows.size(); ++row) {
    std::string line;
    for (const Texts& texts : all) line += gap + texts[row];
    print(out, "{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
  }
}

} // namespace springproof::compare
