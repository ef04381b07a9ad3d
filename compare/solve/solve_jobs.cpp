#include "compare/solve/solve_jobs.hpp"

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
  std::string line = job.side == Only::both ? "both" : job.side == Only::fem ? "fem" : "msm";
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
  std::string side;
  SolveJob job;
  std::getline(stream, side, separator);
  job.side = side == "fem" ? Only::fem : side == "msm" ? Only::msm : Only::both;
  if (!std::getline(stream, job.case_file, separator)) throw std::runtime_error("'" + line + "' is no job");
  for (std::string setting; std::getline(stream, setting, separator);) job.settings.push_back(setting);
  return job;
}

/// A guess of the time a job takes, to start long ones first; nothing else depends on it. Unknowns times the
/// steps and the cost of an element, as measured on the thesis's cases.
double dearness(const cases::Scene& scene, Only side) {
  const double n_nodes = static_cast<double>(scene.mesh.nodes.size());
  const cases::Fem& fem = scene.definition.fem;
  double cost = 0;
  if (side != Only::msm)
    cost +=
        n_nodes * std::pow(8, fem.refine) * (fem.formulation == cases::Formulation::small_strain ? 2 : 10);
  if (side != Only::fem) cost += n_nodes;
  return cost;
}

/// A job that gave no answer: the sides that it should have solved have failed.
void fail(Comparison& comparison, Only side, const std::string& reason) {
  const auto fail_side = [&](Side& failed) {
    failed = {};
    failed.solution.status = cases::Status::failed;
    failed.solution.message = reason;
  };
  if (side != Only::msm) fail_side(comparison.fem);
  if (side != Only::fem) fail_side(comparison.msm);
}

/// Makes every job's scene, and fails the jobs that make none.
/// @return the indices of the others, dearest first
std::vector<std::size_t> prepare(const std::vector<SolveJob>& jobs, std::vector<Comparison>& solved) {
  std::vector<std::size_t> order;
  std::vector<double> cost(jobs.size());
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    try {
      solved[j].scene = cases::make_scene(cases::read_case(jobs[j].case_file, jobs[j].settings));
    } catch (const cases::InputError& error) {
      fail(solved[j], jobs[j].side, error.what());
      continue;
    }
    cost[j] = dearness(solved[j].scene, jobs[j].side);
    order.push_back(j);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cost[a] > cost[b]; });
  return order;
}

void solve_in_this_process(const SolveJob& job, Comparison& comparison) {
  const cases::Scene scene = comparison.scene;
  try {
    comparison = compare_case(scene.definition, job.side);
  } catch (const std::exception& error) {
    comparison.scene = scene;
    fail(comparison, job.side, error.what());
  }
}

} // namespace

bool SolveJob::operator<(const SolveJob& other) const {
  return std::tie(case_file, settings, side) < std::tie(other.case_file, other.settings, other.side);
}

int cores() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

std::string answer_job(const std::string& line) {
  const SolveJob job = from_line(line);
  return to_bytes(compare_case(cases::read_case(job.case_file, job.settings), job.side));
}

std::vector<Comparison> solve_jobs(const std::vector<SolveJob>& jobs, const SolveOptions& options,
                                   const std::function<void(int done, int all)>& progress) {
  std::vector<Comparison> solved(jobs.size());
  const std::vector<std::size_t> order = prepare(jobs, solved);
  int n_done = 0, n_ranks = 1;
  const auto count = [&](std::size_t j) {
    if (options.on_solved) options.on_solved(j, solved[j]);
    progress(++n_done, static_cast<int>(order.size()));
  };
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  if (n_ranks > 1 || is_under_mpi_launcher()) {
    for (const std::size_t j : order) {
      solve_in_this_process(jobs[j], solved[j]);
      count(j);
    }
    return solved;
  }
  std::vector<std::string> lines;
  for (const std::size_t j : order) lines.push_back(to_line(jobs[j]));
  const ProcessPool pool{{options.program, "worker"}, options.n_workers > 0 ? options.n_workers : cores()};
  run_in_processes(pool, lines, [&](std::size_t k, const JobAnswer& answer) {
    Comparison& comparison = solved[order[k]];
    if (answer.bytes)
      from_bytes(*answer.bytes, comparison);
    else
      fail(comparison, jobs[order[k]].side, answer.reason);
    measure_sides(comparison);
    count(order[k]);
  });
  return solved;
}

} // namespace springproof::compare
