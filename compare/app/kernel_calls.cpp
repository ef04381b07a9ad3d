// springproof_kernel_calls CELLS KERNEL... calls each of these kernels of the springs once on a cube of
// cells. `springproof sweep --perf` has the instructions counted that run below springproof_counted_call.

#include "compare/sweep/timed_cube.hpp"
#include "msm/grid/spring_levels.hpp"
#include "msm/spring_body.hpp"

#include <functional>
#include <map>

using namespace springproof;

/// The function that callgrind collects in, and after which it writes what it has.
extern "C" void springproof_counted_call(const std::function<void()>& call);

extern "C" __attribute__((noipa)) void springproof_counted_call(const std::function<void()>& call) {
  call();
}

namespace {

using msm::Clamp;
using msm::grid::Body;
using msm::grid::Field;

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
void run_grid(int cells, void (Grid<Real>::*kernel)()) {
  const Body body = compare::timed_cube(cells);
  Grid<Real> grid(body);
  (grid.*kernel)(); // the first call also binds its functions
  springproof_counted_call([&] { (grid.*kernel)(); });
}

void run_multigrid(int cells) {
  const Body body = compare::timed_cube(cells);
  msm::grid::SpringLevels multigrid(body, 1);
  Field<double> field = Field<double>::Zero(3 * body.layout.size), solution = field;
  multigrid.linearise(field);
  field[body.layout.at(1, 1, cells)] = 1;
  springproof_counted_call([&] { multigrid.apply(field, solution); });
}

/// Runs over the list of springs, as on meshes that are no grid.
void run_list(int cells) {
  const msm::Lattice lattice =
      msm::make_lattice(cases::make_box_mesh({cells * 1.0, cells * 1.0, cells * 1.0}, {cells, cells, cells}),
                        {{0.031, 0.047, 0.033, 0}});
  springproof_counted_call([&] { msm::internal_force(lattice, lattice.rest); });
}

const std::map<std::string, std::function<void(int cells)>> kernels{
    {"force_double", [](int n) { run_grid<double>(n, &Grid<double>::force); }},
    {"force_float", [](int n) { run_grid<float>(n, &Grid<float>::force); }},
    {"product_double", [](int n) { run_grid<double>(n, &Grid<double>::product); }},
    {"product_float", [](int n) { run_grid<float>(n, &Grid<float>::product); }},
    {"diagonal_float", [](int n) { run_grid<float>(n, &Grid<float>::diagonal); }},
    {"energy_double", [](int n) { run_grid<double>(n, &Grid<double>::energy); }},
    {"multigrid_cycle", run_multigrid},
    {"list_force", run_list}};

} // namespace

int main(int argc, char** argv) {
  for (int n = 2; n < argc; ++n) kernels.at(argv[n])(std::stoi(argv[1]));
}
