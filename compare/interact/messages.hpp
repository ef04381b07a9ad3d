#pragma once

#include "mechanics/surface/rays.hpp"

#include <string>
#include <variant>

/// What the page of `springproof interact` and its server say to each other.
namespace springproof::compare {

struct AskFrame {}; ///< the page has drawn the last frame and takes another
struct Grab {
  mechanics::Ray ray;
};
struct Drag {
  Eigen::Vector3d by; ///< mm, from where the place was when it was grabbed
};
struct Release {};
struct Restart {};
using PageMessage = std::variant<AskFrame, Grab, Drag, Release, Restart>;

/// The longest text that is a message, bytes.
constexpr std::size_t longest_message = 512;

/// The message in {"type": "frame" | "grab" | "drag" | "release" | "restart"}; a grab has "origin" and
/// "direction", a drag has "by", each of three finite numbers up to 1e9, the direction not 0; and there are
/// no other keys.
/// @return nothing where the text is anything else
std::optional<PageMessage> message_from(const std::string& text);

} // namespace springproof::compare
