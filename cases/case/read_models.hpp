#pragma once

#include "cases/case/case.hpp"
#include "cases/case/toml_table.hpp"

/// What either model is made with: [fem] and [msm].
namespace springproof::cases {

/// Reads them into a case whose body, [dynamics] and materials are read.
/// @throws InputError, also if a material has no meaning in the element, or the springs' design does not
/// exist for it
void read_models(Table& root, Case& result);

} // namespace springproof::cases
