#pragma once

#include "compare/write/escape.hpp"

#include <map>
#include <optional>
#include <string>

namespace springproof::compare::html {

using compare::escape;

/// A number as a table shows it, or a dash.
std::string number(const std::optional<double>& value, int decimals = 2);

/// "data:TYPE;base64,...": a file's content as an address of its own, so that the page needs no other file.
/// @throws InputError if the file cannot be read
std::string data_address(const std::string& path, const std::string& type);

/// A template's text with every {{name}} replaced.  @throws std::logic_error if a name has no value or is not
/// in the text
std::string fill(const std::string& text, const std::map<std::string, std::string>& values);

} // namespace springproof::compare::html
