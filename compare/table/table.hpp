#pragma once

#include "cases/case/rows.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/json.hpp"

#include <fmt/format.h>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// Tables of results. One function makes a row, a JSON object, of a record. These rows are the JSON itself,
/// and columns take their values out of them by key, for CSV and for text.
namespace springproof::compare {

/// A column of CSV or of text.
struct Column {
  std::string heading;
  /// Place of the value in a row; a dot leads into an object or a list: "seconds.first", "cells.0". Empty:
  /// the heading is the key.
  std::string key{};
  /// fmt's format of a number in text; with "<" the column's texts begin at the left.
  std::string format{};
};
using Columns = std::vector<Column>;

/// The columns that a text names, parted by blanks: "case cells_x=cells.0 worst~%=worst{:.2f}" has the columns
/// "case", "cells_x" of what is in a row at cells.0, and "worst %" with a format. "~" stands for a blank.
Columns columns_of(const std::string& text);

/// The value at a column's key; null where the row has none.
Json value_at(const Json& row, const std::string& key);

/// Writes comma-separated rows: numbers to so many digits, whole numbers as they are, truth as 1 or 0, texts
/// as one_line(), nothing for a value that is absent, the fields of a vector one after the other. A list of
/// JSON is one field, its entries parted by blanks.
class CsvWriter {
 public:
  explicit CsvWriter(std::ostream& out, int digits = 8) : out_(out), digits_(digits) {}

  template<class... Fields>
  void row(const Fields&... fields) {
    [[maybe_unused]] const char* comma = ""; // a row may have no fields
    ((out_ << std::exchange(comma, ",") << field(fields)), ...);
    out_ << '\n';
  }
  /// gnuplot counts blocks of rows by the two empty lines between them.
  void end_block() { out_ << "\n\n"; }

 private:
  /// Follows RFC 4180: a text with a comma or a quote stands in quotes, and its quotes are doubled. An
  /// apostrophe goes before what begins as a formula does.
  std::string field(const std::string& any_text) const {
    std::string text = one_line(any_text);
    // A spreadsheet would take it for a formula, which can start programs.
    if (text.find_first_of("=+-@\t") == 0 && !cases::number_in<double>(text)) text.insert(0, 1, '\'');
    if (text.find_first_of(",\"") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
  }
  template<class Number>
  std::enable_if_t<std::is_arithmetic_v<Number>, std::string> field(Number value) const {
    if constexpr (std::is_floating_point_v<Number>)
      return fmt::format("{:.{}g}", value, digits_);
    else
      return std::to_string(value);
  }
  template<class Value>
  std::string field(const std::optional<Value>& value) const {
    return value ? field(*value) : "";
  }
  template<class Value>
  std::string field(const std::vector<Value>& values) const {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i) text += (i == 0 ? "" : ",") + field(values[i]);
    return text;
  }
  template<class Value>
  std::enable_if_t<std::is_same_v<Value, Json>, std::string> field(const Value& value) const {
    if (value.is_string()) return field(value.template get_ref<const std::string&>());
    if (value.is_boolean()) return field(value.template get<bool>());
    if (value.is_number_float()) return field(value.template get<double>());
    if (!value.is_array()) return value.is_null() ? "" : value.dump();
    std::string text;
    for (const Value& entry : value)
      text +=
          (text.empty() ? "" : " ") + (entry.is_string() ? entry.template get<std::string>() : field(entry));
    return field(text);
  }

  std::ostream& out_;
  int digits_;
};

/// Writes a line of headings, and one for each row.
/// @param rows  a list of objects
void write_csv(std::ostream& out, const Columns& columns, const Json& rows, int digits = 10);

/// Writes a file of comma-separated rows, whole or not at all.
/// @param write  given the file's CsvWriter
template<class Write>
void write_csv_file(const std::string& path, const Write& write, int digits = 8) {
  write_file(path, [&](std::ostream& out) {
    CsvWriter csv(out, digits);
    write(csv);
  });
}

/// Writes json_text() of a document as a file, whole or not at all.
void write_json_file(const std::string& path, const Json& document);

/// Writes a text in lines of at most 100 columns, as far as its words allow.
/// @param text    its leading blanks are the first line's
/// @param indent  blanks in front of the other lines
void write_wrapped(std::ostream& out, const std::string& text, std::size_t indent);

/// Rows under their headings. A column is as wide as its widest text. Texts of the first column begin at the
/// left, those of others end at the right unless their format says "<".
/// @param rows  a list of objects: a number is written by its column's format, null as "-", truth as "yes" or
///              "no"
void write_table(std::ostream& out, const Columns& columns, const Json& rows);

/// Number of columns of the terminal that the widest line takes.
std::size_t table_width(const Columns& columns, const Json& rows);

} // namespace springproof::compare
