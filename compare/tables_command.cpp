#include "compare/atomic_file.hpp"
#include "compare/commands.hpp"
#include "compare/tables.hpp"

#include <fmt/format.h>
#include <iostream>
#include <memory>
#include <mpi.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace compare {

namespace {

struct TablesOptions {
  std::vector<std::string> tables;
  std::string out;
  bool json = false;
};

int tables(TablesOptions options) {
  if (options.tables.empty()) options.tables = known_tables();
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const bool show_progress = rank == 0 && isatty(STDERR_FILENO);
  const auto entries = regenerate(options.tables, [&](int done, int all) {
    if (show_progress)
      std::cerr << fmt::format("\r{} of {} comparisons{}", done, all, done == all ? "\n" : "");
  });
  const bool failed =
      std::any_of(entries.begin(), entries.end(), [](const TableEntry& e) { return !e.nearest(); });
  if (rank != 0) return failed;
  if (options.json)
    std::cout << tables_to_json(entries).dump(2) << '\n';
  else
    write_tables_text(std::cout, entries);
  if (!options.out.empty()) {
    write_file(options.out + "/tables.txt", [&](std::ostream& out) { write_tables_text(out, entries); });
    write_file(options.out + "/tables.csv", [&](std::ostream& out) { write_tables_csv(out, entries); });
    write_file(options.out + "/tables.json",
               [&](std::ostream& out) { out << tables_to_json(entries).dump(2) << '\n'; });
  }
  return failed;
}

} // namespace

void add_tables_command(CLI::App& program, Action& chosen) {
  auto options = std::make_shared<TablesOptions>();
  CLI::App* command =
      program.add_subcommand("tables", "regenerate the thesis's tables, ours beside the published");
  command->add_option("table", options->tables, "numbers of tables; all when left out");
  command->add_option("--out", options->out, "folder for tables.txt, tables.csv and tables.json");
  command->add_flag("--json", options->json, "one JSON document on standard output, and nothing else there");
  command->callback([options, &chosen] { chosen = [options] { return tables(*options); }; });
}

} // namespace compare
