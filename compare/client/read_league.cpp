#include "cases/case/toml_table.hpp"
#include "compare/client/league.hpp"

#include <filesystem>

namespace springproof::compare {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> read_texts(const cases::Entry& entry) {
  std::vector<std::string> texts;
  for (const cases::Entry& element : entry.elements("a list of texts")) {
    const auto text = element.value<std::string>();
    if (!text) element.refuse("a text");
    texts.push_back(*text);
  }
  return texts;
}

std::vector<int> read_counts(const cases::Entry& entry) {
  const cases::WholeNumber count{"a whole number from 0 to 1000000", 0, 1'000'000};
  std::vector<int> counts;
  for (const cases::Entry& one : entry.elements("a list of whole numbers")) counts.push_back(count(one));
  return counts.empty() ? std::vector<int>{0} : counts;
}

/// Words of a command, those that name files of the folder by their paths. No words are none.
std::vector<std::string> words_in(const fs::path& folder, const std::string& command) {
  if (command.find_first_not_of(" \t\n") == std::string::npos) return {};
  std::vector<std::string> words = words_of_command(command);
  for (std::string& word : words)
    if (word.find('/') != std::string::npos && fs::exists(folder / word))
      word = fs::absolute(folder / word).lexically_normal().string();
  return words;
}

LeagueClient read_client(cases::Table& table, const fs::path& folder) {
  LeagueClient client;
  client.name = table.required("name", cases::read_text);
  client.method = table.optional(
      "method", [](const cases::Entry& entry) { return *method_called(entry.word(method_names())); });
  table.refuse_unless(!client.method, {"command", "needs", "options"},
                      "left out beside method, which is ours");
  table.refuse_unless(client.method.has_value(), {"substeps"}, "left out without method");
  if (!client.method) {
    client.words = words_in(folder, table.required("command", cases::read_text));
    if (client.words.empty()) table.entry("command").refuse("a command");
  }
  for (const std::string& file : table.optional("needs", read_texts).value_or(std::vector<std::string>{}))
    client.needs.push_back((folder / file).string());
  client.iterations = table.optional("iterations", read_counts).value_or(std::vector<int>{0});
  client.substeps = table.optional("substeps", read_counts).value_or(std::vector<int>{0});
  for (const std::string& words : table.optional("options", read_texts).value_or(std::vector<std::string>{}))
    client.options.push_back(words_in(folder, words));
  if (client.options.empty()) client.options = {{}};
  return client;
}

} // namespace

League read_league(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  const toml::table document = cases::parse_file(file, {});
  cases::Table root({&document, cases::Where{file, 1, 1, ""}}, "a table");
  League league;
  for (const std::string& one : root.required("cases", read_texts))
    league.cases.push_back((folder / one).lexically_normal().string());
  const cases::Number positive{"a number above 0", cases::is_positive};
  league.most_milliseconds = root.optional("milliseconds_a_step", positive).value_or(1e3 / 60);
  league.budget.seconds = root.optional("seconds", positive).value_or(league.budget.seconds);
  league.budget.model_time = root.optional("end", positive).value_or(league.budget.model_time);
  league.clients = root.sections("client", [&](cases::Table& table) { return read_client(table, folder); });
  root.refuse_unknown_keys();
  if (league.cases.empty()) root.entry("cases").refuse("one or more case files");
  for (std::size_t i = 0; i < league.clients.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (league.clients[i].name == league.clients[j].name)
        throw cases::InputError(file + ": client.name: two clients are called \"" + league.clients[i].name +
                                "\"; give each a name of its own");
  return league;
}

} // namespace springproof::compare
