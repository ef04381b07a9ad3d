#pragma once

#include "compare/thesis/entries.hpp"

/// An entry of table 4.6 that print gives as 10 %, with a value for each reference.
inline springproof::compare::TableEntry entry(const std::vector<std::optional<double>>& values,
                                              const std::string& measure = "alpha_2") {
  springproof::compare::TableEntry result{
      {"4.6", "linear_elastic", 0.3, "linear_method", 0.3, "large", "shear", measure, "%", 10}, {}, ""};
  for (const auto& value : values) result.computed.push_back({"log_strain q1_bbar", value});
  return result;
}
