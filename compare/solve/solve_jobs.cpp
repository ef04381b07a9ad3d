#include "compare/solve/solve_jobs.hpp"

#include "cases/case/read_case.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/process_pool.hpp"

#include <algorithm>
#include <mpi.h>
#include <thread>
#include <tuple>

namespace springproof::compare {

namespace {

/// When there are none: the sides that should have been solved have failed.
Answers failed_answers(const Request& request, const std::exception& error) {
  Answers answers;
  if (request.asks(cases::Side::fem)) answers.fem.solution = failed_solution(error);
  if (request.asks(cases::Side::msm)) answers.msm.solution = failed_solution(error);
  return answers;
}

Answers solve_in_this_process(const Question& question, SolveFem solve_fem) {
  try {
    return solve(question.scene, question.request, solve_fem);
  } catch (const std::exception& error) {
    return failed_answers(question.request, error);
  }
}

Answers answers_from(const JobAnswer& job, const Request& request) {
  if (!job.bytes) return failed_answers(request, std::runtime_error(job.reason));
  Answers answers;
  cases::from_bytes(*job.bytes, answers);
  return answers;
}

/// Questions of jobs whose case can be read, and what the others have failed by.
struct ReadJobs {
  std::vector<Question> questions;
  std::vector<std::size_t> job; ///< of each question
  std::vector<std::pair<std::size_t, Answers>> failed;
};

ReadJobs read_jobs(const std::vector<SolveJob>& jobs) {
  ReadJobs read;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    Request request;
    request.only = jobs[j].only;
    try {
      read.questions.push_back(
          {cases::make_scene(cases::read_case(jobs[j].case_file, jobs[j].settings)), request});
      read.job.push_back(j);
    } catch (const cases::InputError& error) {
      read.failed.emplace_back(j, failed_answers(request, error));
    }
  }
  return read;
}

} // namespace

int cores() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

std::vector<Question> read_questions(const std::vector<std::string>& case_files,
                                     const std::vector<std::string>& settings, const Request& request) {
  std::vector<Question> questions;
  for (const std::string& file : case_files)
    questions.push_back({cases::make_scene(cases::read_case(file, settings)), request});
  return questions;
}

std::string answer_job(const std::string& bytes, SolveFem solve_fem) {
  Question question;
  cases::from_bytes(bytes, question);
  return cases::to_bytes(solve_in_this_process(question, solve_fem));
}

std::vector<Answers>
answer_all(const std::vector<Question>& questions, const FinishedCases& finished, SolveFem solve_fem,
           const SolveOptions& options,
           const std::function<void(std::size_t question, const Answers&)>& on_answered) {
  std::vector<Answers> answers(questions.size());
  std::vector<std::size_t> open;
  for (std::size_t q = 0; q < questions.size(); ++q)
    if (auto earlier = finished.find(questions[q]))
      answers[q] = std::move(*earlier);
    else
      open.push_back(q);
  std::stable_sort(open.begin(), open.end(), [&](std::size_t a, std::size_t b) {
    return estimated_cost(questions[a]) > estimated_cost(questions[b]);
  });
  const auto take = [&](std::size_t q, Answers fresh) {
    if (mpi_rank() == 0) finished.keep(questions[q], fresh);
    answers[q] = std::move(fresh);
    on_answered(q, answers[q]);
  };
  int n_ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  if (n_ranks > 1 || is_under_mpi_launcher()) {
    for (const std::size_t q : open) take(q, solve_in_this_process(questions[q], solve_fem));
    return answers;
  }
  const ProcessPool pool{{options.program, "worker"}, options.n_workers > 0 ? options.n_workers : cores()};
  run_in_processes(
      pool, open.size(), [&](std::size_t job) { return cases::to_bytes(questions[open[job]]); },
      [&](std::size_t job, const JobAnswer& answer) {
        take(open[job], answers_from(answer, questions[open[job]].request));
      });
  return answers;
}

bool SolveJob::operator<(const SolveJob& other) const {
  return std::tie(case_file, settings, only) < std::tie(other.case_file, other.settings, other.only);
}

std::vector<Question> questions_of(const std::vector<SolveJob>& jobs) {
  return read_jobs(jobs).questions;
}

std::vector<Solved> solve_jobs(const std::vector<SolveJob>& jobs, const AnswerQuestions& answer) {
  std::vector<Solved> solved(jobs.size());
  ReadJobs read = read_jobs(jobs);
  for (auto& [job, failed] : read.failed) solved[job].answers = std::move(failed);
  std::vector<Answers> answers = answer(read.questions);
  for (std::size_t q = 0; q < answers.size(); ++q)
    solved[read.job[q]] = {std::move(read.questions[q].scene), std::move(answers[q])};
  return solved;
}

} // namespace springproof::compare
