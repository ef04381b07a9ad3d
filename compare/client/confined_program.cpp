#include "compare/client/confined_program.hpp"

#include "cases/case/error.hpp"
#include "cases/mesh/confined.hpp"
#include "compare/provenance/print.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <poll.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace springproof::compare {

namespace {

constexpr std::size_t most_before_reading = 10'000; ///< bytes

double now() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

/// What went wrong before the program ran. The process writes one of them, with the system's number.
struct NotStarted {
  enum Step : int { namespaces, users, mounts, calls, start } step;
  int error;
};

bool write_text(const char* path, const std::string& text) {
  const int file = open(path, O_WRONLY | O_CLOEXEC);
  const bool is_written = file >= 0 && write(file, text.data(), text.size()) == ssize_t(text.size());
  if (file >= 0) close(file);
  return is_written;
}

/// Makes every file system read-only but the folder.
bool lock_files(const char* folder) {
  mount_attr locked{}, open_again{};
  locked.attr_set = MOUNT_ATTR_RDONLY | MOUNT_ATTR_NOSUID;
  open_again.attr_clr = MOUNT_ATTR_RDONLY;
  return mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         mount(folder, folder, nullptr, MS_BIND, nullptr) == 0 &&
         mount_setattr(AT_FDCWD, "/", AT_RECURSIVE, &locked, sizeof locked) == 0 &&
         mount_setattr(AT_FDCWD, folder, 0, &open_again, sizeof open_again) == 0;
}

/// Refuses sockets, other ways around this filter, and namespaces of its own. Made before the fork: it takes
/// memory.
scmp_filter_ctx refused_calls() {
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
  if (filter == nullptr) return nullptr;
  for (const int call :
       {SCMP_SYS(socket), SCMP_SYS(io_uring_setup), SCMP_SYS(ptrace), SCMP_SYS(mount), SCMP_SYS(umount2),
        SCMP_SYS(mount_setattr), SCMP_SYS(move_mount), SCMP_SYS(open_tree), SCMP_SYS(fsopen),
        SCMP_SYS(pivot_root), SCMP_SYS(unshare), SCMP_SYS(setns), SCMP_SYS(keyctl), SCMP_SYS(bpf),
        SCMP_SYS(process_vm_readv), SCMP_SYS(process_vm_writev), SCMP_SYS(userfaultfd)})
    seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), call, 0);
  return filter;
}

/// What the processes before the program's own need; made before the fork, since other threads may have held
/// what the library locks.
struct Start {
  std::vector<char*> arguments;
  std::string folder, users, groups;
  const ProgramLimits& limits;
  scmp_filter_ctx filter;
  int input, output, errors, reason;
};

[[noreturn]] void stop(const Start& start, NotStarted::Step step) {
  const NotStarted why{step, errno};
  [[maybe_unused]] const auto written = write(start.reason, &why, sizeof why);
  _exit(1);
}

[[noreturn]] void become_program(const Start& start) {
  dup2(start.input, STDIN_FILENO);
  dup2(start.output, STDOUT_FILENO);
  dup2(start.errors, STDERR_FILENO);
  cases::lower_limit(RLIMIT_DATA, start.limits.memory);
  cases::lower_limit(RLIMIT_FSIZE, start.limits.file_size);
  cases::lower_limit(RLIMIT_CORE, 0);
  cases::lower_limit(RLIMIT_NPROC, 256);
  for (int signal = 1; signal < 32; ++signal) std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || seccomp_load(start.filter) != 0)
    stop(start, NotStarted::calls);
  execvp(start.arguments[0], start.arguments.data());
  stop(start, NotStarted::start);
}

/// The first process of the namespaces: with it all others end. Waits for the program, and ends as it did.
[[noreturn]] void guard_program(const Start& start) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setsid();
  // Nobody's number within: a program that is started has no rights over mounts.
  if (!write_text("/proc/self/setgroups", "deny") || !write_text("/proc/self/uid_map", start.users) ||
      !write_text("/proc/self/gid_map", start.groups))
    stop(start, NotStarted::users);
  if (!lock_files(start.folder.c_str()) || chdir(start.folder.c_str()) != 0) stop(start, NotStarted::mounts);
  const pid_t program = _Fork(); // takes no locks, which other threads may have held
  if (program < 0) stop(start, NotStarted::start);
  if (program == 0) become_program(start);
  for (const int end : {start.input, start.output, start.errors, start.reason}) close(end);
  int status = 0;
  for (pid_t ended; (ended = wait(&status)) != program;)
    if (ended < 0 && errno != EINTR) _exit(1);
  _exit(WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status));
}

std::string why_not_started(const std::string& name, const NotStarted& why) {
  const std::string error = std::strerror(why.error);
  if (why.step == NotStarted::start) return fmt::format("{} cannot be started: {}", name, error);
  return fmt::format("this system cannot confine a program ({}: {}); clients run only where the kernel lets "
                     "users make namespaces",
                     std::array{"namespaces", "users", "mounts", "system calls"}[why.step], error);
}

} // namespace

struct ConfinedProgram::Wait {
  double until, seconds;
  const std::string& stage;
  Wait(double within, const std::string& for_what)
      : until(now() + within), seconds(within), stage(for_what) {}
};

ConfinedProgram::ConfinedProgram(std::vector<std::string> words, const ProgramLimits& limits)
    : limits_(limits), name_(words.front()), end_(now() + limits.seconds) {
  int input[2], output[2], reason[2];
  if (pipe2(input, O_CLOEXEC) != 0 || pipe2(output, O_CLOEXEC) != 0 || pipe2(reason, O_CLOEXEC) != 0)
    throw cases::SolveError(name_ + ": no pipe: " + std::strerror(errno));
  const int errors =
      open((folder_.path() / "stderr").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  const Start start{pointers_to(words),
                    folder_.path().string(),
                    fmt::format("1000 {} 1", geteuid()),
                    fmt::format("1000 {} 1", getegid()),
                    limits_,
                    refused_calls(),
                    input[0],
                    output[1],
                    errors,
                    reason[1]};
  process_ = static_cast<int>(
      syscall(SYS_clone, CLONE_NEWUSER | CLONE_NEWNS | CLONE_NEWPID | CLONE_NEWNET | CLONE_NEWIPC | SIGCHLD,
              nullptr, nullptr, nullptr, nullptr));
  if (process_ == 0) guard_program(start);
  const int clone_error = errno;
  seccomp_release(start.filter);
  for (const int end : {input[0], output[1], errors, reason[1]}) close(end);
  in_ = input[1];
  out_ = output[0];
  NotStarted why{NotStarted::namespaces, clone_error};
  const bool has_failed = process_ < 0 || read(reason[0], &why, sizeof why) == sizeof why;
  close(reason[0]);
  if (has_failed) {
    close(in_);
    close(out_);
    if (process_ > 0) waitpid(process_, nullptr, 0);
    throw cases::SolveError(why_not_started(name_, why));
  }
  for (const int end : {in_, out_}) fcntl(end, F_SETFL, O_NONBLOCK);
}

ConfinedProgram::~ConfinedProgram() {
  close(in_);
  close(out_);
  if (process_ <= 0) return;
  kill(process_, SIGKILL);
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::string ConfinedProgram::last_words() const {
  std::ifstream in(folder_.path() / "stderr", std::ios::binary);
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::streamoff>(in.tellg());
  constexpr std::streamoff most = 400;
  in.seekg(std::max<std::streamoff>(0, size - most));
  std::string text(static_cast<std::size_t>(std::min(most, std::max<std::streamoff>(0, size))), ' ');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text = one_line(text);
  return text.empty() ? "" : "; it said: " + text;
}

void ConfinedProgram::fail(const std::string& stage, const std::string& what) {
  throw cases::SolveError(fmt::format("{}, {}: {}{}", name_, stage, what, last_words()));
}

void ConfinedProgram::fail_ended(const std::string& stage) {
  int status = 0;
  const double until = now() + 1; // it has closed its output, and may be about to end
  while (waitpid(process_, &status, WNOHANG) == 0) {
    if (now() > until) fail(stage, "has closed its output");
    usleep(1000);
  }
  process_ = 0;
  const int code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  fail(stage, code > 128 ? fmt::format("crashed ({})", strsignal(code - 128))
                         : fmt::format("ended early, with status {}", code));
}

void ConfinedProgram::fill(const Wait& wait, std::size_t most) {
  const double until = std::min(wait.until, end_), left = until - now();
  if (left <= 0)
    fail(wait.stage,
         fmt::format("took longer than {:g} s", until < wait.until ? limits_.seconds : wait.seconds));
  pollfd ready{out_, POLLIN, 0};
  if (poll(&ready, 1, static_cast<int>(std::min(left, 1e5) * 1000) + 1) <= 0) return;
  std::string piece(std::min<std::size_t>(most, 1 << 20), '\0');
  const ssize_t n = read(out_, piece.data(), piece.size());
  if (n == 0) fail_ended(wait.stage);
  if (n > 0) said_.append(piece, 0, static_cast<std::size_t>(n));
}

void ConfinedProgram::write(const std::string& bytes, double seconds, const std::string& stage) {
  const Wait wait(seconds, stage);
  std::signal(SIGPIPE, SIG_IGN); // a client that has ended is a failed row
  for (std::size_t at = 0; at < bytes.size();) {
    const double left = std::min(wait.until, end_) - now();
    if (left <= 0) fail(stage, fmt::format("took longer than {:g} s", seconds));
    pollfd ready[2]{{in_, POLLOUT, 0}, {out_, POLLIN, 0}};
    if (poll(ready, 2, static_cast<int>(std::min(left, 1e5) * 1000) + 1) <= 0) continue;
    if ((ready[1].revents & POLLIN) != 0) {
      fill(wait, most_before_reading);
      if (said_.size() >= most_before_reading || said_.find('\n') != std::string::npos)
        fail(stage, "speaks before it has read the scene: \"" +
                        one_line(said_.substr(0, std::min<std::size_t>(80, said_.find('\n')))) + "\"");
    }
    if ((ready[0].revents & (POLLOUT | POLLERR)) == 0) continue;
    const ssize_t n = ::write(in_, bytes.data() + at, bytes.size() - at);
    if (n < 0 && errno == EPIPE) fail_ended(stage);
    if (n > 0) at += static_cast<std::size_t>(n);
  }
}

std::string ConfinedProgram::read_line(std::size_t most_bytes, double seconds, const std::string& stage) {
  const Wait wait(seconds, stage);
  std::size_t end = 0;
  for (std::size_t looked = 0; (end = said_.find('\n', looked)) == std::string::npos;) {
    looked = said_.size();
    if (looked > most_bytes)
      fail(stage, fmt::format("wrote a line of more than {} bytes: \"{}...\"", most_bytes,
                              one_line(said_.substr(0, 60))));
    fill(wait, most_bytes + 1);
  }
  std::string line = said_.substr(0, end);
  said_.erase(0, end + 1);
  return line;
}

std::string ConfinedProgram::read_bytes(std::size_t n, double seconds, const std::string& stage) {
  const Wait wait(seconds, stage);
  while (said_.size() < n) fill(wait, n - said_.size());
  std::string bytes = said_.substr(0, n);
  said_.erase(0, n);
  return bytes;
}

std::vector<std::string> words_of_command(const std::string& command) {
  std::vector<std::string> words;
  bool is_in_word = false;
  char quote = '\0';
  for (const char c : command) {
    if (quote != '\0' ? c == quote : c == '\'' || c == '"') {
      quote = quote != '\0' ? '\0' : c;
      if (!is_in_word) words.emplace_back();
      is_in_word = true;
    } else if (quote == '\0' && (c == ' ' || c == '\t' || c == '\n')) {
      is_in_word = false;
    } else {
      if (!is_in_word) words.emplace_back();
      is_in_word = true;
      words.back() += c;
    }
  }
  if (quote != '\0')
    throw cases::InputError(fmt::format("--client: {} is not closed in: {}", quote, command));
  if (words.empty() || words.front().empty())
    throw cases::InputError("--client: no command; give NAME=COMMAND, such as mine='python3 mine.py'");
  return words;
}

} // namespace springproof::compare
