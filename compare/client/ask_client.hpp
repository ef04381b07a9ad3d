#pragma once

#include "compare/client/confined_program.hpp"
#include "compare/client/scene_message.hpp"
#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// A program that answers scenes.
struct Client {
  std::string name;
  std::vector<std::string> words; ///< its command
};

/// `NAME=COMMAND` of the command line. A word with a "/" that is a file's path from here becomes absolute.
/// @throws cases::InputError saying what is missing
Client client_of(const std::string& argument);

/// What a client says of itself.
struct Introduction {
  std::string name, version, method;
  std::string settings;                 ///< JSON
  std::vector<std::string> unsupported; ///< what of the scene it ignores
};

/// A client's answer: a failed one has its reason, whatever the client did.
struct ClientAnswer {
  Answer answer;
  std::optional<Introduction> introduction{}; ///< absent where it did not come to that
  bool is_at_rest = true;                     ///< false: it ran out of time; a motion always is
  double model_time = 0;                      ///< s, of the last frame
  std::optional<double> mean_from{};          ///< s; present where a moving body is given by its mean places
  double stepping_seconds = 0;                ///< as the client has measured
  int n_steps = 0;                            ///< as it has counted
  std::vector<std::string> warnings{};        ///< what no answer to the case does

  std::optional<double> milliseconds_a_step() const {
    return n_steps > 0 ? std::optional(1e3 * stepping_seconds / n_steps) : std::nullopt;
  }
};

/// Says that a body still moves.
/// @param mean_from  s; absent: its places are those at the end
std::string describe_moving(double time, std::optional<double> mean_from);

/// Starts a client, confined, tells it the scene, and takes its frames as the springs' solution.
/// @throws cases::InputError when no springs can be designed
ClientAnswer ask_client(const cases::Scene& scene, const Client& client, const ClientBudget& budget);

/// `--client` of commands that put its answers in place of our springs'.
/// @param argument  empty: there is none
/// @throws cases::InputError if it is no NAME=COMMAND, on several ranks, or if a measure of a case needs more
/// than displacements
std::optional<Client> read_client(const std::vector<Question>& questions, const std::string& argument);

/// The answers with a client's in place of our springs', asked now in the default budget.
Answers with_client(Answers answers, const cases::Scene& scene, const Client& client);

} // namespace springproof::compare
