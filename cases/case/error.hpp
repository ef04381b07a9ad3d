#pragma once

#include "cases/case/names.hpp"

#include <stdexcept>

namespace springproof::cases {

/// What became of a body under its load. Written with blanks: "stable equilibrium".
SPRINGPROOF_ENUMERATION(Outcome,
                        unknown,              ///< the solver gave up, or stability was not looked at
                        stable_equilibrium,   ///< full load carried, tangent positive definite
                        unstable_equilibrium, ///< in balance, but some small motion lowers the energy
                        limit_point,          ///< the path from rest ends below the full load
                        mechanism,            ///< some motion meets no stiffness at rest
                        refused               ///< the input makes no model
)
inline char between_words(Outcome) {
  return ' ';
}

/// A place in a case file, for messages: "file:line:column". Line 0: the value came from the command line or
/// a default.
struct Where {
  std::string file;
  int line = 0;
  int column = 0;
  std::string key; ///< dotted, as in "load[0].value"
};

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

/// Further data of the last equilibrium that a failed solve has found.
struct Progress {
  int newton_iterations = 0; ///< in all
  std::optional<double> lowest_eigenvalue = std::nullopt;
  int inverted_cells = 0;
};

/// A solve that could not be completed (exit status 1). It becomes a failed row; the other cases go on.
class SolveError : public std::runtime_error {
 public:
  /// @param load_reached  fraction of the load in equilibrium when the solver gave up, 0 to 1
  /// @param residual      |imbalance on free degrees of freedom| / |applied load| when it gave up
  /// @param outcome       the cause, as the solver found it
  SolveError(const std::string& reason, double load_reached, double residual,
             Outcome outcome = Outcome::unknown, const Progress& progress = {})
      : std::runtime_error(reason), load_reached_(load_reached), residual_(residual), outcome_(outcome),
        progress_(progress) {}
  double load_reached() const { return load_reached_; }
  double residual() const { return residual_; }
  Outcome outcome() const { return outcome_; }
  const Progress& progress() const { return progress_; }

 private:
  double load_reached_;
  double residual_;
  Outcome outcome_;
  Progress progress_;
};

} // namespace springproof::cases
