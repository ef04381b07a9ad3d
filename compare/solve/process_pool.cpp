#include "compare/solve/process_pool.hpp"

#include "compare/provenance/call_program.hpp"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <new>
#include <poll.h>
#include <spawn.h>
#include <sstream>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace springproof::compare {

namespace {

/// The environment that the program was started with, which is what a worker gets. MPI_Init() adds what would
/// make a worker take itself for this process, and may have done so before main(): the system keeps the first
/// state.
const std::vector<std::string>& initial_environment() {
  static const std::vector<std::string> variables = [] {
    std::ifstream kept("/proc/self/environ", std::ios::binary);
    std::vector<std::string> copies;
    for (std::string variable; std::getline(kept, variable, '\0');) copies.push_back(variable);
    return copies;
  }();
  return variables;
}

std::string describe_end(int status) {
  if (WIFSIGNALED(status))
    return fmt::format("its process was ended by signal {} ({})", WTERMSIG(status),
                       strsignal(WTERMSIG(status)));
  return fmt::format("its process ended with status {} and no answer", WEXITSTATUS(status));
}

/// What a process and its worker send each other: a line with the kind and the length, and the content.
struct Message {
  std::string kind, content;
};

std::string text_of(const Message& message) {
  return fmt::format("{} {}\n", message.kind, message.content.size()) + message.content;
}

/// Takes a message from the beginning of `bytes`; nothing as long as it is not complete.
/// @throws std::runtime_error if it is none
std::optional<Message> take_message(std::string& bytes) {
  constexpr std::size_t longest_line = 40;
  const std::size_t begin = bytes.find('\n') + 1;
  if (begin == 0 && bytes.size() < longest_line) return std::nullopt;
  std::istringstream line(bytes.substr(0, std::min(begin, longest_line)));
  Message message;
  std::size_t size = 0;
  if (!(line >> message.kind >> size)) throw std::runtime_error("is no message");
  if (bytes.size() - begin < size) return std::nullopt;
  message.content = bytes.substr(begin, size);
  bytes.erase(0, begin + size);
  return message;
}

/// Writes all bytes to a socket.  @return false if its other end is closed
bool send_all(int socket, const std::string& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t n = send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

/// One worker process; it ends with this object, at once if it is at work.
class Worker {
 public:
  explicit Worker(const std::vector<std::string>& command) {
    // A socket and not two pipes, so that writing to a worker that has died is an error and no signal.
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      throw std::system_error(errno, std::generic_category(), "no socket for a worker");
    socket_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::vector<std::string> words = command, variables = initial_environment();
    const int error = posix_spawnp(&process_, words.front().c_str(), &actions, nullptr,
                                   pointers_to(words).data(), pointers_to(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error == 0) return;
    close(socket_);
    throw std::system_error(error, std::generic_category(),
                            "the worker '" + command.front() + "' cannot be started");
  }
  ~Worker() {
    if (process_ > 0 && job_) kill(process_, SIGKILL);
    close(socket_);
    if (process_ > 0) waitpid(process_, nullptr, 0);
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  int socket() const { return socket_; }
  std::optional<std::size_t> job() const { return job_; }

  /// A worker that has died by now does not read the job: read() will say so.
  void give(std::size_t index, const std::string& job) {
    job_ = index;
    send_all(socket_, text_of({"job", job}));
  }

  /// Waits for the next bytes of the answer.
  /// @return the answer to its job, if it is complete; a worker that still has its job then is not to be used
  std::optional<JobAnswer> read() {
    char block[1 << 16];
    const ssize_t n = ::read(socket_, block, sizeof block);
    if (n < 0 && errno == EINTR) return std::nullopt;
    if (n <= 0) {
      int status = 0;
      waitpid(process_, &status, 0);
      process_ = 0;
      return JobAnswer{std::nullopt, describe_end(status)};
    }
    received_.append(block, static_cast<std::size_t>(n));
    try {
      const std::optional<Message> message = take_message(received_);
      if (!message) return std::nullopt;
      job_.reset();
      if (message->kind == "ok") return JobAnswer{message->content, ""};
      return JobAnswer{std::nullopt, message->content};
    } catch (const std::runtime_error& error) {
      return JobAnswer{std::nullopt, std::string("its answer ") + error.what()};
    }
  }

 private:
  pid_t process_ = 0;
  int socket_ = -1;
  std::string received_;
  std::optional<std::size_t> job_;
};

} // namespace

std::vector<JobAnswer>
run_in_processes(const std::vector<std::string>& worker, int n_workers, std::size_t n_jobs,
                 const std::function<std::string(std::size_t job)>& bytes_of,
                 const std::function<void(std::size_t job, const JobAnswer&)>& on_done) {
  std::vector<JobAnswer> answers(n_jobs);
  std::vector<std::unique_ptr<Worker>> workers;
  std::size_t next = 0;
  const auto employ = [&](std::unique_ptr<Worker>& place) {
    if (next == n_jobs) return place.reset();
    if (!place) place = std::make_unique<Worker>(worker);
    place->give(next, bytes_of(next));
    ++next;
  };
  workers.resize(std::min(n_jobs, static_cast<std::size_t>(n_workers)));
  for (auto& place : workers) employ(place);

  for (std::size_t n_answered = 0; n_answered < n_jobs;) {
    std::vector<pollfd> sockets; // poll() passes over a negative one
    for (const auto& place : workers) sockets.push_back({place ? place->socket() : -1, POLLIN, 0});
    if (poll(sockets.data(), sockets.size(), -1) < 0 && errno != EINTR)
      throw std::system_error(errno, std::generic_category(), "waiting for the workers");
    for (std::size_t w = 0; w < workers.size(); ++w) {
      if (!workers[w] || sockets[w].revents == 0) continue;
      const std::size_t job = *workers[w]->job();
      std::optional<JobAnswer> answer = workers[w]->read();
      if (!answer) continue;
      answers[job] = std::move(*answer);
      ++n_answered;
      on_done(job, answers[job]);
      if (workers[w]->job()) workers[w].reset();
      employ(workers[w]);
    }
  }
  return answers;
}

bool is_under_mpi_launcher() {
  for (const std::string& variable : initial_environment())
    for (const char* mark : {"OMPI_COMM_WORLD_SIZE=", "PMI_SIZE=", "PMI_RANK=", "PMIX_RANK="})
      if (variable.rfind(mark, 0) == 0) return true;
  return false;
}

void serve_jobs(const std::function<std::string(const std::string& job)>& work) {
  // Libraries that print must not print into an answer.
  const int answers = dup(STDOUT_FILENO);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  std::string received;
  char block[1 << 16];
  for (ssize_t n; (n = read(STDIN_FILENO, block, sizeof block)) > 0 || (n < 0 && errno == EINTR);) {
    received.append(block, static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    const std::optional<Message> job = take_message(received);
    if (!job) continue;
    Message answer{"ok", ""};
    try {
      answer.content = work(job->content);
    } catch (const std::bad_alloc&) {
      answer = {"failed", "not enough memory"};
    } catch (const std::exception& error) {
      answer = {"failed", error.what()};
    }
    if (!send_all(answers, text_of(answer))) return;
  }
}

} // namespace springproof::compare
