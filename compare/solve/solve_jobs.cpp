#include "compare/solve/solve_jobs.hpp"

#include "cases/case/read_case.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/process_pool.hpp"
#include "compare/solve/ranks.hpp"

#include <algorithm>
#include <new>
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

Answers solve_in_this_process(const Question& question, const std::string& folder, SolveFem solve_fem) {
  try {
    return solve(question.scene, question.request, solve_fem, FinishedCases::meshes_in(folder, question));
  } catch (const std::exception& error) {
    if (n_mpi_ranks() > 1 && dynamic_cast<const std::bad_alloc*>(&error))
      throw; // the others wait for this rank
    return failed_answers(question.request, error);
  }
}

Answers answers_in(const JobAnswer& job, const Request& request) {
  if (!job.bytes) return failed_answers(request, std::runtime_error(job.reason));
  Answers answers;
  cases::from_bytes(*job.bytes, answers);
  return answers;
}

/// A question that no earlier command has answered.
struct Open {
  std::size_t question;
  std::vector<Estimate> models;
};

/// Questions of jobs whose case can be read, and what the others have failed by.
struct ReadJobs {
  std::vector<Question> questions;
  std::vector<std::size_t> job; ///< job of each question
  std::vector<std::pair<std::size_t, Answers>> failed;
};

ReadJobs read_jobs(const std::vector<SolveJob>& jobs) {
  ReadJobs read;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    Request request;
    request.only = jobs[j].only;
    try {
      const cases::Case definition = cases::read_case(jobs[j].case_file, jobs[j].settings);
      if (request.asks(cases::Side::fem)) cases::check_finite_elements(definition);
      read.questions.push_back({make_scene_within_memory(definition), request});
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
  const MemoryLimit memory = memory_limit();
  for (const std::string& file : case_files) {
    const cases::Case definition = cases::read_case(file, settings);
    if (const auto body = size_of(definition)) check_memory(file, estimate(*body, request), memory);
    if (request.asks(cases::Side::fem)) cases::check_finite_elements(definition);
    if (!request.peer.empty())
      cases::refuse_network(definition, "--peer", "leave it out, or solve the finite elements' own body");
    if (n_mpi_ranks() > 1) {
      cases::refuse_network(definition, "several ranks", "start the command without mpirun");
      cases::refuse_tools(definition, "several ranks", "start the command without mpirun");
    }
    questions.push_back({make_scene_within_memory(definition), request});
  }
  if (n_mpi_ranks() > 1) {
    std::string bytes;
    for (const Question& question : questions) bytes += cases::to_bytes(question.scene.definition);
    check_same_on_ranks(bytes);
  }
  return questions;
}

std::string answer_job(const std::string& bytes, SolveFem solve_fem) {
  Question question;
  std::string folder;
  cases::from_bytes(bytes, question, folder);
  return cases::to_bytes(solve_in_this_process(question, folder, solve_fem));
}

std::vector<Answers> answer_all(const std::vector<Question>& questions, const FinishedCases& finished,
                                SolveFem solve_fem, const SolveOptions& options) {
  std::vector<Answers> answers(questions.size());
  std::vector<Open> open;
  for (std::size_t q = 0; q < questions.size(); ++q)
    if (auto earlier = finished.find(questions[q])) {
      answers[q] = std::move(*earlier);
      if (options.line) options.line->skip(total_seconds(estimate(questions[q])));
    } else {
      open.push_back({q, estimate(questions[q])});
    }
  const MemoryLimit memory = memory_limit();
  std::vector<double> megabytes;
  for (const auto& [q, models] : open) {
    check_memory(questions[q].scene.definition.file, models, memory);
    megabytes.push_back(most_megabytes(models));
  }
  std::stable_sort(open.begin(), open.end(), [](const Open& a, const Open& b) {
    return total_seconds(a.models) > total_seconds(b.models);
  });
  const bool is_alone = n_mpi_ranks() == 1 && !is_under_mpi_launcher(); // worker processes may be started
  const int n_workers =
      is_alone ? workers_within(memory, megabytes, options.n_workers > 0 ? options.n_workers : cores()) : 1;
  ProgressLine own(std::min(n_workers, static_cast<int>(open.size())));
  if (!options.line)
    for (const Open& next : open) own.expect(total_seconds(next.models));
  ProgressLine& line = options.line ? *options.line : own;
  const auto begin = [&](const Open& next) -> const Question& {
    const std::string& name = questions[next.question].scene.definition.name;
    line.begin(name, total_seconds(next.models), long_solve_text(name, next.models));
    return questions[next.question];
  };
  const auto take = [&](const Open& next, Answers fresh) {
    const Question& question = questions[next.question];
    line.finish(question.scene.definition.name);
    finished.keep(question, fresh);
    answers[next.question] = std::move(fresh);
  };
  if (!is_alone) {
    for (const Open& next : open)
      take(next, solve_in_this_process(begin(next), finished.folder(), solve_fem));
    return answers;
  }
  run_in_processes(
      {options.program, "worker"}, n_workers, open.size(),
      [&](std::size_t job) { return cases::to_bytes(begin(open[job]), finished.folder()); },
      [&](std::size_t job, const JobAnswer& answer) {
        take(open[job], answers_in(answer, questions[open[job].question].request));
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
