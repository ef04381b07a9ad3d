#include "cases/mesh/confined.hpp"

#include "cases/case/names.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <new>
#include <poll.h>
#include <seccomp.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace springproof::cases {

namespace {

/// First byte of what the child writes.
constexpr char answered = 'A', threw = 'T';

/// System calls that neither change anything outside the process nor start another one (sanitizers probe
/// memory with pipe2). Opening for reading is allowed besides.
constexpr const char* allowed_calls =
    "access brk clock_getres clock_gettime close dup exit exit_group faccessat faccessat2 fcntl fstat "
    "futex getcwd getdents64 geteuid getpid getrandom getrusage gettid gettimeofday getuid lseek lstat "
    "madvise mmap mprotect mremap munmap newfstatat pipe2 pread64 read readlink readlinkat readv "
    "restart_syscall rt_sigaction rt_sigprocmask rt_sigreturn sched_getaffinity sched_yield sigaltstack "
    "stat statx sysinfo tgkill times uname write writev";

/// From here on this process can compute, read and write to what is open; every other call fails with EPERM.
/// @return whether the kernel agreed
bool confine() {
  const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (filter == nullptr) return false;
  bool is_complete = true;
  for (const std::string& name : words_of(allowed_calls)) {
    const int call = seccomp_syscall_resolve_name(name.c_str());
    is_complete =
        is_complete && call != __NR_SCMP_ERROR && seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0) == 0;
  }
  const auto reads_only = [&](int call, unsigned flags) { // O_RDONLY is 0: no bit that writes or creates
    const scmp_arg_cmp condition =
        SCMP_CMP(flags, SCMP_CMP_MASKED_EQ, O_ACCMODE | O_CREAT | O_TRUNC, O_RDONLY);
    return seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, call, 1, &condition) == 0;
  };
  is_complete = is_complete && reads_only(SCMP_SYS(openat), 2) && reads_only(SCMP_SYS(open), 1) &&
                seccomp_load(filter) == 0;
  seccomp_release(filter);
  return is_complete;
}

/// Bytes that this process has mapped; a sanitizer maps more than there are.
rlim_t address_space() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

/// Runs the work in the child, and ends it. Nothing that is the parent's is cleaned up here.
[[noreturn]] void work_confined(const std::function<std::string()>& work, const Limits& limits, int out) {
  prctl(PR_SET_PDEATHSIG, SIGKILL); // it would go on, and keep its parent's folder of results claimed
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int standard : {0, 1, 2}) dup2(nowhere, standard);
  for (const int signal : {SIGINT, SIGTERM, SIGSEGV, SIGABRT, SIGFPE, SIGBUS}) std::signal(signal, SIG_DFL);
  lower_limit(RLIMIT_CPU, static_cast<rlim_t>(limits.seconds));
  lower_limit(RLIMIT_AS, address_space() + limits.bytes);
  lower_limit(RLIMIT_CORE, 0);
  std::string answer(1, threw);
  if (!confine())
    answer += "this system cannot confine a process (seccomp)";
  else
    try {
      answer = answered + work();
    } catch (const std::bad_alloc&) {
      answer += "needs more than " + std::to_string(limits.bytes / 1'000'000) + " MB of memory";
    } catch (const std::exception& error) {
      answer += error.what();
    }
  for (std::size_t at = 0; at < answer.size();) {
    const ssize_t n = write(out, answer.data() + at, answer.size() - at);
    if (n <= 0 && errno != EINTR) _exit(1);
    at += n > 0 ? static_cast<std::size_t>(n) : 0;
  }
  _exit(0);
}

/// Reads all that comes through a pipe until it is closed.  @return whether that happened in time
bool read_all(int in, int seconds, std::string& bytes) {
  using std::chrono::steady_clock;
  const auto end = steady_clock::now() + std::chrono::seconds(seconds);
  std::string piece(1 << 16, '\0');
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - steady_clock::now());
    pollfd ready{in, POLLIN, 0};
    const int n_ready = left.count() > 0 ? poll(&ready, 1, static_cast<int>(left.count())) : 0;
    if (n_ready == 0) return false;
    if (n_ready < 0) continue; // a signal
    const ssize_t n = read(in, piece.data(), piece.size());
    if (n == 0) return true;
    if (n > 0) bytes.append(piece, 0, static_cast<std::size_t>(n));
  }
}

} // namespace

Limits limits_to_read(std::uint64_t file_size) {
  return {600, 1'000'000'000 + 100 * file_size};
}

void lower_limit(int resource, std::uint64_t most) {
  const auto which = static_cast<__rlimit_resource>(resource);
  rlimit limit{};
  getrlimit(which, &limit);
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_cur, most);
  limit.rlim_max = std::min<rlim_t>(limit.rlim_max, most);
  setrlimit(which, &limit);
}

std::string run_confined(const std::function<std::string()>& work, const Limits& limits) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error(std::strerror(errno));
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(std::strerror(errno));
  if (child == 0) work_confined(work, limits, ends[1]);
  close(ends[1]);
  std::string bytes;
  const bool in_time = read_all(ends[0], limits.seconds, bytes);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!in_time || (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)))
    throw std::runtime_error("took longer than " + std::to_string(limits.seconds) + " s, or was killed");
  if (WIFSIGNALED(status)) throw std::runtime_error(std::string("crashed: ") + strsignal(WTERMSIG(status)));
  if (bytes.empty()) throw std::runtime_error("ended without an answer");
  if (bytes.front() == threw) throw std::runtime_error(bytes.substr(1));
  return bytes.substr(1);
}

} // namespace springproof::cases
