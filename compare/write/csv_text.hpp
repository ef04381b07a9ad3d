#pragma once

#include <fmt/format.h>
#include <optional>
#include <string>

namespace springproof::compare {

/// A field of a comma-separated file as RFC 4180 has it: a text with a comma, a quote or a line break stands
/// in quotes, and its quotes are doubled.
inline std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

/// Nothing where there is no value.
inline std::string csv_number(const std::optional<double>& value, int digits = 10) {
  return value ? fmt::format("{:.{}g}", *value, digits) : "";
}

} // namespace springproof::compare
