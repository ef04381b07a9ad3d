#include "compare/provenance/call_program.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace springproof::compare {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& what, int reason = errno) {
  throw std::system_error(reason, std::generic_category(), what);
}

/// This process's variables, but for those that are set anew.
std::vector<std::string> environment_with(const std::vector<std::string>& variables) {
  std::vector<std::string> all = variables;
  for (char** known = environ; *known != nullptr; ++known) {
    const std::string variable = *known, name = variable.substr(0, variable.find('=') + 1);
    bool is_set = false;
    for (const std::string& next : variables) is_set = is_set || next.rfind(name, 0) == 0;
    if (!is_set) all.push_back(variable);
  }
  return all;
}

struct Pipe {
  int in = -1, out = -1; ///< what is written to `out` is read from `in`
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail("no pipe");
    in = ends[0];
    out = ends[1];
  }
};

/// All that comes through a pipe until its other end is closed.
std::string read_to_end(int in) {
  std::string bytes, piece(1 << 16, '\0');
  for (ssize_t n; (n = read(in, piece.data(), piece.size())) > 0 || (n < 0 && errno == EINTR);)
    if (n > 0) bytes.append(piece, 0, static_cast<std::size_t>(n));
  close(in);
  return bytes;
}

int wait_for(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// The remover's life. The program that used the folder is killed at the same time, and may still write.
[[noreturn]] void remove_at_the_end(const fs::path& folder, int alive) {
  setsid(); // what ends this process's group does not end it
  dup2(alive, 0);
  close_range(1, ~0u, 0); // the locks and pipes of others among them
  char nothing;
  while (read(0, &nothing, 1) < 0 && errno == EINTR) {
  }
  for (int n = 0; n < 100; ++n) {
    std::error_code error;
    fs::remove_all(folder, error);
    if (!error) _exit(0);
    usleep(10'000);
  }
  _exit(1);
}

} // namespace

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

std::optional<ProgramEnd> call_program(const ProgramCall& call) {
  std::vector<std::string> words = call.words, variables = environment_with(call.variables);
  const std::vector<char*> arguments = pointers_to(words), environment = pointers_to(variables);
  const Pipe said, reason; // why it was not started; closed when it is
  const pid_t caller = getpid(), process = fork();
  if (process < 0) fail(words.front() + " cannot be started");
  if (process == 0) { // system calls alone: other threads may have held what the library locks
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != caller) _exit(1);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(said.out, STDOUT_FILENO);
    dup2(said.out, STDERR_FILENO);
    if (chdir(call.folder.c_str()) == 0) execvpe(arguments[0], arguments.data(), environment.data());
    const int error = errno;
    [[maybe_unused]] const auto written = write(reason.out, &error, sizeof error);
    _exit(1);
  }
  close(said.out);
  close(reason.out);
  ProgramEnd end{0, read_to_end(said.in)};
  const std::string not_started = read_to_end(reason.in);
  end.status = wait_for(process);
  if (not_started.empty()) return end;
  const int error = *reinterpret_cast<const int*>(not_started.data());
  if (error == ENOENT && fs::is_directory(call.folder)) return std::nullopt;
  fail(words.front() + " cannot be started in '" + call.folder + "'", error);
}

ScratchFolder::ScratchFolder(const std::string& purpose) {
  std::string name = (fs::temp_directory_path() / ("springproof-" + purpose + "-XXXXXX")).string();
  if (!mkdtemp(name.data())) fail("the folder '" + name + "' cannot be made");
  path_ = name;
  const Pipe life;
  remover_ = fork();
  if (remover_ < 0) {
    const int reason = errno;
    fs::remove(path_);
    close(life.in);
    close(life.out);
    fail("no process for the folder '" + name + "'", reason);
  }
  if (remover_ == 0) {
    close(life.out);
    remove_at_the_end(path_, life.in);
  }
  close(life.in);
  alive_ = life.out;
}

ScratchFolder::~ScratchFolder() {
  close(alive_);
  wait_for(remover_);
}

} // namespace springproof::compare
