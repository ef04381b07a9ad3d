#include "cases/case/installation.hpp"
#include "cases/case/read_case.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "compare/app/commands.hpp"
#include "compare/client/judge.hpp"
#include "compare/interact/server.hpp"
#include "compare/interact/simulation.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/report/pages.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/table/json.hpp"
#include "compare/write/quote.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <memory>

namespace springproof::compare {

namespace {

struct InteractOptions {
  std::string file;
  std::vector<std::string> settings;
  std::string method; ///< NAME[:ITERATIONS[:SUBSTEPS]]; empty: the case's own steps
  int port = 0, n_spheres = 271, n_threads = 1;
  double stiffness = 100; ///< N/m
  double seconds = 0;     ///< 0: until the page is closed
  bool stays = false, json = false;
  std::string out;
};

std::string page_of(const cases::Case& definition) {
  const std::string report = cases::data_folder("report");
  return filled_page("interact", {{"title", escape(definition.name)},
                                  {"three_licence", escape(read_file(report + "/three_licence.txt"))},
                                  {"nonce", "{{nonce}}"}, // the server's
                                  {"socket", "{{socket}}"}});
}

nlohmann::ordered_json summary_to_json(const SimulationSummary& summary, const ServerCounts& counts) {
  return {
      {"method", summary.method},
      {"steps", summary.n_steps},
      {"pulled_steps", summary.n_pulled},
      {"pressed_steps", summary.n_pressed},
      {"largest_tool_force", summary.largest_tool_force},
      {"failed_steps", summary.troubles.n_failures},
      {"failure", summary.troubles.failure},
      {"unfinished_steps", summary.troubles.n_unfinished},
      {"largest_residual", summary.troubles.largest_residual},
      {"step_ms", {{"median", summary.median_ms}, {"p99", summary.p99_ms}, {"largest", summary.largest_ms}}},
      {"keeps_60_hz", nlohmann::ordered_json(summary.keeps_60_hz())},
      {"frames",
       {{"made", summary.n_frames},
        {"sent", counts.n_frames_sent},
        {"dropped", counts.n_frames_dropped},
        {"with_inverted_cells", summary.n_inverted_frames}}},
      {"pages", counts.n_pages},
      {"refused_requests", counts.n_refused},
      {"pages_cut_off", counts.n_cut_off}};
}

void print_summary(const SimulationSummary& summary, const ServerCounts& counts) {
  if (summary.n_steps == 0) print(std::cout, "{}: no step; the page was not opened\n", summary.method);
  if (summary.n_steps > 0)
    print(std::cout,
          "{}: {} steps, {} of them pulled; a step took {:.3g} ms (median), {:.3g} ms (99 %), {:.3g} ms at "
          "most: "
          "{} 60 Hz; it left {:.2g} % of its forces at most\n",
          summary.method, summary.n_steps, summary.n_pulled, summary.median_ms, summary.p99_ms,
          summary.largest_ms, *summary.keeps_60_hz() ? "keeps" : "does not keep",
          100 * summary.troubles.largest_residual);
  if (summary.n_pressed > 0)
    print(std::cout, "a tool pressed in {} steps, with {:.3g} N at most\n", summary.n_pressed,
          summary.largest_tool_force);
  print(std::cout, "{} frames sent, {} dropped; {} requests refused, {} pages cut off\n",
        counts.n_frames_sent, counts.n_frames_dropped, counts.n_refused, counts.n_cut_off);
  if (summary.n_inverted_frames > 0)
    print(std::cout, "{} frames had cells inside out\n", summary.n_inverted_frames);
  if (summary.troubles.n_unfinished > 0)
    print(std::cout,
          "{} steps ended in real time with more than 1 % of the loads unbalanced, {:.2g} % at most\n",
          summary.troubles.n_unfinished, 100 * summary.troubles.largest_residual);
  if (summary.troubles.n_failures > 0)
    print(std::cout, "{} steps could not be solved, and began anew from rest; the last: {}\n",
          summary.troubles.n_failures, summary.troubles.failure);
}

/// Writes the recording to a file that is not there already.
/// @return where it was written; empty: there is nothing to keep
/// @param kind  ends the file's name     @param has_any  whether there is one to keep
template<class Write>
std::string keep_recording(const InteractOptions& options, const cases::Case& definition,
                           const std::string& kind, bool has_any, const Write& write) {
  if (options.out.empty() || !has_any) return "";
  const std::string stem = options.out + "/" + definition.name + kind;
  std::string path = stem + ".csv";
  for (int number = 2; std::filesystem::exists(path); ++number) path = fmt::format("{}_{}.csv", stem, number);
  write_file(path, write);
  return path;
}

int run(const InteractOptions& options) {
  if (n_mpi_ranks() > 1) throw cases::InputError("interact runs on one rank");
  cases::check_has_vtk(); // for the drawn surface
  cases::Case definition = cases::read_case(options.file, options.settings);
  std::optional<Steps> steps;
  if (!options.method.empty()) steps = method_of(options.method, {}).steps;
  const auto* const of_elements = steps ? std::get_if<cases::ElementRealTime>(&*steps) : nullptr;
  std::vector<std::string> ignored;
  if (steps && !of_elements) ignored = set_steps(definition, std::get<cases::RealTime>(*steps));
  cases::Scene scene = make_scene_within_memory(definition);
  if (of_elements) ignored = set_steps(scene, *of_elements);
  if (!ignored.empty()) print(std::cerr, "{} ignores {}\n", options.method, fmt::join(ignored, "; "));
  cases::refuse_network(scene.definition, "interact, which pulls at a surface",
                        "run --out --report shows its motion");
  check_memory(options.file, {estimate_springs(size_of(scene))}, memory_limit());
  claim_folder(options.out);
  std::unique_ptr<PageServer> server; // the simulation's thread sends to it, and is stopped before it
  Simulation simulation(
      scene,
      {static_cast<std::size_t>(options.n_spheres), 1e-3 * options.stiffness, options.n_threads,
       of_elements ? cases::Side::fem : cases::Side::msm},
      [&](std::shared_ptr<const std::string> frame) { server->send_frame(std::move(frame)); });
  ServedPage page;
  page.html = page_of(scene.definition);
  page.first_text = simulation.description();
  page.first_bytes = simulation.geometry();
  page.on_control = [&] { simulation.start(); };
  page.on_leave = [&] { simulation.pause(); };
  page.on_text = [&](const std::string& text) {
    const auto message = message_from(text);
    if (message) simulation.send(*message);
    return message.has_value();
  };
  page.longest_text = longest_message;
  page.ends_with_page = !options.stays;
  server = std::make_unique<PageServer>(std::move(page), options.port);
  // In JSON the address would end the document's first line: it goes where progress goes.
  print(options.json ? std::cerr : std::cout, "open {}\n", server->address());
  (options.json ? std::cerr : std::cout).flush();
  server->run(options.seconds);
  simulation.stop();
  const SimulationSummary summary = simulation.summary();
  // Before a word is printed: the terminal may be gone.
  const std::string kept = keep_recording(options, scene.definition, "_pulls", simulation.has_recording(),
                                          [&](std::ostream& out) { simulation.write_recording(out); });
  const std::string of_tools =
      keep_recording(options, scene.definition, "_tools", simulation.has_tool_recording(),
                     [&](std::ostream& out) { simulation.write_tool_recording(out); });
  if (options.json) {
    nlohmann::ordered_json interaction = summary_to_json(summary, server->counts());
    interaction["recording"] = kept.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(kept);
    interaction["tool_recording"] =
        of_tools.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(of_tools);
    std::cout << json_text({{"schema", 1}, {"interaction", interaction}});
  } else {
    print_summary(summary, server->counts());
    if (!options.out.empty() && (!kept.empty() || of_tools.empty()))
      print(std::cout, "{}\n", kept.empty() ? "nothing was pulled since the last start: no recording" : kept);
    if (!of_tools.empty()) print(std::cout, "{}\n", of_tools);
  }
  if (simulation.is_recording_full())
    print(std::cerr, "the recording ends after {} steps with a pull\n", most_recorded);
  return 0;
}

} // namespace

void add_interact_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<InteractOptions>(
      program, chosen, "interact",
      "a dynamic case's springs or elements on a page of this machine, to turn and to pull in real time",
      run);
  command->add_option("case", options->file, "case file (TOML) with [dynamics]")->required();
  add_set_option(*command, options->settings, "override a key of the case: dynamics.step=0.02");
  command->add_option(
      "--method", options->method,
      "NAME[:ITERATIONS[:SUBSTEPS]]: a method of [msm] real_time, in place of the case's steps; fem.NAME: "
      "the finite elements by one of [fem] real_time");
  command->add_option("--port", options->port, "of 127.0.0.1; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_option("--stiffness", options->stiffness, "of the spring that pulls, N/m")
      ->check(number_between(1e-6, 1e9))
      ->capture_default_str();
  command->add_option("--spheres", options->n_spheres, "that cover the surface, to take hold of")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--threads", options->n_threads, "of the springs' multigrid path, and of methods")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->add_flag("--stay", options->stays, "go on when the page is closed, until Ctrl-C");
  command->add_option("--seconds", options->seconds, "end after so many seconds in any case")
      ->check(number_between(0.1, 1e6));
  command->add_option("--out", options->out, "folder for the recordings of pulls and of tools");
  command->add_flag(
      "--json", options->json,
      "what has been, as one JSON document on standard output; the address goes to standard error");
}

} // namespace springproof::compare
