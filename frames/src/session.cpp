#include "trammel/frames/session.hpp"

#include <utility>

namespace trammel::frames {

Session::Step Session::take(const ReceivedRequest& received) {
  const Request& request = received.request;
  const auto ahead = static_cast<std::uint16_t>(request.number - last_);
  number_ = request.number;
  result_ = Result::Done;
  repeats_ = false;
  if (received.malformed) {
    result_ = Result::Malformed;
  } else if (request.kind == Kind::Ask) {
    result_ = Result::Done;
  } else if (request.epoch != epoch_) {
    result_ = Result::WrongEpoch;
  } else if (request.kind == Kind::Connect) {
    connect();
  } else if (ahead == 0) {
    repeats_ = true;
  } else if (ahead == 1) {
    last_ = request.number;
    repeats_ = true;
    reads_ = request.kind == Kind::Read;
    return Step::Execute;
  } else {
    result_ = Result::WrongNumber;
  }
  return Step::Answer;
}

void Session::executed(std::uint8_t made, bool refused, std::vector<std::uint32_t> data) {
  kept_result_ = refused ? Result::Refused : Result::Done;
  kept_made_ = made;
  kept_reads_ = reads_;
  kept_data_ = std::move(data);
}

Reply Session::reply(const CardState& state) const {
  Reply reply;
  reply.result = result_;
  reply.number = number_;
  reply.last = last_;
  reply.epoch = epoch_;
  reply.state = state;
  if (!repeats_) return reply;
  reply.result = kept_result_;
  reply.made = kept_made_;
  reply.has_data = kept_reads_;
  if (kept_reads_) reply.data = kept_data_;
  return reply;
}

}  // namespace trammel::frames
