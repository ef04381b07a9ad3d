#pragma once

#include "cases/case/input_file.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/json.hpp"

#include <fmt/format.h>
#include <ostream>
#include <string>
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

/// The columns that a text names, parted by blanks: "case cells_x=cells.0 worst~%=worst{:.2f}" has the
/// columns "case", "cells_x" of what is in a row at cells.0, and "worst %" with a format. "~" stands for a
/// blank.
Columns columns_of(const std::string& text);

/// The value at a column's key; null where the row has none.
Json value_at(const Json& row, const std::string& key);

/// Writes comma-separated rows: numbers to so many digits, whole numbers as they are, truth as 1 or 0, texts
/// as one_line(), nothing for a value that is absent, the fields of a vector one after the other. A list in a
/// vector is one field, its entries parted by blanks.
class CsvWriter {
 public:
  explicit CsvWriter(std::ostream& out, int digits = 8) : out_(out), digits_(digits) {}

  template<class... Fields>
  void row(const Fields&... fields) {
    write(Json::array({Json(fields)...}));
  }
  /// gnuplot counts blocks of rows by the two empty lines between them.
  void end_block() { out_ << "\n\n"; }

 private:
  void write(const Json& fields);

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

/// Rows under their headings. A column is as wide as its widest text. Texts of a first column without a
/// format begin at the left, those of others end at the right unless their format says "<".
/// @param rows  a list of objects: a number is written by its column's format, null as "-", truth as "yes" or
///              "no"
void write_table(std::ostream& out, const Columns& columns, const Json& rows);

/// Number of columns of the terminal that the widest line takes.
std::size_t table_width(const Columns& columns, const Json& rows);

} // namespace springproof::compare
