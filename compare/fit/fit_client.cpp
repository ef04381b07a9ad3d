#include "cases/case/error.hpp"
#include "compare/fit/fit.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

const std::string before_name = "client.";

/// What stands in a command for a parameter.
std::string in_braces(const std::string& key) {
  return "{" + key.substr(before_name.size()) + "}";
}

Client with_values(const Client& client, const std::vector<FreeParameter>& parameters,
                   const Eigen::VectorXd& values) {
  Client filled = client;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (!is_of_client(parameters[p].name)) continue;
    const std::string braces = in_braces(parameters[p].name);
    const std::string value = fmt::format("{:.17g}", values[static_cast<Eigen::Index>(p)]);
    for (std::string& word : filled.words)
      for (std::size_t at = word.find(braces); at != std::string::npos; at = word.find(braces, at))
        word.replace(at, braces.size(), value);
  }
  return filled;
}

} // namespace

bool is_of_client(const std::string& key) {
  return key.rfind(before_name, 0) == 0;
}

Answers ask_with_values(const cases::Scene& scene, const Client& client,
                        const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& values) {
  try {
    return with_client({}, scene, with_values(client, parameters, values));
  } catch (const cases::InputError& error) {
    Answers failed;
    failed.msm.solution.status = cases::Status::failed;
    failed.msm.solution.message = error.what();
    return failed;
  }
}

void check_client_parameters(const std::vector<FreeParameter>& parameters,
                             const std::optional<Client>& client) {
  for (const FreeParameter& parameter : parameters) {
    if (!is_of_client(parameter.name)) continue;
    const std::string braces = in_braces(parameter.name);
    const auto has = [&](const std::string& word) { return word.find(braces) != std::string::npos; };
    if (!client || std::none_of(client->words.begin(), client->words.end(), has))
      throw cases::InputError(
          fmt::format("--free: {}: the command of --client must have {} where its value belongs",
                      parameter.name, braces));
  }
}

} // namespace springproof::compare
