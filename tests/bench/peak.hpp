#pragma once

/// Floating-point operations per second that one thread of this machine can do at most: chains of fused
/// multiply-adds in registers, the best of several runs, measured once.
/// @tparam Real  double or float
template<class Real>
double peak_flops();

extern template double peak_flops<double>();
extern template double peak_flops<float>();
