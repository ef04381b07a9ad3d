#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

namespace springproof::cases {

/// Reads [body].  @param case_path  of the case file, which names of files are relative to
Body read_body(Table& table, const std::string& case_path);

/// Reads `scale`: mm of a unit of a file, 1 where it is left out.
double read_scale(Table& table);

} // namespace springproof::cases
