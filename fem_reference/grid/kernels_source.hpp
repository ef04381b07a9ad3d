// The kernels' one source, compiled once per instruction set with SPRINGPROOF_ISA as the name of the set.
// It must include nothing that defines functions others share: the linker might keep the copy compiled for
// instructions that the machine lacks.
#include "mechanics/grid/packs.hpp"
// The laws see the numbers that come before them.
#include "fem_reference/grid/kernels.hpp"

namespace springproof::fem_reference::grid {

using namespace mechanics;

namespace {

/// A number that is a type.
template<int n>
struct Count {
  static constexpr int value = n;
};

#include "fem_reference/grid/kernels_stencil.hpp"

#include "mechanics/grid/kernels_masses.hpp"

#include "fem_reference/grid/kernels_points.hpp"

#include "fem_reference/grid/kernels_bubbles.hpp"

#include "fem_reference/grid/kernels_cells.hpp"

#include "fem_reference/grid/kernels_quadratic.hpp"

} // namespace

const Kernels SPRINGPROOF_ISA::kernels{force,           internal_change,       tangent,
                                       deposit_layer,   product_plane<double>, product_plane<float>,
                                       quadratic_force, quadratic_moduli,      quadratic_product,
                                       mass_layer<double>};

} // namespace springproof::fem_reference::grid
