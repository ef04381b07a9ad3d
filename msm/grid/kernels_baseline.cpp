#include "msm/grid/kernels_source.hpp"

const springproof::msm::grid::InstructionSet springproof::msm::grid::baseline{"baseline", all<double>,
                                                                              all<float>, substitute};
