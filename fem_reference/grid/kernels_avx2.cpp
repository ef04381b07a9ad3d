#define SPRINGPROOF_ISA avx2
#include "fem_reference/grid/kernels_source.hpp"
