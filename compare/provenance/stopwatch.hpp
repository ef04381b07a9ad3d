#pragma once

#include <chrono>
#include <utility>

namespace springproof::compare {

class Stopwatch {
 public:
  /// Wall-clock seconds since construction or the last lap().
  double seconds() const {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    return elapsed.count();
  }
  double lap() { return std::exchange(*this, Stopwatch()).seconds(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace springproof::compare
