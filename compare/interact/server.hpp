#pragma once

#include <functional>
#include <memory>
#include <string>

namespace springproof::compare {

/// What a server shows, and whom it tells.
struct ServedPage {
  std::string html; ///< with "{{socket}}", "{{nonce}}" where the address and the nonce belong
  std::string first_text, first_bytes; ///< what every page gets when it takes control
  std::function<void()> on_control;    ///< a page has taken control
  std::function<void()> on_leave;      ///< and has left
  /// A text that is a message, or is none: then the page is cut off.
  std::function<bool(const std::string& text)> on_text;
  std::size_t longest_text = 0; ///< bytes; a longer one is none
  bool ends_with_page = true;   ///< when the page has left and none has come for three seconds
};

struct ServerCounts {
  long n_pages = 0, n_refused = 0, n_cut_off = 0, n_frames_sent = 0, n_frames_dropped = 0;
};

struct ServerState;

/// A server of one page on 127.0.0.1, for this machine's user alone. A request is answered when its Host is
/// the address that was printed, its Origin (if it has one; a socket's must) is the page's own, and it has
/// the token; all else is refused in one line. Of 32 connections the oldest that has shown no token gives way
/// to a new one. One page at a time is in control. Messages are short and at most 300 a second; a page that
/// sends another is cut off. A frame that arrives while one is on its way replaces the one that waits.
class PageServer {
 public:
  /// @param port  0: any that is free   @throws cases::InputError when it cannot be had
  PageServer(ServedPage page, int port);
  ~PageServer();

  std::string address() const; ///< with the token: "http://127.0.0.1:PORT/?token=..."
  /// May be called from any thread; returns at once.
  void send_frame(std::shared_ptr<const std::string> frame);
  /// Serves until SIGINT, SIGTERM, a SIGHUP that is not ignored (nohup), the page's end, or so many seconds.
  /// @param seconds  0: no limit
  void run(double seconds = 0);
  ServerCounts counts() const;

 private:
  std::unique_ptr<ServerState> state_;
};

} // namespace springproof::compare
