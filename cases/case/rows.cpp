#include "cases/case/rows.hpp"

#include <algorithm>
#include <cctype>

namespace springproof::cases {

namespace {

constexpr const char* blanks = " \t\r\v\f";

std::string_view without_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> fields_of(std::string_view line, Between between) {
  std::vector<std::string_view> fields;
  const bool by_blanks = between == Between::commas_or_blanks && line.find(',') == line.npos;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end =
        std::min(by_blanks ? line.find_first_of(blanks, begin) : line.find(',', begin), line.size());
    fields.push_back(without_blanks(line.substr(begin, end - begin)));
    begin = end + 1;
    if (by_blanks) begin = std::max(begin, std::min(line.find_first_not_of(blanks, begin), line.size()));
  }
  return fields;
}

bool is_heading(const TextRow& row) {
  return std::isalpha(static_cast<unsigned char>(row.line.front())) != 0 &&
         std::none_of(row.fields.begin(), row.fields.end(),
                      [](std::string_view field) { return number_in<double>(field); });
}

} // namespace

bool read_rows(const std::string& text, const std::string& name, Between between,
               const std::function<void(const TextRow&)>& heading,
               const std::function<void(const TextRow&)>& row) {
  bool is_first = true, has_heading = false;
  const std::string_view all = text;
  int number = 0;
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find('\n', begin), all.size());
    const std::string_view line = without_blanks(all.substr(begin, end - begin));
    begin = end + 1;
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const TextRow read{fields_of(line, between), line, name, number};
    if (is_first && is_heading(read)) {
      has_heading = true;
      heading(read);
    } else {
      row(read);
    }
    is_first = false;
  }
  return has_heading;
}

} // namespace springproof::cases
