// Golden model of the frame engine, cycle-exact at every port: docs/developer/architecture.md. What frames mean is
// trammel::frames, which host and card share; here are the clocks. Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "trammel/frames/session.hpp"

namespace trammel::model {

class FrameEngine {
 public:
  struct Inputs {
    bool restart = false;     // event: a new connection
    bool byte_valid = false;  // 10 clocks apart at least
    std::uint8_t byte = 0;
    bool ready = false;  // the port takes the byte offered
    // from the inner port
    bool ack = false;
    bool error = false;
    std::uint32_t data = 0;
  };

  struct Outputs {
    bool valid = false;
    std::uint8_t byte = 0;  // with valid
    // to the inner port; the others stand from `request` to its answer
    bool request = false;
    bool write = false;
    std::uint32_t address = 0;
    std::uint32_t data = 0;    // of a write
    bool of_session = false;   // of a request; else what a reply says of the card
    bool new_session = false;  // the first access of its session
  };

  void reset() { *this = FrameEngine(); }

  // One rising edge with reset low.
  void clock(const Inputs& in);
  const Outputs& outputs() const { return out_; }
  const frames::Session& session() const { return session_; }

  bool listening() const { return at_ == At::Listening; }

 private:
  enum class At : std::uint8_t { Listening, Pause, Ask, Wait, Finish, Prepare, Offer };

  void receive_as(const Inputs& in, bool listened);
  void start();
  void begin_state(unsigned clocks);
  void ask_in(unsigned clocks);
  void show_request();
  void answered(const Inputs& in);
  void finish();
  void offer();
  void taken();

  frames::Deframer deframer_{frames::kMaxRequestBody};
  frames::Session session_;
  std::optional<frames::ReceivedRequest> frame_;  // seen in this clock
  frames::Request request_;
  At at_ = At::Listening;
  unsigned left_ = 0;  // clocks
  bool dropped_ = false;
  bool new_session_ = false;   // no request ran in this epoch yet
  bool first_access_ = false;  // of it
  bool state_pass_ = false;
  unsigned word_ = 0;
  std::vector<std::uint32_t> read_;
  frames::CardState state_;
  frames::Bytes reply_;
  std::size_t place_ = 0;  // in it
  Outputs out_;
};

}  // namespace trammel::model
