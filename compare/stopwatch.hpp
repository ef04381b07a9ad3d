#pragma once

#include <chrono>
#include <utility>

namespace compare {

class Stopwatch {
 public:
  /// Wall-clock seconds since construction or the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> elapsed = now - std::exchange(start_, now);
    return elapsed.count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace compare
