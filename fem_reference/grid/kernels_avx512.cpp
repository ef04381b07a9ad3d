#define SPRINGPROOF_ISA avx512
#include "fem_reference/grid/kernels_source.hpp"
