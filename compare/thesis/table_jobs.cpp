#include "compare/thesis/table_jobs.hpp"

#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/write/shell.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

std::string path_of_case(const PublishedFigure& figure) {
  return cases_folder() + "/" + case_file_of(figure);
}

std::vector<std::string> material_settings(const PublishedFigure& figure) {
  if (figure.material == "ogden") return {};
  return {fmt::format("material.poissons_ratio={}", figure.poissons_ratio)};
}

SolveJob fem_job(const PublishedFigure& figure, const FemChoice& reference) {
  SolveJob job{path_of_case(figure), material_settings(figure), cases::Side::fem};
  job.settings.insert(job.settings.end(), reference.settings.begin(), reference.settings.end());
  return job;
}

SolveJob designed_springs(const PublishedFigure& figure, const std::string& design) {
  SolveJob job{path_of_case(figure), material_settings(figure), cases::Side::msm};
  // The Ogden cases give their springs: the whole block goes, or the stiffnesses would contradict the design.
  job.settings.push_back(figure.material == "ogden" ? fmt::format("msm={{design=\"{}\"}}", design)
                                                    : "msm.design=" + design);
  return job;
}

SolveJob thesis_springs(const PublishedFigure& figure) {
  if (figure.load_set.empty()) return {path_of_case(figure), {}, cases::Side::msm};
  if (const auto k = published_stiffness(figure.design, figure.material, figure.design_poissons_ratio))
    return {path_of_case(figure),
            {"msm.design=given", fmt::format("msm.stiffness=[{}]", fmt::join(*k, ","))},
            cases::Side::msm};
  SolveJob job = designed_springs(figure, figure.design);
  if (figure.design_poissons_ratio != figure.poissons_ratio)
    job.settings.push_back(fmt::format("msm.poissons_ratio={}", figure.design_poissons_ratio));
  return job;
}

} // namespace

std::vector<FemChoice> references_of(const PublishedFigure& figure) {
  const cases::Fem declared = cases::read_case(path_of_case(figure)).fem;
  std::vector<FemChoice> references{
      {cases::name_of(declared.formulation) + " " + cases::name_of(declared.element), {}}};
  for (const std::string other : {"log_strain", "small_strain"})
    if (figure.material != "ogden" && other != cases::name_of(declared.formulation))
      references.push_back({other + " q1_bbar", {"fem.formulation=" + other, "fem.element=q1_bbar"}});
  return references;
}

std::string case_file_of(const PublishedFigure& figure) {
  if (figure.load_set.empty()) return fmt::format("thesis/{}/{}.toml", figure.material, figure.test);
  return fmt::format("thesis/{}/cube_{}_{}.toml", figure.material, figure.test, figure.load_set);
}

JobPair thesis_jobs(const PublishedFigure& figure, const FemChoice& reference) {
  return {fem_job(figure, reference), thesis_springs(figure)};
}

JobPair thesis_jobs(const PublishedFigure& figure) {
  return thesis_jobs(figure, references_of(figure).front());
}

JobPair designed_jobs(const PublishedFigure& figure, const std::string& design) {
  return {fem_job(figure, references_of(figure).front()), designed_springs(figure, design)};
}

Trace trace_of(const JobPair& jobs) {
  Trace trace{jobs.fem.case_file.substr(cases_folder().size() + 1), jobs.fem.settings};
  for (const std::string& setting : jobs.msm.settings)
    if (std::find(trace.settings.begin(), trace.settings.end(), setting) == trace.settings.end())
      trace.settings.push_back(setting);
  std::vector<std::string> words{"run", "cases/" + trace.case_file};
  for (const std::string& setting : trace.settings) words.insert(words.end(), {"--set", setting});
  trace.command = shell_command(words);
  return trace;
}

std::string shell_command(const std::vector<std::string>& words) {
  return "build/springproof " + shell_line(words);
}

} // namespace springproof::compare
