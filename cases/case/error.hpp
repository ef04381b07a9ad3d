#pragma once

#include "cases/case/solution.hpp"

#include <fmt/core.h>
#include <stdexcept>
#include <type_traits>

namespace cereal {
class BinaryOutputArchive;
}

namespace springproof::cases {

/// Names and places of files are for messages: a worker needs them, a case's identity must not have them.
template<class Archive>
constexpr bool has_places = !std::is_same_v<Archive, cereal::BinaryOutputArchive>;

/// A place in a case file, for messages: "file:line:column". Line 0: the value came from the command line or
/// a default.
struct Where {
  std::string file;
  int line = 0;
  int column = 0;
  std::string key; ///< dotted, as in "load[0].value"
};

template<class Archive>
void serialize(Archive& archive, Where& place) {
  auto& [file, line, column, key] = place;
  if constexpr (has_places<Archive>) archive(file, line, column, key);
}

/// Wrong input or usage (exit status 2). The message says where, which key and value, and what is allowed.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
  /// Message "file:line:column: key: problem".
  InputError(const Where& where, const std::string& problem)
      : std::runtime_error(
            (where.file.empty() ? "command line" : where.file) +
            (where.line > 0 ? ":" + std::to_string(where.line) + ":" + std::to_string(where.column) : "") +
            ": " + (where.key.empty() ? "" : where.key + ": ") + problem),
        where_(where) {}
  const Where& where() const { return where_; }

 private:
  Where where_;
};

/// @throws InputError at a place, with a problem in fmt's format
template<class... Values>
[[noreturn]] void refuse(const Where& where, fmt::format_string<Values...> problem, Values&&... values) {
  throw InputError(where, fmt::format(problem, std::forward<Values>(values)...));
}

/// A file that a case names.
struct NamedFile {
  std::string path; ///< as opened: relative paths are resolved against the case file
  Where where{};    ///< the name in the case file

  /// @throws InputError, at the name, with the path before the reason
  [[noreturn]] void refuse(const std::string& reason) const { throw InputError(where, path + ": " + reason); }
  /// The same for a reason that may name the path, as VTK's do.
  [[noreturn]] void refuse_once(const std::string& reason) const {
    if (reason.find(path) == std::string::npos) refuse(reason);
    throw InputError(where, reason);
  }
};

template<class Archive>
void serialize(Archive& archive, NamedFile& named) {
  auto& [path, where] = named;
  if constexpr (has_places<Archive>) archive(path, where);
}

/// A solve that could not be completed (exit status 1). It becomes a failed row; the other cases go on.
class SolveError : public std::runtime_error {
 public:
  /// @param so_far  the load reached, the residual there, the outcome, and the counters of the work done
  SolveError(const std::string& reason, Solution so_far)
      : std::runtime_error(reason), so_far_(std::move(so_far)) {
    so_far_.status = Status::failed;
    so_far_.message = reason;
  }
  explicit SolveError(const std::string& reason) : SolveError(reason, Solution{}) {}
  const Solution& so_far() const { return so_far_; } ///< failed
  double load_reached() const { return so_far_.load_reached; }
  double residual() const { return so_far_.residual; }
  Outcome outcome() const { return so_far_.outcome; }

 private:
  Solution so_far_;
};

} // namespace springproof::cases
