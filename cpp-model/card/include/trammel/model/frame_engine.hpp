// Golden model of the frame engine, cycle-exact at every port: docs/developer/architecture.md. trammel::frames, which
// host and card share, defines the meaning of frames; this class adds the clocks. Not thread-safe.
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
    bool byte_valid = false;  // event; at least 10 clocks apart
    std::uint8_t byte = 0;
    bool ready = false;  // the port takes the offered byte
    // from the inner port
    bool ack = false;
    bool error = false;
    std::uint32_t data = 0;
  };

  struct Outputs {
    bool valid = false;
    std::uint8_t byte = 0;  // valid with `valid`
    // to the inner port; the other fields hold from `request` to its answer
    bool request = false;
    bool write = false;
    std::uint32_t address = 0;
    std::uint32_t data = 0;    // write data
    bool of_session = false;   // the access belongs to a request; otherwise it reads the card's state for a reply
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
  std::optional<frames::ReceivedRequest> frame_;  // the frame that the last byte completed
  frames::Request request_;
  At at_ = At::Listening;
  unsigned left_ = 0;  // clocks
  bool dropped_ = false;
  bool new_session_ = false;   // no request ran in this epoch yet
  bool first_access_ = false;  // the next access is the first of its session
  bool state_pass_ = false;
  unsigned word_ = 0;
  std::vector<std::uint32_t> read_;
  frames::CardState state_;
  frames::Bytes reply_;
  std::size_t place_ = 0;  // index of the next byte of the reply
  Outputs out_;
};

}  // namespace trammel::model
