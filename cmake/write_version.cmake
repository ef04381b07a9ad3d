# Writes version.cpp with the commit that is being built; the file is touched only when the commit has changed.
execute_process(COMMAND git describe --always --dirty --abbrev=10
  WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT COMMIT)
  set(COMMIT unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[#include "compare/provenance/machine.hpp"

namespace springproof::compare {
std::string program_version() { return "@VERSION@"; }
std::string program_commit() { return "@COMMIT@"; }
} // namespace springproof::compare
]] @ONLY)
