#pragma once

#include <string>

namespace springproof::compare {

/// Folder of the case files and data that come with the program; the environment variable SPRINGPROOF_CASES
/// moves it.
std::string cases_folder();

} // namespace springproof::compare
