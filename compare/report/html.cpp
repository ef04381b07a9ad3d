#include "compare/report/html.hpp"

#include "compare/write/whole_file.hpp"

#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

namespace springproof::compare::html {

namespace {

std::string base64(const std::string& bytes) {
  static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

} // namespace

std::string number(const std::optional<double>& value, int decimals) {
  if (!value) return "–";
  const std::string text = fmt::format("{:.{}f}", *value, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

std::string data_address(const std::string& path, const std::string& type) {
  return "data:" + type + ";base64," + base64(read_file(path));
}

std::string fill(const std::string& text, const std::map<std::string, std::string>& values) {
  std::string result;
  std::set<std::string> placed;
  std::size_t from = 0;
  for (std::size_t open = text.find("{{"); open != std::string::npos; open = text.find("{{", from)) {
    result.append(text, from, open - from);
    const std::size_t close = text.find("}}", open);
    const auto value = values.find(text.substr(open + 2, close - open - 2));
    if (close == std::string::npos || value == values.end())
      throw std::logic_error("template: nothing is known for " + text.substr(open, 40));
    result += value->second;
    placed.insert(value->first);
    from = close + 2;
  }
  if (placed.size() < values.size()) throw std::logic_error("template: a value has no place");
  return result + text.substr(from);
}

} // namespace springproof::compare::html
