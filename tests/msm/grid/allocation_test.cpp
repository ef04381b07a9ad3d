// Counts what a step allocates. Not built with sanitizers, whose malloc cannot be replaced.
#include "mechanics/dynamics/time_integrator.hpp"
#include "tests/msm/moving_bodies.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cerrno>
#include <cstddef>

namespace {

std::atomic<bool> counts{false};
std::atomic<long> n_allocations{0};

void count() {
  if (counts) ++n_allocations;
}

} // namespace

// The program's own allocation functions, which operator new and Eigen call too.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t n, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) noexcept {
  count();
  return __libc_calloc(n, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  count();
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  count();
  return __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  count();
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}
}

using namespace springproof;

namespace moving_bodies {

namespace {

/// @param pull  a pull on the motion's body, drawn further in every step; null: none
long allocated_by(mechanics::TimeIntegrator& motion, int first, int last, double step,
                  msm::Pull* pull = nullptr) {
  n_allocations = 0;
  counts = true;
  for (int n = first; n <= last; ++n) {
    if (pull) pull->draw_to({0.02 * n, 0, -0.01 * n});
    motion.advance(n * step);
  }
  counts = false;
  return n_allocations;
}

} // namespace

TEST_CASE("after the first steps on a grid a step allocates nothing") {
  { // that it counts
    n_allocations = 0;
    counts = true;
    const std::vector<double> some(100);
    const Vector others = Vector::Zero(100);
    counts = false;
    CHECK(some.size() + static_cast<std::size_t>(others.size()) == 200);
    CHECK(n_allocations == 2);
  }
  msm::CellStiffness power_log = hybrid_springs;
  power_log.exponents = msm::Exponents{-1.3, -1.8, -2.2};
  const cases::MaterialDynamics damped{1000., 2, 0.002};
  for (const auto scheme :
       {cases::Scheme::implicit_euler, cases::Scheme::generalized_alpha, cases::Scheme::bdf2})
    for (const bool is_moved : {false, true})
      for (const auto& cell : {hybrid_springs, power_log}) {
        INFO(cases::name_of(scheme) << (is_moved ? ", moved" : ", under its weight"));
        const double step = 0.005;
        const cases::Dynamics dynamics = steps(scheme, step, 1);
        cases::Scene scene = is_moved ? turned_block(dynamics, damped) : block(dynamics, damped, true);
        if (scheme == cases::Scheme::bdf2) scene = with_consistent_masses(std::move(scene));
        const Moving body(scene, cell);
        mechanics::TimeIntegrator motion(*body.motion, dynamics.scheme, {0, body.rest(), body.rest(), {}});
        allocated_by(motion, 1, 3, step);
        CHECK(allocated_by(motion, 4, 20, step) == 0);
        CHECK(body.motion->work().linear_iterations > 20);
        const auto at = [&](Eigen::Index entry) { return msm::Pull::Entry{entry, 1, true}; };
        const Eigen::Index node = body.vectors.size() / 6, n = body.vectors.size() / 3; // a middle layer's
        for (const double stiffness : {0.01, 2.}) {
          INFO("pulled by " << stiffness << " N/mm");
          const int first = stiffness < 1 ? 21 : 31;
          msm::Pull& pull =
              body.motion->hold({{{{at(node)}, {at(node + n)}, {at(node + 2 * n)}}}, stiffness});
          allocated_by(motion, first, first + 2, step, &pull);
          CHECK(allocated_by(motion, first + 3, first + 9, step, &pull) == 0);
        }
      }
}

TEST_CASE("after the first steps in real time of a body too large for a factor a step allocates nothing") {
  const double step = 0.005;
  const cases::Dynamics dynamics = steps(cases::Scheme::implicit_euler, step, 1);
  for (const double stiffness_damping : {0., 0.002}) {
    CAPTURE(stiffness_damping);
    cases::Scene scene = block(dynamics, {1000., 2, stiffness_damping}, true, 15);
    if (stiffness_damping > 0) scene = with_consistent_masses(std::move(scene));
    const Moving body(scene, hybrid_springs);
    REQUIRE(body.grid.n_unknowns > 10'000);
    mechanics::TimeIntegrator motion(*body.motion, dynamics.scheme, {0, body.rest(), body.rest(), {}},
                                     mechanics::in_real_time(5));
    allocated_by(motion, 1, 3, step);
    CHECK(allocated_by(motion, 4, 10, step) == 0);
    CHECK(body.motion->work().linear_iterations > 10);
    const Eigen::Index n = body.vectors.size() / 3, node = n - 5;
    msm::Pull::Entries entries;
    for (int c = 0; c < 3; ++c) entries[cases::index(c)] = {{node + c * n, 1, true}};
    msm::Pull& pull = body.motion->hold({std::move(entries), 0.5});
    allocated_by(motion, 11, 13, step, &pull);
    CHECK(allocated_by(motion, 14, 20, step, &pull) == 0);
  }
}

} // namespace moving_bodies
