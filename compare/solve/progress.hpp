#pragma once

#include <condition_variable>
#include <list>
#include <mutex>
#include <string>
#include <thread>

namespace springproof::compare {

/// Work, as far as its progress is concerned.
struct Workload {
  std::size_t n_pieces = 0;
  double seconds = 0; ///< estimate for one worker
};

/// Wall-clock seconds that are left to do; estimates are corrected by what the finished pieces took.
struct Remaining {
  Workload expected;        ///< in all
  Workload finished;        ///< as it was estimated
  double took = 0;          ///< seconds of a worker that the finished pieces took
  double of_running = 0;    ///< estimated seconds of what is being done
  double running_since = 0; ///< seconds spent on it, all pieces together
  int n_workers = 1;

  double correction() const; ///< factor of estimates, towards 1 while little is finished
  double seconds() const;    ///< >= 0
  double part_done() const;  ///< 0 to 1
};

/// "0:42", "12:05", "1:02:03"
std::string clock_text(double seconds);

/// When a piece of work that is not shown on a terminal is told of, seconds after its beginning: at once if
/// it is expected to take more than a minute, else after one; then whenever it has taken twice as long again.
double told_first(double estimated_seconds);
double told_next(double told);

/// One line on standard error about what a command is doing, how much is done, and about how long the rest
/// takes: on a terminal, by rank 0, while a piece of work is being done, and nothing that stays. Elsewhere,
/// in a pipe or a file, lines that stay, of pieces of more than a minute alone.
class ProgressLine {
 public:
  explicit ProgressLine(int n_workers);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;

  /// One more piece of work.
  void expect(double estimated_seconds);
  /// A piece of what is expected, done already.
  void skip(double estimated_seconds);

  /// @param name  shown name of the piece   @param note  a line that stays, in front of it; empty: none
  void begin(const std::string& name, double estimated_seconds, const std::string& note = "");
  /// Takes the line away if nothing else is being done, and others may print.
  void finish(const std::string& name);

 private:
  struct Piece {
    std::string name, note;
    double estimated_seconds, begun_at, tell_after;
  };
  double now() const;
  void draw_now_and_then();
  void draw();
  void tell_of_long_pieces();
  void clear();

  const bool is_here_;     ///< on rank 0
  const bool is_terminal_; ///< else a pipe or a file
  Remaining remaining_;
  std::list<Piece> running_;
  std::size_t n_drawn_ = 0; ///< characters of the line that stands there
  bool is_over_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread drawer_; ///< started with the first piece
};

} // namespace springproof::compare
