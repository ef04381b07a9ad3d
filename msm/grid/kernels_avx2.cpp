#include "msm/grid/kernels_source.hpp"

const springproof::msm::grid::InstructionSet springproof::msm::grid::avx2{"avx2", all<double>, all<float>,
                                                                          substitute};
