// The reader of case files as a target for libFuzzer: any bytes end in a case or in an InputError.

#include "cases/case/read_case.hpp"

#include <cstdint>
#include <string>

using namespace springproof;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    cases::read_case_text({reinterpret_cast<const char*>(bytes), size}, "/nowhere/case.toml");
  } catch (const cases::InputError&) {
    // what wrong input is answered with
  }
  return 0;
}
