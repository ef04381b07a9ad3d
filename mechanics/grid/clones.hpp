#pragma once

/// SPRINGPROOF_CLONES compiles a function for AVX2 too, which is taken where the machine has it. The sets do
/// without fused multiply-add, which rounds otherwise: the digits are the same on every machine.
#if defined(__GNUC__) && !defined(__clang__) &&                                                              \
    defined(__x86_64__) // clang compiles the sanitized build alone
#define SPRINGPROOF_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define SPRINGPROOF_CLONES
#endif
