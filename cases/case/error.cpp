#include "cases/case/error.hpp"

namespace springproof::cases {

namespace {
std::string place(const Where& where) {
  const std::string position =
      where.line > 0 ? ":" + std::to_string(where.line) + ":" + std::to_string(where.column) : "";
  return (where.file.empty() ? "command line" : where.file) + position + ": ";
}
} // namespace

InputError::InputError(const Where& where, const std::string& problem)
    : std::runtime_error(place(where) + (where.key.empty() ? "" : where.key + ": ") + problem),
      where_(where) {}

} // namespace springproof::cases
