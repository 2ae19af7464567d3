#include "trammel/panel/server.hpp"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <stdexcept>

namespace trammel::panel {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr auto kStateEvery = std::chrono::milliseconds(50);
constexpr auto kRequestTime = std::chrono::seconds(10);
// A page that sends nothing and answers no ping for this time is considered disconnected.
constexpr auto kPageSilence = std::chrono::seconds(3);
constexpr std::size_t kLongestMessage = std::size_t{1} << 18U;
constexpr std::uint32_t kLongestHeader = 8192;
constexpr unsigned kMostExchanges = 32;

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

}  // namespace

bool has_token(std::string_view target, std::string_view token) {
  const std::size_t question = target.find('?');
  if (question == std::string_view::npos || token.empty()) return false;
  std::string_view query = target.substr(question + 1);
  while (!query.empty()) {
    const std::string_view part = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(part.size() + 1, query.size()));
    if (part.substr(0, 6) != "token=") continue;
    const std::string_view given = part.substr(6);
    unsigned difference = given.size() == token.size() ? 0 : 1;
    for (std::size_t n = 0; n < given.size(); ++n) {
      difference |= static_cast<unsigned>(given[n] ^ token[n % token.size()]);
    }
    return difference == 0;
  }
  return false;
}

// State shared by the handlers, which end with its context at the latest.
class PanelServer::Shared {
 public:
  Shared(const ServerSettings& given, PanelSession& its_session)
      : settings(given), session(its_session), acceptor(context) {}

  void listen();
  void accept();
  void take(std::shared_ptr<PageLink> link);
  void forget(const PageLink* link);
  void send_state();

  ServerSettings settings;
  PanelSession& session;
  unsigned exchanges = 0;
  asio::io_context context{1};
  tcp::acceptor acceptor;
  std::shared_ptr<PageLink> page;
  Clock::time_point stated{};
};

// The connection to the page.
class PanelServer::PageLink : public std::enable_shared_from_this<PageLink> {
 public:
  PageLink(tcp::socket socket, Shared& shared) : stream_(std::move(socket)), shared_(shared) {}

  void accept(const http::request<http::string_body>& request) {
    websocket::stream_base::timeout times{};
    times.handshake_timeout = kRequestTime;
    times.idle_timeout = kPageSilence;
    times.keep_alive_pings = true;
    stream_.set_option(times);
    stream_.read_message_max(kLongestMessage);
    stream_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->shared_.take(self);
      self->read();
    });
  }
  void send(std::string text) {
    if (ended_) return;
    waiting_.push_back(std::move(text));
    if (waiting_.size() == 1) write();
  }
  bool sends() const { return !waiting_.empty(); }
  // Closes the connection because another page has connected.
  void replace() {
    ended_ = true;
    stream_.async_close({websocket::close_code::policy_error, "replaced"}, [self = shared_from_this()](error_code) {});
  }

  std::uint64_t told = 0;  // number of the last note sent to the page

 private:
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->shared_.forget(self.get());
      const std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      if (!self->ended_) self->shared_.session.receive(text);
      self->read();
    });
  }
  void write() {
    stream_.text(true);
    stream_.async_write(asio::buffer(waiting_.front()), [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->shared_.forget(self.get());
      self->waiting_.pop_front();
      if (self->sends() && !self->ended_) self->write();
    });
  }

  websocket::stream<beast::tcp_stream> stream_;
  Shared& shared_;
  beast::flat_buffer buffer_;
  std::deque<std::string> waiting_;
  bool ended_ = false;
};

// One HTTP request and its answer.
class PanelServer::Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  Exchange(tcp::socket socket, Shared& shared) : stream_(std::move(socket)), shared_(shared) {
    ++shared_.exchanges;
    parser_.header_limit(kLongestHeader);
    parser_.body_limit(0);
  }
  ~Exchange() { --shared_.exchanges; }
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  void begin() {
    stream_.expires_after(kRequestTime);
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) self->answer();
    });
  }

 private:
  void answer() {
    const http::request<http::string_body>& request = parser_.get();
    const std::string_view target{request.target().data(), request.target().size()};
    const std::string_view path = path_of(target);
    if (!has_token(target, shared_.settings.token)) {
      return send(http::status::forbidden, "text/plain",
                  "403: this address needs the token, as trammel panel has printed it.\n");
    }
    if (websocket::is_upgrade(request)) {
      if (path != "/socket") return send(http::status::not_found, "text/plain", "404\n");
      stream_.expires_never();
      std::make_shared<PageLink>(stream_.release_socket(), shared_)->accept(request);
      return;
    }
    if (request.method() != http::verb::get) return send(http::status::method_not_allowed, "text/plain", "405\n");
    if (path == "/") return send(http::status::ok, "text/html", std::string(shared_.settings.page));
    if (path == "/program") return send(http::status::ok, "text/plain", shared_.session.program().text());
    send(http::status::not_found, "text/plain", "404\n");
  }
  void send(http::status status, const char* type, std::string body) {
    response_.result(status);
    response_.set(http::field::content_type, fmt::format("{}; charset=utf-8", type));
    response_.set(http::field::cache_control, "no-store");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("X-Frame-Options", "DENY");
    response_.keep_alive(false);
    response_.body() = std::move(body);
    response_.prepare_payload();
    http::async_write(stream_, response_, [self = shared_from_this()](error_code, std::size_t) {
      error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  beast::tcp_stream stream_;
  Shared& shared_;
  beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  http::response<http::string_body> response_;
};

void PanelServer::Shared::listen() {
  error_code error;
  tcp::resolver resolver(context);
  const std::string& host = settings.host;
  const bool bracketed = host.size() > 2 && host.front() == '[';
  const auto found = resolver.resolve(bracketed ? host.substr(1, host.size() - 2) : host, std::to_string(settings.port),
                                      tcp::resolver::passive, error);
  if (!error && found.empty()) error = asio::error::host_not_found;
  if (!error) {
    const tcp::endpoint endpoint = found.begin()->endpoint();
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  }
  if (error) throw std::runtime_error(fmt::format("cannot listen on {}:{}: {}", host, settings.port, error.message()));
}

void PanelServer::Shared::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error && exchanges < kMostExchanges) {
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      std::make_shared<Exchange>(std::move(socket), *this)->begin();
    }
    accept();
  });
}

void PanelServer::Shared::take(std::shared_ptr<PageLink> link) {
  if (page) page->replace();
  page = std::move(link);
  session.arrived();
  page->send(session.hello());
}

void PanelServer::Shared::forget(const PageLink* link) {
  if (page.get() != link) return;
  page.reset();
  session.left();
}

void PanelServer::Shared::send_state() {
  const auto now = Clock::now();
  if (!page || page->sends() || now - stated < kStateEvery) return;
  stated = now;
  page->send(session.state(page->told));
}

PanelServer::PanelServer(const ServerSettings& settings, PanelSession& session)
    : shared_(std::make_unique<Shared>(settings, session)) {
  shared_->listen();
  shared_->accept();
}

PanelServer::~PanelServer() = default;

void PanelServer::turn() {
  shared_->context.restart();
  shared_->context.poll();
  shared_->send_state();
}

std::string PanelServer::url() const {
  return fmt::format("http://{}:{}/?token={}", shared_->settings.host, shared_->acceptor.local_endpoint().port(),
                     shared_->settings.token);
}

bool PanelServer::has_page() const { return shared_->page != nullptr; }

}  // namespace trammel::panel
