#include "trammel/model/frame_engine.hpp"

#include <utility>

#include "trammel/card_map.hpp"

namespace trammel::model {

namespace {

// Clocks from one visible event to the next: docs/developer/architecture.md, frame_engine.
constexpr unsigned kFirstWrite = 6;  // start to the first request of a write
constexpr unsigned kFirst = 1;       // start to the first request of any other kind
constexpr unsigned kNextWrite = 7;   // answer to the next request, of a write
constexpr unsigned kNextRead = 6;    // the same, of a read
constexpr unsigned kAfterWrite = 2;  // last answer of a write, or a refusal, to the first request for the card's state
constexpr unsigned kAfterRead = 6;   // the same, after a read
constexpr unsigned kFinish = 5;      // last answer to the decision whether to reply
constexpr unsigned kByte = 12;       // that decision, or the take of a byte, to the offer of the next byte

}  // namespace

void FrameEngine::clock(const Inputs& in) {
  const bool starts = frame_.has_value() && !in.restart;
  const bool listened = at_ == At::Listening;
  if (!listened && in.restart) dropped_ = true;
  switch (at_) {
    case At::Listening:
      if (starts) start();
      break;
    case At::Pause:
      if (--left_ == 0) show_request();
      break;
    case At::Ask:
      out_.request = false;
      at_ = At::Wait;
      break;
    case At::Wait:
      if (in.ack) answered(in);
      break;
    case At::Finish:
      if (--left_ == 0) finish();
      break;
    case At::Prepare:
      if (in.restart) {
        at_ = At::Listening;
      } else if (--left_ == 0) {
        offer();
      }
      break;
    case At::Offer:
      if (in.restart) {
        at_ = At::Listening;
        out_.valid = false;
      } else if (in.ready) {
        taken();
      }
      break;
  }
  frame_.reset();
  if (in.restart) {
    session_.connect();
    new_session_ = true;
    deframer_.clear();
  } else {
    receive_as(in, listened);
  }
}

// Takes the byte of this clock. A frame that it completes is visible in the next clock.
void FrameEngine::receive_as(const Inputs& in, bool listened) {
  if (!in.byte_valid) return;
  if (!listened) {
    deframer_.pass_over();
    if (in.byte == frames::kEnd) deframer_.clear();
    return;
  }
  if (deframer_.take(in.byte)) frame_ = frames::parse_request(deframer_.body());
}

void FrameEngine::start() {
  request_ = frame_->request;
  dropped_ = false;
  word_ = 0;
  read_.clear();
  const std::uint16_t epoch = session_.epoch();
  const bool runs = session_.take(*frame_) != frames::Session::Step::Answer;
  if (session_.epoch() != epoch) new_session_ = true;
  if (!runs) return begin_state(kFirst);
  first_access_ = new_session_;
  new_session_ = false;
  state_pass_ = false;
  out_.address = request_.address;
  ask_in(request_.kind == frames::Kind::Write ? kFirstWrite : kFirst);
}

void FrameEngine::begin_state(unsigned clocks) {
  state_pass_ = true;
  word_ = 0;
  out_.address = card_map::reg::kStatus;
  ask_in(clocks);
}

void FrameEngine::ask_in(unsigned clocks) {
  left_ = clocks - 1;
  at_ = At::Pause;
  if (left_ == 0) show_request();
}

void FrameEngine::show_request() {
  at_ = At::Ask;
  out_.request = true;
  out_.write = !state_pass_ && request_.kind == frames::Kind::Write;
  if (out_.write) out_.data = request_.data[word_];
  out_.of_session = !state_pass_;
  out_.new_session = first_access_ && !state_pass_;
}

void FrameEngine::answered(const Inputs& in) {
  first_access_ = false;
  if (state_pass_) {
    state_.words[word_++] = in.data;
    out_.address += 4;
    if (word_ < frames::kStateWords) return ask_in(kNextRead);
    left_ = kFinish;
    at_ = At::Finish;
    return;
  }
  const bool write = request_.kind == frames::Kind::Write;
  if (!in.error) {
    if (!write) read_.push_back(in.data);
    ++word_;
    if (!request_.fixed) out_.address = (out_.address + 4) % card_map::kWindowBytes;
    if (word_ < request_.count) return ask_in(write ? kNextWrite : kNextRead);
  }
  session_.executed(static_cast<std::uint8_t>(word_), in.error, std::move(read_));
  begin_state(write || in.error ? kAfterWrite : kAfterRead);
}

void FrameEngine::finish() {
  at_ = At::Listening;
  if (dropped_) return;
  reply_.clear();
  frames::append_reply(reply_, session_.reply(state_));
  place_ = 0;
  left_ = kByte - 1;
  at_ = At::Prepare;
}

void FrameEngine::offer() {
  at_ = At::Offer;
  out_.valid = true;
  out_.byte = reply_[place_];
}

// The second half of a stuffed byte follows without a pause.
void FrameEngine::taken() {
  const bool half = reply_[place_] == frames::kEscape;
  if (++place_ == reply_.size()) {
    out_.valid = false;
    at_ = At::Listening;
  } else if (half) {
    out_.byte = reply_[place_];
  } else {
    out_.valid = false;
    left_ = kByte - 1;
    at_ = At::Prepare;
  }
}

}  // namespace trammel::model
