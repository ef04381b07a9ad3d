#pragma once

#include "compare/solve/answers.hpp"

#include <CLI/CLI.hpp>

namespace springproof::compare {

/// --replay, of the commands that solve both models of what was pulled.
CLI::Option* add_replay_option(CLI::App& command, std::string& recording);

/// The one question of a command with --replay, with the recording's forces as loads.
/// @param recording  a file of `interact`; empty: the questions stay as they are
/// @throws cases::InputError where there are several questions, or the file is no recording of the case
std::vector<Question> with_recording(std::vector<Question> questions, const std::string& recording);

} // namespace springproof::compare
