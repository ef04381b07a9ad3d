#include "compare/app/commands.hpp"

#include "cases/case/error.hpp"
#include "compare/client/league.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/report/pages.hpp"
#include "compare/table/table.hpp"

#include <iostream>

namespace springproof::compare {

namespace {

struct LeagueOptions {
  std::string file, out;
  bool json = false;
};

int run(const LeagueOptions& options) {
  if (n_mpi_ranks() > 1) throw cases::InputError("league: runs on one rank; start it without mpirun");
  const League league = read_league(options.file);
  claim_folder(options.out);
  const LeagueTable table = play(league, [](const std::string& what) { std::cerr << what << "\n"; });
  const Json document = league_to_json(table, league);
  write_json_file(options.out + "/league.json", document);
  write_file(options.out + "/league.md",
             [&](std::ostream& out) { write_league_markdown(out, table, league); });
  write_page(
      options.out + "/league.html", "League",
      {{"heading", "League"},
       {"subheading", "Engines and finite elements on the same cases, by their defaults and by the best "
                      "settings that were found"},
       {"times", Json::array()},
       {"league", document}});
  if (options.json)
    std::cout << json_text(document);
  else
    for (const JudgedCase& judged : table.cases) write_judged_text(std::cout, judged);
  return 0;
}

} // namespace

void add_league_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<LeagueOptions>(
      program, chosen, "league",
      "engines side by side on some cases, by their defaults and their best settings", run);
  command->add_option("file", options->file, "what answers what (TOML)")->required();
  command->add_option("--out", options->out, "folder for league.html, league.md and league.json")->required();
  add_json_option(*command, options->json);
}

} // namespace springproof::compare
