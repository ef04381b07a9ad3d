#include "compare/provenance/cases_folder.hpp"

#include <cstdlib>

namespace springproof::compare {

std::string cases_folder() {
  const char* moved = std::getenv("SPRINGPROOF_CASES");
  return moved ? moved : SPRINGPROOF_CASES_DIR;
}

} // namespace springproof::compare
