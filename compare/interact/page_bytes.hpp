#pragma once

#include <Eigen/Core>
#include <cstring>
#include <string>

/// Numbers for the page, little endian: its machine and the server's are one.
namespace springproof::compare {

template<class To, class From>
void append(std::string& bytes, From value) {
  const To number = static_cast<To>(value);
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

inline void append(std::string& bytes, const Eigen::Vector3d& vector) {
  for (int axis = 0; axis < 3; ++axis) append<float>(bytes, vector[axis]);
}

} // namespace springproof::compare
