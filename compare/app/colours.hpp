#pragma once

#include <memory>
#include <streambuf>

namespace springproof::compare {

/// Colours the verdicts at the beginnings of lines that go to a stream: met green, missed and failed red,
/// warnings yellow. On a terminal alone, and not when the environment variable NO_COLOR is set (no-color.org)
/// or TERM is "dumb". It ends with the object.
class Colours {
 public:
  Colours(std::ostream& stream, int descriptor);
  ~Colours();

 private:
  std::ostream& stream_;
  std::unique_ptr<std::streambuf> colouring_; ///< null: nothing is coloured
  std::streambuf* plain_;
};

} // namespace springproof::compare
