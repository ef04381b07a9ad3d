#include "compare/solve/progress.hpp"

#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace springproof::compare {

namespace {

constexpr std::chrono::milliseconds interval(300); ///< between two drawings; what is shorter shows none
constexpr int bar_width = 20;
constexpr double long_seconds = 60; ///< work that takes more is told of without a terminal
constexpr double prior_seconds = 2; ///< finished work that corrects estimates half way

std::size_t columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1u : 79u;
}

/// Cut to the terminal's width, not within a character of UTF-8.
std::string within_columns(const std::string& text) {
  std::size_t size = std::min(text.size(), columns());
  while (size > 0 && size < text.size() && (static_cast<unsigned char>(text[size]) & 0xC0) == 0x80) --size;
  return text.substr(0, size);
}

/// Shows a text in one call, so that nothing comes between; what cannot be shown is not.
void show(const std::string& text) {
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
}

} // namespace

double Remaining::correction() const {
  return (took + prior_seconds) / (finished.seconds + prior_seconds);
}

double Remaining::seconds() const {
  const double waiting = std::max(0., expected.seconds - finished.seconds - of_running);
  const double running = std::max(0., correction() * of_running - running_since);
  return (correction() * waiting + running) / n_workers;
}

double Remaining::part_done() const {
  const double left = seconds() * n_workers, done = took + running_since;
  return done + left > 0 ? done / (done + left) : 0;
}

std::string clock_text(double seconds) {
  const long s = std::lround(seconds), minutes = s / 60;
  if (minutes < 60) return fmt::format("{}:{:02}", minutes, s % 60);
  return fmt::format("{}:{:02}:{:02}", minutes / 60, minutes % 60, s % 60);
}

double told_first(double estimated_seconds) {
  return estimated_seconds > long_seconds ? 0 : long_seconds;
}

double told_next(double told) {
  return std::max(long_seconds, 2 * told);
}

ProgressLine::ProgressLine(int n_workers)
    : is_here_(mpi_rank() == 0), is_terminal_(isatty(STDERR_FILENO) == 1) {
  remaining_.n_workers = n_workers;
}

ProgressLine::~ProgressLine() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    clear();
  }
  wake_.notify_all();
  if (drawer_.joinable()) drawer_.join();
}

void ProgressLine::expect(double estimated_seconds) {
  const std::lock_guard lock(mutex_);
  ++remaining_.expected.n_pieces;
  remaining_.expected.seconds += estimated_seconds;
}

void ProgressLine::skip(double estimated_seconds) {
  const std::lock_guard lock(mutex_);
  --remaining_.expected.n_pieces;
  remaining_.expected.seconds -= estimated_seconds;
}

void ProgressLine::begin(const std::string& name, double estimated_seconds, const std::string& note) {
  if (!is_here_) return;
  const std::lock_guard lock(mutex_);
  running_.push_back({name, note, estimated_seconds, now(), told_first(estimated_seconds)});
  if (is_terminal_ && !note.empty()) {
    clear();
    show(within_columns(one_line(note)) + '\n');
  }
  if (!drawer_.joinable()) drawer_ = std::thread([this] { draw_now_and_then(); });
}

void ProgressLine::finish(const std::string& name) {
  if (!is_here_) return;
  const std::lock_guard lock(mutex_);
  const auto piece = std::find_if(running_.begin(), running_.end(),
                                  [&](const Piece& running) { return running.name == name; });
  if (piece == running_.end()) return;
  ++remaining_.finished.n_pieces;
  remaining_.finished.seconds += piece->estimated_seconds;
  remaining_.took += now() - piece->begun_at;
  running_.erase(piece);
  if (running_.empty()) clear();
}

double ProgressLine::now() const {
  const std::chrono::duration<double> time = std::chrono::steady_clock::now().time_since_epoch();
  return time.count();
}

void ProgressLine::draw_now_and_then() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, interval, [this] { return is_over_; })) {
    if (running_.empty()) continue;
    if (is_terminal_)
      draw();
    else
      tell_of_long_pieces();
  }
}

void ProgressLine::tell_of_long_pieces() {
  for (Piece& piece : running_) {
    const double ran = now() - piece.begun_at;
    if (ran < piece.tell_after) continue;
    const std::string what =
        piece.tell_after > 0  ? fmt::format("{}: {} so far", piece.name, clock_text(ran))
        : !piece.note.empty() ? piece.note
                              : fmt::format("{}: about {}", piece.name, clock_text(piece.estimated_seconds));
    show(one_line(what) + '\n');
    piece.tell_after = told_next(piece.tell_after);
  }
}

void ProgressLine::draw() {
  remaining_.of_running = remaining_.running_since = 0;
  for (const Piece& piece : running_) {
    remaining_.of_running += piece.estimated_seconds;
    remaining_.running_since += now() - piece.begun_at;
  }
  const double left = remaining_.seconds();
  const auto done = static_cast<std::size_t>(bar_width * remaining_.part_done());
  const std::string line = within_columns(
      fmt::format("[{:<{}}] {} of {}, {} left, {}", std::string(done, '#'), bar_width,
                  remaining_.finished.n_pieces, remaining_.expected.n_pieces,
                  left < 1 ? "not long" : "about " + clock_text(left), one_line(running_.back().name)));
  show('\r' + line + std::string(n_drawn_ > line.size() ? n_drawn_ - line.size() : 0, ' '));
  n_drawn_ = std::max(n_drawn_, line.size());
}

void ProgressLine::clear() {
  if (n_drawn_ > 0) show('\r' + std::string(n_drawn_, ' ') + '\r');
  n_drawn_ = 0;
}

} // namespace springproof::compare
