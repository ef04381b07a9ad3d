#pragma once

#include "cases/case/rows.hpp"
#include "compare/provenance/print.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace springproof::compare {

/// Of an option's value: a finite number from the one to the other. CLI::Range and CLI::PositiveNumber let
/// nan pass.
inline CLI::Validator number_between(double lowest, double highest) {
  const auto check = [=](const std::string& text) {
    const auto number = cases::number_in<double>(text);
    const bool is_good = number && lowest <= *number && *number <= highest;
    return is_good
               ? std::string()
               : fmt::format("is {}, must be a number from {:g} to {:g}", one_line(text), lowest, highest);
  };
  return {check, fmt::format("FLOAT in [{:g} - {:g}]", lowest, highest)};
}

} // namespace springproof::compare
