#pragma once

#include "cases/case/outcome.hpp"

#include <optional>
#include <stdexcept>
#include <string>

namespace springproof::cases {

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
  InputError(const Where& where, const std::string& problem);
  const Where& where() const { return where_; }

 private:
  Where where_;
};

/// A solve that could not be completed (exit status 1). It becomes a failed row; the other cases go on.
class SolveError : public std::runtime_error {
 public:
  /// Further data of the last equilibrium that was found.
  struct Progress {
    int newton_iterations = 0; ///< in all
    std::optional<double> lowest_eigenvalue = std::nullopt;
    int inverted_cells = 0;
  };
  /// @param load_reached  fraction of the load in equilibrium when the solver gave up, 0 to 1
  /// @param residual      |imbalance on free degrees of freedom| / |applied load| when it gave up
  /// @param outcome       the cause, as the solver found it
  SolveError(const std::string& reason, double load_reached, double residual,
             Outcome outcome = Outcome::unknown)
      : SolveError(reason, load_reached, residual, outcome, Progress{}) {}
  SolveError(const std::string& reason, double load_reached, double residual, Outcome outcome,
             const Progress& progress)
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
