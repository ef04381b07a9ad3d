#pragma once

#include <cstddef>

namespace springproof::cases {

/// A whole number that is not negative, as the standard library's containers want their indices.
inline std::size_t index(std::ptrdiff_t i) {
  return static_cast<std::size_t>(i);
}

} // namespace springproof::cases
