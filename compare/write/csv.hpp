#pragma once

#include "cases/case/rows.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"

#include <fmt/format.h>
#include <optional>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace springproof::compare {

/// Writes comma-separated rows: numbers to so many digits, whole numbers as they are, texts as one_line(),
/// nothing for a value that is absent, the fields of a vector one after the other.
class CsvWriter {
 public:
  explicit CsvWriter(std::ostream& out, int digits = 8) : out_(out), digits_(digits) {}

  template<class... Fields>
  void row(const Fields&... fields) {
    [[maybe_unused]] const char* comma = ""; // of a row without fields
    ((out_ << std::exchange(comma, ",") << field(fields)), ...);
    out_ << '\n';
  }
  /// gnuplot counts blocks of rows by the two empty lines between them.
  void end_block() { out_ << "\n\n"; }

 private:
  /// As RFC 4180 has it: a text with a comma or a quote stands in quotes, and its quotes are doubled. An
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

  std::ostream& out_;
  int digits_;
};

/// Writes a file of comma-separated rows, whole or not at all.
/// @param write  given the file's CsvWriter
template<class Write>
void write_csv_file(const std::string& path, const Write& write, int digits = 8) {
  write_file(path, [&](std::ostream& out) {
    CsvWriter csv(out, digits);
    write(csv);
  });
}

} // namespace springproof::compare
