#include "trammel/transport/connection.hpp"

#include <fmt/format.h>

#include <utility>

#include "trammel/driver/errors.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "trammel/transport/links.hpp"
#include "trammel/transport/memory_bus.hpp"

namespace trammel::transport {
namespace {

using namespace std::chrono_literals;
using Kind = CardUrl::Kind;

std::unique_ptr<StreamLink> stream_link(const CardUrl& url, const driver::FrameBus::Options& frames) {
  StreamLink::Options options;
  options.answer = frames.answer;
  options.sends = frames.sends;
  std::optional<StreamLink::Hello> hello;
  if (url.hello) hello = StreamLink::Hello{url.token};
  return std::make_unique<StreamLink>(
      [url]() -> std::unique_ptr<ByteStream> {
        if (url.kind == Kind::kSerial) return open_serial(url.device, url.baud);
        return connect_tcp(url.host, url.port, 5s);
      },
      std::move(hello), options);
}

// A stream between computers loses nothing, and the card at its end may be slow: answers get much time, and requests
// are rarely repeated.
driver::FrameBus::Options frame_options(const CardUrl& url, bool stream) {
  driver::FrameBus::Options options;
  if (stream) {
    options.answer = url.hello ? 20s : 2s;
    options.sends = 2;
    options.restarts = 2;
    options.opens_at_once = true;
  }
  if (url.timeout) options.answer = *url.timeout;
  return options;
}

// A hint for the user when no card answers.
const char* hint(const CardUrl& url, bool hello) {
  if (hello) return "what said hello knows no frames: start `trammel serve` anew";
  if (url.kind == Kind::kTcp) return "is a card behind that bridge, and does it have power?";
  if (url.kind == Kind::kSpi) return "does it have power, is it wired, is sck at most a quarter of its clock?";
  return "does it have power, are RX and TX crossed, does it take that baud rate?";
}

}  // namespace

Connection::Connection(const CardUrl& url) : timeout_given_(url.timeout.has_value()) {
  if (url.kind == Kind::kSim) {
    auto engine = sim::make_model_engine(sim::EngineOptions{url.axes, url.clock_hz, false});
    engine_ = engine.get();
    bus_ = std::move(engine);
    return;
  }
  if (url.kind == Kind::kMmap) {
    bus_ = std::make_unique<MemoryBus>(url.device, url.offset, url.interrupt);
    return;
  }
  const bool stream = url.kind == Kind::kTcp || !url.token.empty();
  const driver::FrameBus::Options options = frame_options(url, stream);
  if (stream) {
    auto link = stream_link(url, options);
    stream_ = link.get();
    link_ = std::move(link);
  } else if (url.kind == Kind::kSerial) {
    link_ = std::make_unique<SerialLink>([url] { return open_serial(url.device, url.baud); }, url.baud);
  } else {
    link_ = std::make_unique<SpiLink>(url.device, SpiLink::Options{url.sck_hz, url.mode});
  }
  try {
    auto bus = std::make_unique<driver::FrameBus>(*link_, options);
    frames_ = bus.get();
    bus_ = std::move(bus);
  } catch (const driver::LinkError& error) {
    throw driver::LinkError(fmt::format("{}: {}: {}", url.text, error.what(), hint(url, stream && url.hello)));
  }
}

Connection::~Connection() = default;
Connection::Connection(Connection&&) noexcept = default;

void Connection::set_patience(std::chrono::nanoseconds patience) {
  if (timeout_given_) return;
  if (frames_ != nullptr) frames_->set_patience(patience);
  if (stream_ != nullptr) stream_->set_patience(patience);
}

bool Connection::lost() const { return frames_ != nullptr && frames_->lost(); }
bool Connection::may_move() const { return stream_ == nullptr || stream_->may_move(); }
std::uint64_t Connection::reconnections() const { return stream_ == nullptr ? 0 : stream_->reconnections(); }

}  // namespace trammel::transport
