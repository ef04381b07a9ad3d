#pragma once

/// Defines an enumeration with the enumerators 0, 1, ..., whose names are the enumerators themselves: one
/// line registers both.
#define SPRINGPROOF_ENUMERATION(Enum, ...)                                                                   \
  enum class Enum { __VA_ARGS__ };                                                                           \
  inline const char* enumerators(Enum) {                                                                     \
    return #__VA_ARGS__;                                                                                     \
  }
