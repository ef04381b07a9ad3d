#pragma once

#include <cstddef>

/// Loops over plain arrays, compiled for the widest instructions too: which ones run is decided when the
/// program starts. The same bits with all of them.
namespace springproof::mechanics::grid {

/// a += factor * b
void add(double* a, double factor, const double* b, std::ptrdiff_t n);
void add(float* a, float factor, const float* b, std::ptrdiff_t n);

/// a += b * c, entry by entry
void add_product(double* a, const double* b, const double* c, std::ptrdiff_t n);
void add_product(float* a, const float* b, const float* c, std::ptrdiff_t n);

/// a = b + factor * a
void scale_and_add(double* a, double factor, const double* b, std::ptrdiff_t n);
void scale_and_add(float* a, float factor, const float* b, std::ptrdiff_t n);

double dot(const double* a, const double* b, std::ptrdiff_t n);

/// out = keep * out + factor * (blocks) in, of the first n nodes.
/// @param blocks  symmetric 3x3 blocks, one for each node: six arrays xx, yy, zz, yz, xz, xy
/// @param size    from one array to the next
void apply_blocks(const float* blocks, const float* in, float* out, std::ptrdiff_t size, float keep,
                  float factor, std::ptrdiff_t n);

} // namespace springproof::mechanics::grid
