#pragma once

#include <cstdio>
#include <cstdlib>

/// What a reader promises of all that it accepts, for libFuzzer.
#define PROMISE(condition)                                                                                   \
  do {                                                                                                       \
    if (!(condition)) {                                                                                      \
      std::fprintf(stderr, "%s:%d: broken: %s\n", __FILE__, __LINE__, #condition);                           \
      std::abort();                                                                                          \
    }                                                                                                        \
  } while (false)
