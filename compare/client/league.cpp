#include "compare/client/league.hpp"

#include "cases/case/read_case.hpp"
#include "compare/provenance/print.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/write/quote.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <set>

namespace springproof::compare {

namespace {

/// Settings of a client beside its defaults.
struct ClientSettings {
  int iterations = 0, substeps = 0; ///< 0: the default
  std::vector<std::string> options{};

  bool are_defaults() const { return iterations == 0 && substeps == 0 && options.empty(); }
};

std::string text_of(const ClientSettings& settings) {
  std::string text = settings.iterations > 0 ? fmt::format("{} iterations", settings.iterations) : "";
  if (settings.substeps > 0)
    text += fmt::format("{}{} substeps", text.empty() ? "" : ", ", settings.substeps);
  for (const std::string& word : settings.options) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::vector<ClientSettings> settings_of(const LeagueClient& client) {
  std::vector<ClientSettings> all;
  for (const int iterations : client.iterations)
    for (const int substeps : client.substeps)
      for (const auto& options : client.options)
        if (const ClientSettings one{iterations, substeps, options}; !one.are_defaults()) all.push_back(one);
  return all;
}

/// Whether a row is nearer to the finite elements; one that rests before one that moves, which has means.
bool is_better(const JudgedRow& one, const JudgedRow& other) {
  if (one.is_at_rest != other.is_at_rest) return one.is_at_rest;
  return std::abs(*one.worst) < std::abs(*other.worst);
}

std::string budget_text(const League& league) {
  return fmt::format(
      "Settings are searched for by trying them all; the best is the one with the smallest "
      "worst error whose step takes at most {:.3g} ms. A body has {:g} s to come to rest, an "
      "answer {:g} s of wall-clock time. An engine that is given the springs of the row above and "
      "errs otherwise has not brought them to equilibrium; a smaller error is then one of two that "
      "cancel. The error of a body at rest is the sum of what the springs' law errs by on an infinitely fine "
      "mesh, what the cells add, and what iterations leave; a client's step is counted with its iterations.",
      league.most_milliseconds, league.budget.model_time, league.budget.seconds);
}

std::string in_cell(const Json& value, const char* format) {
  if (value.is_null()) return "-";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number()) return fmt::format(fmt::runtime(format), value.get<double>());
  return escaped(one_line(value.get<std::string>()), {{'|', "\\|"}, {'<', "&lt;"}});
}

} // namespace

std::string missing(const LeagueClient& client) {
  for (const std::string& file : client.needs)
    if (!std::filesystem::exists(file)) return file;
  return "";
}

std::vector<JudgedRow> rows_of(const Judge& judge, const LeagueClient& client, const League& league,
                               const std::function<void(const std::string&)>& tell) {
  const auto ask = [&](const ClientSettings& settings) {
    tell(settings.are_defaults() ? client.name : client.name + ", " + text_of(settings));
    Client asked{client.name, client.words};
    asked.words.insert(asked.words.end(), settings.options.begin(), settings.options.end());
    ClientBudget budget = league.budget;
    budget.iterations = settings.iterations;
    if (client.method) {
      Steps steps = steps_in(*client.method, budget);
      if (settings.substeps > 0) std::visit([&](auto& by) { by.substeps = settings.substeps; }, steps);
      JudgedRow row = judge.step(steps, budget);
      row.model = client.name;
      return row;
    }
    return judge.ask(asked, budget);
  };
  std::vector<JudgedRow> rows{ask({})};
  rows.front().chosen = "defaults";
  const std::vector<ClientSettings> all = settings_of(client);
  if (all.empty()) return rows;
  std::optional<JudgedRow> best;
  const auto consider = [&](JudgedRow row, const std::string& settings) {
    if (!row.worst || !row.milliseconds_a_step || *row.milliseconds_a_step > league.most_milliseconds) return;
    row.chosen = fmt::format("best of {}: {}", all.size() + 1, settings);
    if (!best || is_better(row, *best)) best = std::move(row);
  };
  consider(rows.front(), "defaults");
  for (const ClientSettings& settings : all) consider(ask(settings), text_of(settings));
  if (best) {
    rows.push_back(*best);
    return rows;
  }
  JudgedRow none{client.name};
  none.chosen = fmt::format("best of {}", all.size() + 1);
  none.failure = fmt::format("no settings of {} answer within {:.3g} ms a step", all.size() + 1,
                             league.most_milliseconds);
  rows.push_back(none);
  return rows;
}

LeagueTable play(const League& league, const std::function<void(const std::string&)>& tell) {
  LeagueTable table;
  std::vector<const LeagueClient*> present;
  for (const LeagueClient& client : league.clients) {
    const std::string file = missing(client);
    if (file.empty())
      present.push_back(&client);
    else
      table.skipped.push_back({client.name, file + " is not there: ./do clients installs the engines"});
  }
  for (const std::string& file : league.cases) {
    const cases::Case definition = cases::read_case(file);
    tell(definition.name + ": finite elements");
    const Judge judge(make_scene_within_memory(definition), 0, Parts::told);
    JudgedCase judged = judge.own(league.budget);
    for (const LeagueClient* client : present)
      for (JudgedRow& row : rows_of(judge, *client, league,
                                    [&](const std::string& what) { tell(definition.name + ": " + what); }))
        judged.rows.push_back(std::move(row));
    table.cases.push_back(std::move(judged));
  }
  return table;
}

Json league_to_json(const LeagueTable& table, const League& league) {
  Json document = judged_to_json(table.cases, league.budget);
  document["budget"]["milliseconds_a_step"] = league.most_milliseconds;
  document["skipped"] = json_list(table.skipped, [](const SkippedClient& client) {
    return Json{{"client", client.name}, {"reason", client.reason}};
  });
  document.update(provenance());
  document["method"] = budget_text(league);
  return document;
}

void write_league_markdown(std::ostream& out, const LeagueTable& table, const League& league) {
  const Json provenance_of_all = provenance();
  const Json &machine = provenance_of_all["machine"], &program = provenance_of_all["program"];
  fmt::print(out, "springproof {}; {}, {} cores; {}.\n\n{}\n", program["version"].get<std::string>(),
             machine["processor"].get<std::string>(), machine["cores"].dump(),
             machine["system"].get<std::string>(), budget_text(league));
  for (const SkippedClient& client : table.skipped)
    fmt::print(out, "\n{} was skipped: {}.\n", client.name, client.reason);
  for (const JudgedCase& judged : table.cases) {
    fmt::print(out,
               "\n## {}\n\nErrors from {}.\n\n| model | settings | error, % | +- | at | volume, % | rests "
               "after, s | ms a step | real time | ignores | law, % | mesh, % | step, % | "
               "iterations, % |\n|---|---|---:|---:|---|---:|---:|---:|---|---:|---:|---:|---:|---:|\n",
               judged.name,
               judged.is_converged ? "the finite elements' limit" : "the finite elements on the same mesh");
    for (const JudgedRow& row : judged.rows) {
      const Json json = row_to_json(row);
      const auto cell = [&](const char* key, const char* format = "{:.2f}") {
        return in_cell(json.value(key, Json()), format);
      };
      fmt::print(out, "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |", cell("model"), cell("chosen"),
                 row.failure.empty() ? cell("error_percent") : "failed", cell("error_uncertainty"),
                 cell("at"), cell("volume_percent"), row.is_at_rest ? cell("rests_after") : "moves",
                 cell("milliseconds_a_step"), cell("in_real_time"), cell("ignored", "{:.0f}"));
      for (const NamedPart& part : error_parts)
        fmt::print(out, " {} |", row.parts ? part_text(row.parts.value().*part.part) : "-");
      fmt::print(out, "\n");
    }
    fmt::print(out, "\n");
    std::set<std::string> printed; // both rows of a client may have the same
    for (const JudgedRow& row : judged.rows)
      for (const std::string& note : notes_of(row))
        if (printed.insert(note).second) fmt::print(out, "- {}\n", in_cell(note, ""));
  }
}

} // namespace springproof::compare
