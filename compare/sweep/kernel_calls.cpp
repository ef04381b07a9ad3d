// springproof_kernel_calls KERNEL CELLS CALLS runs one kernel of the springs so many times on a cube of
// cells, and nothing else that grows with the calls: `springproof sweep --perf` has its instructions counted.

#include "msm/grid/multigrid.hpp"
#include "msm/lattice.hpp"

#include <functional>
#include <iostream>
#include <map>

namespace {

using msm::grid::Body;
using msm::grid::Clamp;
using msm::grid::Field;

/// A cube of cells of 1 mm, its lowest plane held.
Body cube(int cells) {
  Body body;
  body.cells = {cells, cells, cells};
  body.spacing = {1, 1, 1};
  body.springs = {{{0.031, 0.031, 0.031}, {0.047, 0.047, 0.047}, 0.033, 0}};
  set_layout(body, [](int, int, int k, int) { return k == 0; });
  return body;
}

/// One call of a kernel on fields that stay as they are.
template<class Real>
struct Grid {
  explicit Grid(const Body& body)
      : springs(body, 1), displacement(Field<Real>::Zero(3 * body.layout.size)), result(displacement),
        blocks(Field<Real>::Zero(6 * body.layout.size)) {}
  void force() { springs.force(displacement, result); }
  void product() { springs.product(Clamp::yes, displacement, displacement, result); }
  void diagonal() { springs.inverse_diagonal(Clamp::yes, displacement, blocks); }
  void energy() { result[0] = static_cast<Real>(springs.energy(displacement)); }

  msm::grid::SpringField<Real> springs;
  Field<Real> displacement, result, blocks;
};

template<class Real>
void run_grid(int cells, int calls, void (Grid<Real>::*kernel)()) {
  const Body body = cube(cells);
  Grid<Real> grid(body);
  for (int n = 0; n < calls; ++n) (grid.*kernel)();
}

void run_multigrid(int cells, int calls) {
  const Body body = cube(cells);
  const std::deque<Body> bodies = msm::grid::coarsenings(body);
  msm::grid::Multigrid multigrid(bodies, 1);
  Field<double> field = Field<double>::Zero(3 * body.layout.size), solution = field;
  multigrid.linearise(field);
  field[body.layout.at(1, 1, cells)] = 1;
  for (int n = 0; n < calls; ++n) multigrid.apply(field, solution);
}

/// By the list of springs, as on meshes that are no grid.
void run_list(int cells, int calls) {
  const msm::Lattice lattice =
      msm::make_lattice(cases::make_box_mesh({cells * 1.0, cells * 1.0, cells * 1.0}, {cells, cells, cells}),
                        {{0.031, 0.047, 0.033, 0}});
  for (int n = 0; n < calls; ++n) msm::internal_force(lattice, lattice.rest);
}

const std::map<std::string, std::function<void(int cells, int calls)>> kernels{
    {"force_double", [](int n, int calls) { run_grid<double>(n, calls, &Grid<double>::force); }},
    {"force_float", [](int n, int calls) { run_grid<float>(n, calls, &Grid<float>::force); }},
    {"product_double", [](int n, int calls) { run_grid<double>(n, calls, &Grid<double>::product); }},
    {"product_float", [](int n, int calls) { run_grid<float>(n, calls, &Grid<float>::product); }},
    {"diagonal_float", [](int n, int calls) { run_grid<float>(n, calls, &Grid<float>::diagonal); }},
    {"energy_double", [](int n, int calls) { run_grid<double>(n, calls, &Grid<double>::energy); }},
    {"multigrid_cycle", run_multigrid},
    {"list_force", run_list}};

} // namespace

int main(int argc, char** argv) {
  const auto kernel = argc == 4 ? kernels.find(argv[1]) : kernels.end();
  if (kernel == kernels.end()) {
    std::cerr << "usage: springproof_kernel_calls KERNEL CELLS CALLS, with one of the kernels";
    for (const auto& entry : kernels) std::cerr << ' ' << entry.first;
    std::cerr << '\n';
    return 2;
  }
  kernel->second(std::stoi(argv[2]), std::stoi(argv[3]));
}
