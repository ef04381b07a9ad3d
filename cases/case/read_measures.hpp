#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

/// [[measure]] and [[expect]].
namespace springproof::cases {

Measure read_measure(Table& table, const Body& body);
Expectation read_expectation(Table& table, const std::vector<Measure>& measures);

} // namespace springproof::cases
