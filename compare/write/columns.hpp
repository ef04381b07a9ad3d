#pragma once

#include "compare/provenance/paragraph.hpp"

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

/// Text for a terminal of 100 columns.
namespace springproof::compare {

/// Number of characters of a text as it is printed, see one_line().
std::size_t printed_width(const std::string& text);

/// Writes a text in lines of at most 100 columns, as far as its words allow.
/// @param text    its leading blanks are the first line's
/// @param indent  blanks in front of the other lines
void write_wrapped(std::ostream& out, const std::string& text, std::size_t indent);

/// Rows under their headings. A column is as wide as its widest text; those of numbers end at the right.
class TextTable {
 public:
  enum class Side { left, right };
  struct Column {
    std::string heading;
    Side side = Side::right;
  };

  explicit TextTable(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// @param row  as many texts as there are columns
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  /// Number of columns of the terminal that the widest line takes.
  std::size_t width() const;
  void write(std::ostream& out) const;

 private:
  std::vector<std::size_t> widths() const;

  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

} // namespace springproof::compare
