#include "msm/grid/kernels_source.hpp"

const springproof::msm::grid::InstructionSet springproof::msm::grid::avx512{"avx512", all<double>, all<float>,
                                                                            substitute};
