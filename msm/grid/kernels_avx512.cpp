#define SPRINGPROOF_ISA avx512
#include "msm/grid/kernels_source.hpp"
