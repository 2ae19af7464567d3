#include "trammel/driver/frame_bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "trammel/driver/errors.hpp"
#include "trammel/driver/interrupt.hpp"

namespace trammel::driver {

namespace {

using frames::Bytes;
using frames::Kind;
using frames::Reply;
using frames::Request;
using frames::Result;

std::uint16_t next(std::uint16_t number) { return static_cast<std::uint16_t>(number + 1); }

// Number of accesses, from the first, that fit in one request: all reads or all writes, at rising addresses or at one.
std::size_t run_length(const Access* accesses, std::size_t count, bool fixed) {
  const std::size_t most = std::min(count, frames::kMaxWords);
  std::size_t length = 1;
  while (length < most && accesses[length].write == accesses[0].write &&
         accesses[length].address == accesses[length - 1].address + (fixed ? 0 : 4)) {
    ++length;
  }
  return length;
}

// Whether the reply answers this request. Requests that run and other requests have separate numbers, which may
// coincide; but only a request that runs reports accesses.
bool answers(const Reply& reply, const Request& request) {
  if (reply.number != request.number) return false;
  const bool runs = request.kind == Kind::Read || request.kind == Kind::Write;
  if (!runs) return reply.made == 0 && !reply.has_data && reply.result != Result::Refused;
  const bool ran = reply.result == Result::Done || reply.result == Result::Refused;
  return !ran || (reply.has_data == (request.kind == Kind::Read) && reply.epoch == request.epoch);
}

// Time for an answer when a bus with limited patience got no answer before.
constexpr std::chrono::milliseconds kLastAsk(500);

constexpr const char* kUnknown =
    "the card was reset, or used by somebody else: what became of the last request is not known";

}  // namespace

FrameBus::FrameBus(ByteLink& link, const Options& options) : link_(link), options_(options) {
  if (options.opens_at_once) {
    options_.sends = 1;
    options_.restarts = 0;
  }
  begin_anew();
  options_ = options;
}

// With limited patience a request is sent once, and once more on a new connection.
FrameBus::Tries FrameBus::tries() const {
  if (!is_impatient()) return {options_.answer, options_.sends, options_.restarts};
  return {lost_ ? kLastAsk : patience_, 1, 1};
}

void FrameBus::begin_anew() {
  tries_ = tries();
  reconnect();
  number_ = card_last_;
  went_back_ = false;
}

std::size_t FrameBus::transfer(Access* accesses, std::size_t count) {
  made_ = 0;
  while (made_ < count) {
    Access* first = accesses + made_;
    const Reply reply = exchange(request_for(first, count - made_));
    for (std::size_t i = 0; i < reply.data.size(); ++i) first[i].data = reply.data[i];
    made_ += reply.made;
    if (reply.result == Result::Refused) break;
  }
  return made_;
}

Request FrameBus::request_for(const Access* accesses, std::size_t count) const {
  const std::size_t rising = run_length(accesses, count, false);
  const std::size_t standing = run_length(accesses, count, true);
  Request request;
  request.kind = accesses[0].write ? Kind::Write : Kind::Read;
  request.fixed = standing > rising;
  request.count = static_cast<std::uint8_t>(std::max(rising, standing));
  request.address = static_cast<std::uint16_t>(accesses[0].address);
  for (std::size_t i = 0; request.kind == Kind::Write && i < request.count; ++i) {
    request.data.push_back(accesses[i].data);
  }
  return request;
}

// Sends until a reply tells whether the request ran. The number makes it run only once: a card that has run it only
// repeats its reply; a card that has not still accepts it after a new connection.
Reply FrameBus::exchange(Request request) {
  // Numbers repeat after 65,536 requests; by then nothing of this connection may still be in transit.
  if (open_ || next(number_) == 0) {
    open_.reset();
    begin_anew();
  }
  ++counts_.requests;
  request.number = next(number_);
  open_ = request;
  tries_ = tries();
  const auto begun = link_.now();
  for (unsigned attempt = 0;; ++attempt) {
    open_->epoch = epoch_;
    if (const std::optional<Reply> reply = try_open()) {
      open_.reset();
      lost_ = false;
      number_ = request.number;
      if (reply->made != request.count && reply->result == Result::Done) {
        throw LinkError(fmt::format("the card made {} of {} accesses and refused none", reply->made, request.count));
      }
      return *reply;
    }
    if (attempt == tries_.restarts) {
      lost_ = true;
      throw LinkError(fmt::format("no answer to a request, sent {} times on each of {} connections", tries_.sends,
                                  tries_.restarts + 1));
    }
    connect_again(begun);
    if (!known()) throw LinkError(kUnknown);
  }
}

// Connects again after a request without an answer, which was sent at `begun`.
void FrameBus::connect_again(std::chrono::nanoseconds begun) {
  const Tries before = tries_;
  if (is_impatient()) tries_ = {kLastAsk, 1, 0};
  try {
    reconnect();
  } catch (const LinkError& error) {
    lost_ = true;
    if (!is_impatient()) throw;
    const std::chrono::duration<double> silent = link_.now() - begun;
    throw LinkError(fmt::format("no answer for {:.1f} s; {}", silent.count(), error.what()));
  }
  tries_ = {before.answer, before.sends, before.restarts};
}

// A lost link counts as no answer: the next step is a new connection.
std::optional<Reply> FrameBus::try_open() {
  try {
    return send_and_wait(*open_);
  } catch (const LinkError&) {
    return std::nullopt;
  }
}

// Whether the card is in a state that is possible after the open request: it has run it, or not yet.
bool FrameBus::known() const { return !went_back_ && (card_last_ == number_ || card_last_ == next(number_)); }

std::size_t FrameBus::resume() {
  if (!open_) return made_;
  tries_ = tries();
  reconnect();
  if (!known()) throw LinkError(kUnknown);
  if (card_last_ == number_) {
    open_.reset();
    return made_;
  }
  // The request ran. The card has stored its reply, which tells how many accesses were made.
  open_->epoch = epoch_;
  const std::optional<Reply> reply = send_and_wait(*open_);
  if (!reply) throw LinkError("the card connects, but does not answer");
  number_ = open_->number;
  open_.reset();
  return made_ += reply->made;
}

std::optional<Reply> FrameBus::send_and_wait(const Request& request) {
  // The first kEnd ends any bytes that the card has taken as the start of a frame.
  Bytes bytes{frames::kEnd};
  frames::append_request(bytes, request);
  for (unsigned send = 0; send < tries_.sends; ++send) {
    if (send != 0) ++counts_.sent_again;
    link_.send(bytes.data(), bytes.size());
    std::optional<Reply> reply = wait_for(request, bytes.size());
    if (!reply) continue;
    state_ = reply->state;
    // Any other result than its execution means that the connection is no longer the one that this side assumes.
    const bool executed = reply->result == Result::Done || reply->result == Result::Refused;
    if (!executed) return std::nullopt;
    return reply;
  }
  return std::nullopt;
}

std::optional<Reply> FrameBus::wait_for(const Request& request, std::size_t bytes) {
  const auto back = static_cast<std::size_t>(request.kind == Kind::Read ? request.count : 0) * 8 + 80;
  const auto until = link_.now() + link_.time_of(bytes) + link_.time_of(back) + tries_.answer;
  const auto begun = link_.now();
  std::uint8_t buffer[256];
  // Bytes after the end of this reply answer no pending request.
  for (auto left = until - begun; left.count() > 0; left = until - link_.now()) {
    const std::size_t count =
        link_.receive(buffer, sizeof(buffer), std::min<std::chrono::nanoseconds>(left, kInterruptSlice));
    if (count == 0 && interrupted_after(link_.now() - begun)) {
      throw InterruptedError("interrupted while the card did not answer: what became of the last request is not known");
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!deframer_.take(buffer[i])) continue;
      std::optional<Reply> reply = frames::parse_reply(deframer_.body());
      if (reply && answers(*reply, request)) return reply;
      ++counts_.strange;
    }
  }
  return std::nullopt;
}

// Starts a new epoch, so that requests sent before can no longer run.
bool FrameBus::connect() {
  Request ask;
  ask.number = ++tag_;
  const std::optional<Reply> card = send_and_wait(ask);
  if (!card) return false;
  // An epoch only increases; a decreased one shows that the card was reset.
  if (static_cast<std::uint16_t>(card->epoch - epoch_) >= 0x8000) went_back_ = true;
  Request request;
  request.kind = Kind::Connect;
  request.number = ++tag_;
  request.epoch = card->epoch;
  const std::optional<Reply> reply = send_and_wait(request);
  if (!reply) return false;
  epoch_ = reply->epoch;
  card_last_ = reply->last;
  return true;
}

void FrameBus::reconnect() {
  std::string failure =
      tries_.sends == 1 && tries_.restarts == 0
          ? fmt::format("no card answers within {} ms",
                        std::chrono::duration_cast<std::chrono::milliseconds>(tries_.answer).count())
          : fmt::format("no card answers: asked {} times on each of {} connections", tries_.sends, tries_.restarts + 1);
  for (unsigned attempt = 0; attempt <= tries_.restarts; ++attempt) {
    ++counts_.restarts;
    deframer_.clear();
    try {
      link_.restart();
      if (connect()) return;
    } catch (const LinkError& error) {
      failure = error.what();
    }
  }
  throw LinkError(failure);
}

}  // namespace trammel::driver
