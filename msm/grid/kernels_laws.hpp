// Part of kernels_source.hpp, in its namespace: the laws of springs (msm/spring_laws.hpp) on packs. What is
// written for P works on a pack, and on one number in loops that the compiler turns into packs.
#pragma once

/// |d|². A ghost may lie where a node is: hence the 1e-30.
template<class P>
SPRINGPROOF_INLINE P squared_length(const Vec<P>& d) {
  const P least = P{} + 1e-30f;
  return ((least + d.x * d.x) + d.y * d.y) + d.z * d.z;
}

/// A law's functions.
struct Fast {
  static constexpr double of_exponential = 1.4426950408889634; ///< 1/ln 2
  template<class P>
  SPRINGPROOF_INLINE static P inverse_length(const P& squared) {
    return inverse_root(squared);
  }
  template<class P>
  SPRINGPROOF_INLINE static P length(const P& squared) {
    return squared * inverse_length(squared);
  }
  /// k (1 - l0/|d|); k l0 is had while the root is still computed.
  template<class P>
  SPRINGPROOF_INLINE static P elongation_share(const P& k, RealOf<P> rest, const P& squared) {
    return k - rest * k * inverse_length(squared);
  }
  template<class P>
  SPRINGPROOF_INLINE static P over_squared(const P& x, const P& squared) {
    const P inverse = inverse_length(squared);
    return x * (inverse * inverse);
  }
  template<class P>
  SPRINGPROOF_INLINE static P log_stretch(const P& squared, RealOf<P>, RealOf<P> inverse_rest_squared) {
    return half_log(squared * inverse_rest_squared + RealOf<P>(1e-30));
  }
  template<class P>
  SPRINGPROOF_INLINE static P exponential(const P& x) {
    return power_of_two(x);
  }
  /// NaN where J <= 0, set by its bits, since -ffast-math knows no NaN. Where there is no cell, J is
  /// anything, and k is 0.
  template<class P>
  SPRINGPROOF_INLINE static P log_volume(const P& ratio, const P& k) {
    const auto is_number = (ratio > P{}) | (k == P{}); // a mask for a pack
    const Bits<P> none = is_number ? Bits<P>{} : ~Bits<P>{};
    return bits_as<P>(bits_as<Bits<P>>(RealOf<P>(2) * half_log(ratio)) | none);
  }
};

/// Places of a cell's edges along x, y, z among the 13 springs.
constexpr int edge_along[3] = {12, 10, 4};

/// The laws of the 13 springs and of the volume terms.
template<class SpringLaw, class Real>
struct Laws {
  using Volume = typename SpringLaw::Volume;
  SpringLaw spring[n_springs];
  Volume volume;
  SPRINGPROOF_INLINE explicit Laws(const Springs<Real>& s) : volume{s.rest_volume} {
    for (int i = 0; i < n_springs; ++i) spring[i] = SpringLaw(s.rest_length[i], s.parameter[i]);
  }
};

/// action(laws)
template<class Real, class Action>
SPRINGPROOF_INLINE auto with_laws(const Springs<Real>& s, const Action& action) {
  return with_law<Real, Fast>(s.law,
                              [&](auto law) { return action(Laws<typename decltype(law)::type, Real>(s)); });
}
