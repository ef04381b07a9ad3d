#pragma once

#include "cases/scene/scene.hpp"

namespace springproof::compare {

/// A dynamic case with a recording of `interact` as loads of both models: the force of a step acts from just
/// after its beginning (a millionth of the step) to its end, on the part of the surface that was pulled.
/// @param text  CSV as read_recording() reads it     @param path  for messages
/// @throws cases::InputError with the line, if it is no recording of the case's step, or ends after the case
cases::Scene with_recording(cases::Scene scene, const std::string& text, const std::string& path);

} // namespace springproof::compare
