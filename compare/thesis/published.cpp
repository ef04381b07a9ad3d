#include "compare/thesis/regenerate.hpp"

#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/write/quote.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

std::string path_of(const std::string& name) {
  return cases_folder() + "/published/" + name + ".csv";
}

std::vector<PublishedFigure> read_published_figures() {
  std::vector<PublishedFigure> figures;
  for (const CsvRow& row : read_csv(path_of("figures")))
    figures.push_back({row[0], row[1], row.number(2), row[3], row.number(4), row[5], row[6], row[7], row[8],
                       row.number(9)});
  return figures;
}

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

double CsvRow::number(std::size_t field) const {
  const std::string& text = fields.at(field);
  if (const auto value = cases::number_in<double>(text)) return *value;
  throw cases::InputError(path + ": '" + text + "' is not a number");
}

std::vector<CsvRow> read_csv(const std::string& path) {
  std::vector<CsvRow> rows;
  std::size_t width = 0; // fields of the heading
  cases::read_rows(
      read_file(path), path, cases::Between::commas,
      [&](const cases::TextRow& heading) { width = heading.fields.size(); },
      [&](const cases::TextRow& row) {
        if (row.fields.size() != width)
          throw cases::InputError(
              fmt::format("{}{} fields where the header has {}", row.place(), row.fields.size(), width));
        rows.push_back({path, {row.fields.begin(), row.fields.end()}});
      });
  return rows;
}

const std::vector<PublishedFigure>& published_figures() {
  static const std::vector<PublishedFigure> all = read_published_figures();
  return all;
}

std::vector<std::string> tables_of(const std::vector<PublishedFigure>& figures) {
  std::vector<std::string> tables;
  for (const PublishedFigure& figure : figures)
    if (std::find(tables.begin(), tables.end(), figure.table) == tables.end()) tables.push_back(figure.table);
  return tables;
}

double published_cell_volume_change(const std::string& load_set) {
  const std::string path = path_of("cell_volumes");
  for (const CsvRow& row : read_csv(path))
    if (row[1] == load_set) return row.number(2);
  throw cases::InputError(path + ": has no load set '" + load_set + "'");
}

std::optional<std::array<double, 3>>
published_stiffness(const std::string& design, const std::string& material, double design_poissons_ratio) {
  // The cube's linear elastic material has E = 0.3 MPa; chapter 6 prints sets for others.
  const std::string wanted = material == "linear_elastic" ? "linear_elastic E=0.3 MPa" : material;
  for (const CsvRow& row : read_csv(path_of("stiffness")))
    if (row[1] == design && row[2] == wanted && row.number(3) == design_poissons_ratio && row.number(4) == 1)
      return std::array<double, 3>{row.number(5), row.number(6), row.number(7)};
  return std::nullopt;
}

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

Comparison join(const Solutions& solutions, const JobPair& jobs) {
  const Comparison& msm = solutions.at(jobs.msm);
  return compare_sides(msm.scene, solutions.at(jobs.fem).answers, msm.answers);
}

std::optional<double> MeasuredPair::error() const {
  return fem && msm ? error_percent(*fem, *msm, 0) : std::nullopt;
}

MeasuredPair measured_pair(const Solutions& solutions, const JobPair& jobs, const std::string& measure) {
  const Comparison &fem = solutions.at(jobs.fem), &msm = solutions.at(jobs.msm);
  const MeasuredValue *of_fem = find_named(fem.measures, measure),
                      *of_msm = find_named(msm.measures, measure);
  const std::string reason = why_without_errors(fem.answers, msm.answers);
  if (!fem.answers.fem.converged()) return {{}, {}, reason};
  if (!of_fem) return {{}, {}, "the case has no measure " + measure};
  return {of_fem->fem, of_msm && reason.empty() ? of_msm->msm : std::nullopt, reason};
}

std::string shell_command(const std::vector<std::string>& words) {
  return "build/springproof " + shell_line(words);
}

} // namespace springproof::compare
