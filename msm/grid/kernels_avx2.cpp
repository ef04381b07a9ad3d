#define SPRINGPROOF_ISA avx2
#include "msm/grid/kernels_source.hpp"
