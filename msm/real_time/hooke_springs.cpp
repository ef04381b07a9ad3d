#include "msm/real_time/hooke_springs.hpp"

#include "mechanics/grid/clones.hpp"
#include "mechanics/numbers.hpp"

namespace springproof::msm {

namespace {

typedef double Four __attribute__((vector_size(32)));
typedef double FourInMemory __attribute__((vector_size(32), may_alias));

SPRINGPROOF_INLINE FourInMemory& four(double* from) {
  return *reinterpret_cast<FourInMemory*>(from);
}
SPRINGPROOF_INLINE const FourInMemory& four(const double* from) {
  return *reinterpret_cast<const FourInMemory*>(from);
}

SPRINGPROOF_INLINE void transpose(Four (&rows)[4]) {
  const Four a = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6),
             b = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7),
             c = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6),
             d = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
  rows[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  rows[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  rows[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  rows[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/// What four springs move their nodes by, over the nodes' mobility and the way between them; adds to their
/// multipliers.
/// @param squared  of the lengths
/// @param weight   w l²
SPRINGPROOF_INLINE void change_of(FourSprings& springs, bool is_first, const Four& squared,
                                  const Four& weight, Four& change) {
  Four length;
  for (int s = 0; s < 4; ++s) length[s] = __builtin_sqrt(squared[s]);
  const Four stiffness = four(springs.stiffness), slope = stiffness > 0 ? stiffness : Four{},
             multiplier = is_first ? Four{} : four(springs.multiplier),
             force = stiffness * (length - four(springs.rest_length)) + multiplier;
  change = -force * length / (squared + slope * weight);
  change = weight > 0 ? change : Four{}; // none between supports
  four(springs.multiplier) = multiplier + change * length;
}

SPRINGPROOF_CLONES void project_all(FourSprings* springs, std::ptrdiff_t n, bool is_first, double* x) {
  for (FourSprings* all = springs; all != springs + n; ++all) {
    double *begin[4], *end[4];
    Four between[4], d[4];
    for (int s = 0; s < 4; ++s) {
      begin[s] = x + 4 * static_cast<std::ptrdiff_t>(all->nodes[0][s]);
      end[s] = x + 4 * static_cast<std::ptrdiff_t>(all->nodes[1][s]);
      between[s] = d[s] = four(end[s]) - four(begin[s]);
    }
    transpose(d);
    const Four squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], at_begin = four(all->mobility[0]),
               at_end = four(all->mobility[1]);
    Four change;
    change_of(*all, is_first, squared, (at_begin + at_end) * squared, change);
    const Four back = change * at_begin, forth = change * at_end;
    for (int s = 0; s < 4; ++s) {
      four(begin[s]) -= back[s] * between[s];
      four(end[s]) += forth[s] * between[s];
    }
  }
}

SPRINGPROOF_CLONES void project_all(FourSprings* springs, std::ptrdiff_t n, bool is_first, double* x,
                                    const double* mobility) {
  for (FourSprings* all = springs; all != springs + n; ++all) {
    std::ptrdiff_t begin[4], end[4];
    Four between[4], d[4], weights[4];
    for (int s = 0; s < 4; ++s) {
      begin[s] = 4 * static_cast<std::ptrdiff_t>(all->nodes[0][s]);
      end[s] = 4 * static_cast<std::ptrdiff_t>(all->nodes[1][s]);
      between[s] = d[s] = four(x + end[s]) - four(x + begin[s]);
      weights[s] = (four(mobility + begin[s]) + four(mobility + end[s])) * d[s] * d[s];
    }
    transpose(d);
    transpose(weights);
    Four change;
    change_of(*all, is_first, d[0] * d[0] + d[1] * d[1] + d[2] * d[2], weights[0] + weights[1] + weights[2],
              change);
    for (int s = 0; s < 4; ++s) {
      const Four by = change[s] * between[s];
      four(x + begin[s]) -= four(mobility + begin[s]) * by;
      four(x + end[s]) += four(mobility + end[s]) * by;
    }
  }
}

} // namespace

void project(FourSprings* springs, std::ptrdiff_t n, bool is_first, WholePoints& x) {
  project_all(springs, n, is_first, x.front().data());
}
void project(FourSprings* springs, std::ptrdiff_t n, bool is_first, WholePoints& x,
             const WholePoints& mobility) {
  project_all(springs, n, is_first, x.front().data(), mobility.front().data());
}

} // namespace springproof::msm
