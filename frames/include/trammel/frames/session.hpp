// What a card makes of a whole frame: whether it runs, and what of it the reply says. Knows neither bytes nor time.
#pragma once

#include <cstdint>
#include <vector>

#include "trammel/frames/frame.hpp"

namespace trammel::frames {

class Session {
 public:
  enum class Step : std::uint8_t { Answer, Execute };

  // Takes a request. Execute: it is to run, exactly now, and its end to be told by executed(). Answer: it is not to
  // run.
  Step take(const ReceivedRequest& received);

  // The words before `made` were made; `refused`: the card refused that one. `data`: what a read brought.
  void executed(std::uint8_t made, bool refused, std::vector<std::uint32_t> data);

  // The reply to the request taken last. Of a repeated one it is the reply to its execution.
  Reply reply(const CardState& state) const;

  // A new connection, without a request: a break on the line.
  void connect() { ++epoch_; }

  std::uint16_t epoch() const { return epoch_; }
  std::uint16_t last() const { return last_; }

 private:
  std::uint16_t epoch_ = 0;
  std::uint16_t last_ = 0;
  std::uint16_t number_ = 0;  // of the request taken last
  Result result_ = Result::Done;
  bool repeats_ = false;  // its reply is that of the execution kept
  bool reads_ = false;    // what is executed reads
  // The execution of `last_`.
  Result kept_result_ = Result::Done;
  std::uint8_t kept_made_ = 0;
  bool kept_reads_ = false;
  std::vector<std::uint32_t> kept_data_;
};

}  // namespace trammel::frames
