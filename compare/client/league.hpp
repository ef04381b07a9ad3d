#pragma once

#include "compare/client/judge.hpp"

#include <functional>

/// Engines side by side on some cases, each with its defaults and with the best settings that a stated search
/// finds: `springproof league`.
namespace springproof::compare {

struct LeagueClient {
  std::string name;
  std::vector<std::string> words; ///< its command; none: a method of ours
  std::optional<AnyMethod> method{};
  std::vector<std::string> needs; ///< files or folders without which it is skipped
  // What is tried beside the defaults: all combinations of these.
  std::vector<int> iterations;                   ///< 0: the client's default
  std::vector<int> substeps;                     ///< a method's; 0: its default
  std::vector<std::vector<std::string>> options; ///< words behind the command
};

struct League {
  std::vector<std::string> cases; ///< case files
  std::vector<LeagueClient> clients;
  double most_milliseconds; ///< that a step may take by the settings that are searched for
  ClientBudget budget;
};

/// Reads a league's TOML file. Files in it are relative to its folder; a word of a command that has a "/" and
/// names a file there becomes its path.
/// @throws cases::InputError that says where, what, and what is allowed
League read_league(const std::string& file);

struct SkippedClient {
  std::string name, reason;
};

struct LeagueTable {
  std::vector<JudgedCase> cases;
  std::vector<SkippedClient> skipped;
};

/// A file or folder that a client needs and that is not there; empty where it has all.
std::string missing(const LeagueClient& client);

/// The rows of a client in a case: its defaults, and the best of them and of its settings within the budget.
std::vector<JudgedRow> rows_of(const Judge& judge, const LeagueClient& client, const League& league,
                               const std::function<void(const std::string&)>& tell);

/// Solves every case once, and asks every client by its defaults and by each of its settings.
/// @param tell  told what is about to be asked: "beam: Jolt, 15 iterations"
/// @throws cases::InputError when a case has no measure, or no springs
LeagueTable play(const League& league, const std::function<void(const std::string&)>& tell);

/// {"schema", "budget", "skipped", "cases"} of judged_to_json(), with what clients were skipped and why.
Json league_to_json(const LeagueTable& table, const League& league);
/// The same as a page of Markdown: a table for each case, and what belongs to its rows.
void write_league_markdown(std::ostream& out, const LeagueTable& table, const League& league);

} // namespace springproof::compare
