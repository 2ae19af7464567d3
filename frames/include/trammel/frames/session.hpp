// The card's response to a complete frame: whether the request runs, and what the reply contains. Independent of bytes
// and time.
#pragma once

#include <cstdint>
#include <vector>

#include "trammel/frames/frame.hpp"

namespace trammel::frames {

class Session {
 public:
  enum class Step : std::uint8_t { Answer, Execute };

  // Takes a request. Execute: the caller must run it now and report its end to executed(). Answer: it must not run.
  Step take(const ReceivedRequest& received);

  // Reports an execution. The first `made` words were made; `refused`: the card refused the next one. `data`: the words
  // read.
  void executed(std::uint8_t made, bool refused, std::vector<std::uint32_t> data);

  // The reply to the request taken last. For a repeated request it is the reply to its execution.
  Reply reply(const CardState& state) const;

  // Starts a new connection without a request: after a break on the line.
  void connect() { ++epoch_; }

  std::uint16_t epoch() const { return epoch_; }
  std::uint16_t last() const { return last_; }

 private:
  std::uint16_t epoch_ = 0;
  std::uint16_t last_ = 0;
  std::uint16_t number_ = 0;  // number of the request taken last
  Result result_ = Result::Done;
  bool repeats_ = false;  // the reply is that of the stored execution
  bool reads_ = false;    // the request under execution is a read
  // The stored result of executing request `last_`.
  Result kept_result_ = Result::Done;
  std::uint8_t kept_made_ = 0;
  bool kept_reads_ = false;
  std::vector<std::uint32_t> kept_data_;
};

}  // namespace trammel::frames
