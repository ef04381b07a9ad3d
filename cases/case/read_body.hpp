#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

namespace springproof::cases {

/// Reads [body].  @param case_path  of the case file, which names of files are relative to
Body read_body(Table& table, const std::string& case_path);

} // namespace springproof::cases
