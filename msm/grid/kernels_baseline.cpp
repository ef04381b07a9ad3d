#define SPRINGPROOF_ISA baseline
#include "msm/grid/kernels_source.hpp"
