#include "compare/interact/server.hpp"

#include "cases/case/error.hpp"

#include <algorithm>
#include <array>
#include <boost/algorithm/string/replace.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <csignal>
#include <deque>
#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <stdexcept>

namespace springproof::compare {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr int most_connections = 32;
constexpr int most_messages = 300; ///< a second
constexpr auto time_to_ask = std::chrono::seconds(10);
constexpr auto time_to_come_back = std::chrono::seconds(3);
constexpr auto time_to_accept_again = std::chrono::milliseconds(100);

/// 128 random bits, hexadecimal.
std::string random_text() {
  std::array<unsigned char, 16> bytes;
  if (RAND_bytes(bytes.data(), bytes.size()) != 1) throw std::runtime_error("there is no randomness");
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

} // namespace

class PageSocket;

struct ServerState {
  ServerState(ServedPage served, int port)
      : page(std::move(served)), acceptor(io), signals(io, SIGINT, SIGTERM), leaving(io), again(io) {
    try {
      acceptor = {io, {asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)}};
    } catch (const boost::system::system_error& error) {
      throw cases::InputError("--port " + std::to_string(port) + ": " + error.code().message());
    }
    const unsigned short bound = acceptor.local_endpoint().port();
    struct sigaction on_hangup {};
    if (sigaction(SIGHUP, nullptr, &on_hangup) == 0 && on_hangup.sa_handler != SIG_IGN) // nohup ignores it
      signals.add(SIGHUP);
    host =
        "127.0.0.1" + (bound == 80 ? "" : ":" + std::to_string(bound)); // browsers leave http's own port out
    token = random_text();
  }

  ServedPage page;
  int n_connections = 0;
  std::vector<beast::tcp_stream*> without_token; ///< connections that have shown none yet, the oldest first
  ServerCounts counts;
  asio::io_context io{1}; ///< whose end is that of what it still waits for, which counts itself off
  tcp::acceptor acceptor;
  asio::signal_set signals;
  asio::steady_timer leaving, again;
  std::string host, token;
  std::shared_ptr<PageSocket> controller;

  void accept();
  void leave(const PageSocket* who);
  bool has_place();
};

/// The page in control.
class PageSocket : public std::enable_shared_from_this<PageSocket> {
 public:
  PageSocket(ServerState& server, beast::tcp_stream&& stream) : server_(server), ws_(std::move(stream)) {
    ++server_.n_connections;
  }
  ~PageSocket() { --server_.n_connections; }

  void accept(const http::request<http::empty_body>& request) {
    ws_.read_message_max(server_.page.longest_text);
    ws_.auto_fragment(false); // a picture is one frame: it is in memory as a whole
    auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.idle_timeout = std::chrono::seconds(20);
    timeout.keep_alive_pings = true;
    ws_.set_option(timeout);
    beast::get_lowest_layer(ws_).expires_never();
    ws_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return self->leave();
      self->is_accepted_ = true;
      self->server_.page.on_control();
      self->write({true, false, std::make_shared<const std::string>(self->server_.page.first_text)});
      self->write({false, false, std::make_shared<const std::string>(self->server_.page.first_bytes)});
      self->read();
    });
  }

  void send_frame(std::shared_ptr<const std::string> frame) {
    if (!is_accepted_) return; // it was asked for by the page before
    if (!outgoing_.empty() && outgoing_.back().is_frame) {
      ++server_.counts.n_frames_dropped;
      outgoing_.pop_back();
    }
    write({false, true, std::move(frame)});
  }

  void close(websocket::close_code code) {
    if (std::exchange(is_closing_, true)) return;
    leave(); // at once: a page that does not answer is waited for half a minute
    if (ws_.is_open()) ws_.async_close(code, [self = shared_from_this()](error_code) {});
  }

 private:
  struct Outgoing {
    bool is_text, is_frame;
    std::shared_ptr<const std::string> content;
  };

  ServerState& server_;
  websocket::stream<beast::tcp_stream> ws_;
  beast::flat_buffer buffer_;
  std::deque<Outgoing> outgoing_; ///< with at most one frame, the last
  Outgoing written_{};
  bool is_accepted_ = false, is_writing_ = false, is_closing_ = false;
  std::chrono::steady_clock::time_point second_ = std::chrono::steady_clock::now();
  int n_in_second_ = 0;

  void leave() { server_.leave(this); }

  void write(Outgoing message) {
    outgoing_.push_back(std::move(message));
    write_next();
  }

  void write_next() {
    if (is_writing_ || is_closing_ || outgoing_.empty()) return;
    written_ = std::move(outgoing_.front());
    outgoing_.pop_front();
    if (written_.is_frame) ++server_.counts.n_frames_sent;
    is_writing_ = true;
    ws_.text(written_.is_text);
    ws_.async_write(asio::buffer(*written_.content),
                    [self = shared_from_this()](error_code error, std::size_t) {
                      self->is_writing_ = false;
                      if (error) return self->leave();
                      self->write_next();
                    });
  }

  bool is_too_fast() {
    const auto now = std::chrono::steady_clock::now();
    if (now - second_ > std::chrono::seconds(1)) {
      second_ = now;
      n_in_second_ = 0;
    }
    return ++n_in_second_ > most_messages;
  }

  void read() {
    ws_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) {
        if (error == websocket::error::message_too_big || error == websocket::error::buffer_overflow)
          ++self->server_.counts.n_cut_off;
        return self->leave();
      }
      const std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      if (self->is_closing_) return;
      if (self->is_too_fast() || !self->ws_.got_text() || !self->server_.page.on_text(text)) {
        ++self->server_.counts.n_cut_off;
        return self->close(websocket::close_code::policy_error);
      }
      self->read();
    });
  }
};

namespace {

/// One request, answered or refused; the connection is closed after it.
class HttpRequest : public std::enable_shared_from_this<HttpRequest> {
 public:
  HttpRequest(ServerState& server, tcp::socket&& socket) : server_(server), stream_(std::move(socket)) {
    ++server_.n_connections;
    server_.without_token.push_back(&stream_);
    parser_.header_limit(8192);
    parser_.body_limit(std::uint64_t{0});
  }
  ~HttpRequest() {
    --server_.n_connections;
    keep_place();
  }

  void read() {
    stream_.expires_after(time_to_ask);
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error)
        self->answer();
      else if (error != http::error::end_of_stream)
        ++self->server_.counts.n_refused;
    });
  }

 private:
  ServerState& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{16384};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;

  /// No newer connection takes it any more.
  void keep_place() {
    auto& all = server_.without_token;
    all.erase(std::remove(all.begin(), all.end(), &stream_), all.end());
  }

  void answer() {
    const auto& request = parser_.get();
    const std::string own_origin = "http://" + server_.host;
    const auto origin = request.find(http::field::origin);
    const bool has_origin = origin != request.end(), is_own = has_origin && origin->value() == own_origin;
    const std::string target(request.target());
    const bool is_socket = websocket::is_upgrade(request);
    if (request.count(http::field::host) != 1 || request[http::field::host] != server_.host)
      return refuse(http::status::misdirected_request, "this is another host");
    if (request.count(http::field::origin) > 1 || (has_origin && !is_own) || (is_socket && !is_own))
      return refuse(http::status::forbidden, "this page is of another origin");
    if (request.method() != http::verb::get) return refuse(http::status::method_not_allowed, "GET alone");
    const std::string path = target.substr(0, target.find('?'));
    if (path != (is_socket ? "/socket" : "/"))
      return refuse(http::status::not_found, "there is no such page");
    if (!has_token(target)) return refuse(http::status::forbidden, "the token is wrong");
    keep_place();
    if (!is_socket) return send_page();
    if (server_.controller) return refuse(http::status::conflict, "another page is in control");
    server_.controller = std::make_shared<PageSocket>(server_, std::move(stream_));
    ++server_.counts.n_pages;
    server_.leaving.cancel();
    server_.controller->accept(request);
  }

  bool has_token(const std::string& target) const {
    const std::string before = "?token=";
    const std::size_t at = target.find(before);
    if (at == std::string::npos) return false;
    const std::string token = target.substr(at + before.size());
    return token.size() == server_.token.size() &&
           CRYPTO_memcmp(token.data(), server_.token.data(), token.size()) == 0;
  }

  void send_page() {
    const std::string nonce = random_text();
    const std::string socket = "ws://" + server_.host + "/socket?token=" + server_.token;
    response_.body() = server_.page.html;
    boost::replace_all(response_.body(), "{{nonce}}", nonce);
    boost::replace_all(response_.body(), "{{socket}}", socket);
    response_.set(http::field::content_type, "text/html; charset=utf-8");
    response_.set("Content-Security-Policy",
                  "default-src 'none'; script-src 'nonce-" + nonce + "'; style-src 'nonce-" + nonce +
                      "'; connect-src ws://" + server_.host +
                      "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
    send(http::status::ok);
  }

  void refuse(http::status status, const std::string& reason) {
    ++server_.counts.n_refused;
    response_.body() = reason + "\n";
    response_.set(http::field::content_type, "text/plain; charset=utf-8");
    send(status);
  }

  void send(http::status status) {
    response_.result(status);
    response_.version(11);
    response_.keep_alive(false);
    response_.set(http::field::cache_control, "no-store");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set(http::field::x_frame_options, "DENY");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.prepare_payload();
    stream_.expires_after(time_to_ask);
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }
};

} // namespace

void ServerState::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) { // no descriptor is left: asked again at once, it would fail again at once
      again.expires_after(time_to_accept_again);
      return again.async_wait([this](error_code stopped) {
        if (!stopped) accept();
      });
    }
    if (has_place()) std::make_shared<HttpRequest>(*this, std::move(socket))->read();
    accept();
  });
}

/// Whoever has shown no token gives way, the oldest first: connections that say nothing keep nobody out.
bool ServerState::has_place() {
  if (n_connections < most_connections) return true;
  if (without_token.empty()) return false;
  without_token.front()->close(); // what it waits for ends with an error, and the connection with that
  without_token.erase(without_token.begin());
  return true;
}

void ServerState::leave(const PageSocket* who) {
  if (controller.get() != who) return;
  controller.reset();
  page.on_leave();
  if (!page.ends_with_page) return;
  leaving.expires_after(time_to_come_back);
  leaving.async_wait([this](error_code error) {
    if (!error && !controller) io.stop();
  });
}

PageServer::PageServer(ServedPage page, int port)
    : state_(std::make_unique<ServerState>(std::move(page), port)) {}

PageServer::~PageServer() = default;

std::string PageServer::address() const {
  return "http://" + state_->host + "/?token=" + state_->token;
}

void PageServer::send_frame(std::shared_ptr<const std::string> frame) {
  asio::post(state_->io, [state = state_.get(), frame = std::move(frame)]() mutable {
    if (state->controller) state->controller->send_frame(std::move(frame));
  });
}

void PageServer::run(double seconds) {
  asio::steady_timer end(state_->io);
  if (seconds > 0) {
    end.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(seconds)));
    end.async_wait([state = state_.get()](error_code) { state->io.stop(); });
  }
  state_->signals.async_wait([state = state_.get()](error_code error, int) {
    if (!error) state->io.stop();
  });
  state_->accept();
  state_->io.run();
}

ServerCounts PageServer::counts() const {
  return state_->counts;
}

} // namespace springproof::compare
