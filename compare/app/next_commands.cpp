#include "compare/app/next_commands.hpp"

#include "cases/case/names.hpp"
#include "compare/write/quote.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace springproof::compare {

namespace {

/// The words of `run` for the same case, without the settings that begin with one of these texts.
std::vector<std::string> words_of(const RunOfCase& run, const std::vector<std::string>& left_out = {}) {
  std::vector<std::string> words{run.program, "run", run.file};
  for (const std::string& setting : run.settings)
    if (std::none_of(left_out.begin(), left_out.end(),
                     [&](const std::string& beginning) { return setting.rfind(beginning, 0) == 0; }))
      words.insert(words.end(), {"--set", setting});
  return words;
}

std::string line_of(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return shell_line(words);
}

/// Cells of half the edge, where both models can be solved on them soon and mean the same: forces on nodes
/// would be other loads, and given springs are of the cells that they were given for.
std::optional<std::array<int, 3>> finer_cells(const Comparison& comparison) {
  constexpr std::size_t most_cells = 40000;
  const cases::Case& definition = comparison.scene.definition;
  const auto* box = std::get_if<cases::Box>(&definition.body);
  const bool has_nodal_forces = std::any_of(definition.loads.begin(), definition.loads.end(),
                                            cases::is<cases::loads::NodalForce, cases::Load>);
  const bool is_given = cases::facts_of(definition.msm.design).source == cases::DesignSource::file;
  if (!box || has_nodal_forces || is_given || 8 * comparison.scene.mesh.cells.size() > most_cells)
    return std::nullopt;
  std::array<int, 3> cells = box->cells;
  for (int& n : cells) n *= 2;
  return cells;
}

/// What tells whether the mesh is fine enough.
std::optional<NextCommand> about_mesh(const RunOfCase& run, const Comparison& comparison) {
  if (!comparison.mesh_study && !run.has_meshes)
    return NextCommand{line_of(words_of(run), {"--converge"}), "this mesh's own error"};
  if (const auto cells = finer_cells(comparison))
    return NextCommand{line_of(words_of(run, {"body.cells="}),
                               {"--set", fmt::format("body.cells=[{}]", fmt::join(*cells, ","))}),
                       "a finer mesh"};
  return std::nullopt;
}

/// The [msm] table of a design as with_design() makes it.
std::string msm_setting(const std::string& design, const cases::Msm& own) {
  std::string table = fmt::format("msm={{design=\"{}\"", design);
  if (own.mass != cases::Msm{}.mass) table += fmt::format(", mass=\"{}\"", cases::name_of(own.mass));
  std::vector<std::string> accepted;
  for (const cases::Doubt doubt : own.accepted) accepted.push_back('"' + cases::name_of(doubt) + '"');
  if (!accepted.empty()) table += fmt::format(", accept=[{}]", fmt::join(accepted, ", "));
  return table + "}";
}

} // namespace

std::string typed_command() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(in), {}}; // words that each end with a zero
  std::vector<std::string> words;
  for (std::size_t begin = 0, end = 0; (end = all.find('\0', begin)) != std::string::npos; begin = end + 1)
    words.push_back(all.substr(begin, end - begin));
  return shell_line(words);
}

std::vector<NextCommand> next_commands(const RunOfCase& run, const Comparison& comparison) {
  const Answers& answers = comparison.answers;
  const auto is_skipped = [](const Answer& side) { return side.solution.status == cases::Status::skipped; };
  if (is_skipped(answers.fem) || is_skipped(answers.msm)) return {{shell_line(words_of(run)), "both models"}};
  std::vector<NextCommand> next;
  if (answers.fem.converged() && answers.msm_source.empty() && !comparison.measures.empty())
    next.push_back({line_of(words_of(run), {"--designs", "all"}),
                    answers.msm.converged() ? "other designs" : "designs that may hold here"});
  if (answers.fem.converged() && answers.msm.converged())
    if (auto mesh = about_mesh(run, comparison)) next.push_back(std::move(*mesh));
  if (!answers.fem.converged())
    next.push_back({line_of(words_of(run), {"--only", "msm"}), "the springs by themselves"});
  if (!run.has_folder && !answers.failed())
    next.push_back({line_of(words_of(run), {"--out", "out", "--report"}), "files and a page"});
  return next;
}

std::vector<NextCommand> next_commands(const RunOfCase& run, const cases::Msm& own, const Ranking& ranking) {
  std::vector<NextCommand> next;
  const Trial* best = ranking.recommended();
  if (best && best->name != cases::name_of(own.design))
    next.push_back({line_of(words_of(run, {"msm=", "msm."}), {"--set", msm_setting(best->name, own)}),
                    "this design by itself"});
  if (!run.has_folder)
    next.push_back({line_of(words_of(run), {"--designs", "all", "--out", "out"}),
                    "the springs of each design, in files"});
  return next;
}

} // namespace springproof::compare
