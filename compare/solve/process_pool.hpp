#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Jobs in worker processes. MPI and PETSc are not made for threads, and a process that crashes takes one job
/// with it and no more. A job and its answer are any bytes.
namespace springproof::compare {

struct JobAnswer {
  std::optional<std::string> bytes; ///< absent when the job failed
  std::string reason;               ///< why; empty when it did not
};

/// Hands out the jobs in their order, each to the first worker that is free, and waits for all. A worker that
/// ends without an answer fails the job it had, and another one takes its place. Workers that are left when
/// the caller is ended find their input closed.
/// @param worker     program and arguments of a worker, which calls serve_jobs()
/// @param n_workers  at least 1
/// @param bytes_of   a job's bytes, called when it is handed out
/// @param on_done    told the index of each job and its answer when it comes, in the order in which that
///                   happens
/// @return one answer per job, in the order of the jobs
/// @throws std::system_error if a worker cannot be started
std::vector<JobAnswer>
run_in_processes(const std::vector<std::string>& worker, int n_workers, std::size_t n_jobs,
                 const std::function<std::string(std::size_t job)>& bytes_of,
                 const std::function<void(std::size_t job, const JobAnswer&)>& on_done);

/// The worker's side: reads jobs from standard input until it ends, and answers each on standard output. What
/// the job itself prints goes to standard error. An exception is a failed job; its message is the reason.
void serve_jobs(const std::function<std::string(const std::string& job)>& work);

/// Whether mpirun or its like started this process: processes started from here would join its job.
bool is_under_mpi_launcher();

} // namespace springproof::compare
