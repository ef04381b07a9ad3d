#pragma once

#include "cases/scene/scene.hpp"

#include <string>

/// What a client is told: a line of JSON that lists the arrays after it, and these arrays as little-endian
/// doubles, row after row. SI units. docs/reference/client-protocol.md has every key.
namespace springproof::compare {

constexpr int client_protocol = 1;

/// What clients may spend.
struct ClientBudget {
  double step = 1. / 60;     ///< s, of a body that is to come to rest; a motion has its case's
  int iterations = 0;        ///< a step; 0: the client's own default
  double model_time = 20;    ///< s, within which a body is to come to rest
  double start_seconds = 30; ///< until a client has read its scene and introduced itself
  double seconds = 300;      ///< that the whole answer may take
};

/// @throws cases::InputError when no springs can be designed
/// @throws cases::SolveError when the scene has what the protocol has no words for
std::string scene_message(const cases::Scene& scene, const ClientBudget& budget);

} // namespace springproof::compare
