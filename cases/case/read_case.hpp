#pragma once

#include "cases/case/case.hpp"

#include <string>
#include <vector>

namespace springproof::cases {

/// Name of the measure that a dynamic case with [surface] has beside its own: the root mean square
/// displacement of the surface over time.
inline constexpr const char* surface_measure = "surface";

/// Purpose that a case is read for. Vibrations about rest need no supports, motions or loads.
enum class Purpose { motion, vibrations };

/// Reads and checks a case file (TOML 1.0; docs/reference/case-file.md has every key). Whatever does not need
/// the mesh is checked here; make_scene() does the rest.
/// @param path       the file; names of files in it are relative to its folder
/// @param overrides  settings of the command line, "load[0].value=[0, 0, 0.01]"
/// @throws InputError  "file:line:column: key: is VALUE, must be ..." at the first mistake
Case read_case(const std::string& path, const std::vector<std::string>& overrides = {},
               Purpose purpose = Purpose::motion);

/// The same for a hard case, a file with a table [stress], which read_case() refuses.
Case read_hard_case(const std::string& path);

/// The same for the text of a case file.  @param path  its name in messages; names of files in it are
/// relative to its folder
Case read_case_text(const std::string& text, const std::string& path);

} // namespace springproof::cases
