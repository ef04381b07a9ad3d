#include "compare/solve/solve_jobs.hpp"

#include "cases/case/hard_case.hpp"
#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/solve/process_pool.hpp"
#include "compare/solve/side_bytes.hpp"

#include <algorithm>
#include <cmath>
#include <mpi.h>
#include <sstream>
#include <thread>
#include <tuple>

namespace springproof::compare {

namespace {

constexpr char separator = '\t';

void check_one_line(const std::string& text) {
  if (text.find_first_of("\t\n") != std::string::npos)
    throw cases::InputError("'" + text + "': a tab or line break here cannot be passed to a worker");
}

std::string to_line(const SolveJob& job) {
  std::string line = (job.only ? cases::name_of(*job.only) : "both") + separator + std::to_string(job.meshes);
  check_one_line(job.case_file);
  line += separator + job.case_file;
  for (const std::string& setting : job.settings) {
    check_one_line(setting);
    line += separator + setting;
  }
  return line;
}

SolveJob from_line(const std::string& line) {
  std::istringstream stream(line);
  std::string only, meshes;
  SolveJob job;
  std::getline(stream, only, separator);
  std::getline(stream, meshes, separator);
  job.only = cases::value_of<cases::Side>(only);
  if (!std::getline(stream, job.case_file, separator)) throw std::runtime_error("'" + line + "' is no job");
  job.meshes = std::stoi(meshes);
  for (std::string setting; std::getline(stream, setting, separator);) job.settings.push_back(setting);
  return job;
}

Request request_of(const SolveJob& job) {
  return {job.settings, job.only, job.meshes, ""};
}

/// A guess of the time a job takes, to start long ones first; nothing else depends on it. Unknowns times the
/// steps and the cost of an element, as measured on the thesis's cases.
double dearness(const cases::Scene& scene, const Request& request) {
  const double n_nodes = static_cast<double>(scene.mesh.nodes.size());
  const cases::Fem& fem = scene.definition.fem;
  double cost = 0;
  const int refine = std::max(fem.refine, request.meshes - 1);
  if (request.asks(cases::Side::fem))
    cost += n_nodes * std::pow(8, refine) * (fem.formulation == cases::Formulation::small_strain ? 2 : 10);
  if (request.asks(cases::Side::msm)) cost += n_nodes;
  return cost;
}

/// Of a job that gave no answers: the sides that it should have solved have failed.
Answers failed_answers(const Request& request, const std::string& reason) {
  Answers answers;
  for (auto& [side, answer] :
       {std::pair(cases::Side::fem, &answers.fem), std::pair(cases::Side::msm, &answers.msm)}) {
    if (!request.asks(side)) continue;
    answer->solution.status = cases::Status::failed;
    answer->solution.message = reason;
  }
  return answers;
}

/// Makes every job's scene, and fails the jobs that make none.
/// @return the indices of the others, dearest first
std::vector<std::size_t> prepare(const std::vector<SolveJob>& jobs, std::vector<Solved>& solved) {
  std::vector<std::size_t> order;
  std::vector<double> cost(jobs.size());
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    try {
      solved[j].scene = cases::make_scene(cases::read_case(jobs[j].case_file, jobs[j].settings));
    } catch (const cases::InputError& error) {
      solved[j].answers = failed_answers(request_of(jobs[j]), error.what());
      continue;
    }
    cost[j] = dearness(solved[j].scene, request_of(jobs[j]));
    order.push_back(j);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cost[a] > cost[b]; });
  return order;
}

Answers solve_in_this_process(const SolveJob& job, const cases::Scene& scene, SolveFem solve_fem) {
  try {
    return solve(scene, request_of(job), solve_fem);
  } catch (const std::exception& error) {
    return failed_answers(request_of(job), error.what());
  }
}

} // namespace

bool SolveJob::operator<(const SolveJob& other) const {
  return std::tie(case_file, settings, only, meshes) <
         std::tie(other.case_file, other.settings, other.only, other.meshes);
}

int cores() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

std::string answer_job(const std::string& line, SolveFem solve_fem) {
  const SolveJob job = from_line(line);
  const cases::Scene scene = cases::make_scene(cases::read_case(job.case_file, job.settings));
  return to_bytes(solve(scene, request_of(job), solve_fem));
}

std::vector<Solved> solve_jobs(const std::vector<SolveJob>& jobs, SolveFem solve_fem,
                               const SolveOptions& options,
                               const std::function<void(int done, int all)>& progress) {
  std::vector<Solved> solved(jobs.size());
  const std::vector<std::size_t> order = prepare(jobs, solved);
  int n_done = 0, n_ranks = 1;
  const auto count = [&](std::size_t j) {
    if (options.on_solved) options.on_solved(j, solved[j]);
    progress(++n_done, static_cast<int>(order.size()));
  };
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  if (n_ranks > 1 || is_under_mpi_launcher()) {
    for (const std::size_t j : order) {
      solved[j].answers = solve_in_this_process(jobs[j], solved[j].scene, solve_fem);
      count(j);
    }
    return solved;
  }
  std::vector<std::string> lines;
  for (const std::size_t j : order) lines.push_back(to_line(jobs[j]));
  const ProcessPool pool{{options.program, "worker"}, options.n_workers > 0 ? options.n_workers : cores()};
  run_in_processes(pool, lines, [&](std::size_t k, const JobAnswer& answer) {
    solved[order[k]].answers =
        answer.bytes ? from_bytes(*answer.bytes) : failed_answers(request_of(jobs[order[k]]), answer.reason);
    count(order[k]);
  });
  return solved;
}

} // namespace springproof::compare
