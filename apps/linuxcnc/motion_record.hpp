// What was commanded and what was made, for comparisons: the lines sent to the card, and every step of a simulated one.
// Thread-safe: the card's thread tells of steps, another one of lines.
#pragma once

#include <mutex>
#include <string>

#include "trammel/driver/steps.hpp"
#include "trammel/linuxcnc/servo_stream.hpp"

namespace trammel::app {

class MotionRecord final : public linuxcnc::ServoRecord, public driver::StepSink {
 public:
  explicit MotionRecord(unsigned joints) : joints_(joints) {}

  // CSV, in order of what it was told:
  //   open,CLOCK,POSITION...            pulses from machine zero
  //   line,NUMBER,TIME,DURATION,TARGET...
  //                                     of the period; ns, when LinuxCNC's thread began it; ns; 2^-24 pulses from
  //                                     machine zero
  //   close,CLOCK
  //   output,CLOCK,LEVELS               of all outputs, bit n: output n
  //   step,CLOCK,COMMAND,AXIS,DIRECTION on the path, before its shaper; COMMAND counts what the stream sent, from 0
  std::string text() const;

  void opened(std::uint64_t clock, const std::array<std::int64_t, card_map::kMaxAxes>& positions) override;
  void line(const trammel_period& period, std::int64_t duration) override;
  void closed(std::uint64_t clock) override;
  void pin_step(const driver::PinStep& /*step*/) override {}
  void path_step(const driver::PathStep& step) override;
  void outputs_changed(const driver::OutputChange& change) override;

 private:
  void add(const std::string& line);

  unsigned joints_;
  mutable std::mutex mutex_;
  std::string text_;
};

}  // namespace trammel::app
