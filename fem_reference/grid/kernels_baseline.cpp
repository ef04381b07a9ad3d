#define SPRINGPROOF_ISA baseline
#include "fem_reference/grid/kernels_source.hpp"
